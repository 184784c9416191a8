#!/bin/sh
# Good and bad scenes, species and inventories through `info` and `check`: no GPU.
set -u
. "$(dirname "$0")/lib.sh"

expect 0 'trees +200 ' info "$tiny"
expect 0 'oak' info "$tiny"
expect 0 'camera +west: at -20' info "$tiny"
expect 0 'path +fly: 4.0 s' info "$tiny"
check 'info --json: 200 trees, sums agree' sh -c "'$weald' info '$tiny' --json |
    jq -e '.tree_count == 200 and ([.species[].tree_count] | add) == 200 and
           (.cameras | map(.name)) == [\"south\", \"inside\", \"west\"] and .paths[0].duration_s == 4 and
           (.devices | length) > 0 and .octant_count > 0 and .host_bytes > 0'"
check 'info --json: 625 stems a hectare, 8 to 14 m high' sh -c "'$weald' info '$tiny' --json |
    jq -e '([.species[].stems_per_ha] | add | . > 624 and . < 626) and
           ([.species[] | .mean_height_m > 9 and .mean_height_m < 13 and .max_height_m <= 14 and
                          .mean_crown_diameter_m > 1] | all)'"
forest_hash() { "$weald" info "$tiny" --json "$@" | jq -r .hash; }
one=$(forest_hash --threads 1)
check 'the forest has a hash' test -n "$one"
check 'the same forest from 1 and 7 threads' test "$one" = "$(forest_hash --threads 7)"
check 'another forest from another seed' test "$one" != "$(forest_hash --seed 8)"
expect 1 'seed' info "$tiny" --seed banana
# A wide grid of which rules leave few trees is planted at once, one of many trees on demand.
expect 0 'octree +[0-9]{6} octants' info "$root/scenes/valley.json"
expect 0 'layer all: planted on demand' info "$tiny" --set 'terrain.size_m=[12000,12000]' \
    --set terrain.cell_m=50
expect 0 'tiny.json: ok' check "$tiny"
expect 0 'oak.json: ok' check "$root/species/oak.json"

# bad NAME PATTERN: the file $scratch/NAME.json is refused by both commands, by name
bad() {
    expect 1 "$2" check "$scratch/$1.json"
    expect 1 "$2" info "$scratch/$1.json"
    expect 1 "$2" render "$scratch/$1.json" -o "$scratch/out.png" --gpu software
    check "$1: no picture" test ! -e "$scratch/out.png"
}
# change NAME JQ-PROGRAM: the tiny scene, changed
sed -e 's,^ *//.*,,' -e "s,\.\./\.\./,$root/,g" "$tiny" >"$scratch/plain.json"
change() { jq "$2" "$scratch/plain.json" >"$scratch/$1.json"; }

bad missing 'missing.json.*[Nn]o such file'
: >"$scratch/empty.json"
bad empty 'empty.json'
head -c 300 "$tiny" >"$scratch/truncated.json"
bad truncated 'truncated.json:[0-9]+:[0-9]+'
head -c 4096 /dev/urandom >"$scratch/binary.json"
bad binary 'binary.json'
mkdir "$scratch/directory.json"
bad directory 'directory.json.*directory'
printf '[1, 2]' >"$scratch/list.json"
bad list 'list.json:1:'
printf '{"name": "a", "name": ' >"$scratch/cut.json"
bad cut 'cut.json:1:'
# What scenes are made of is told from them.
printf '{"type": "FeatureCollection", "features": []}' | tee "$scratch/points.json" >"$scratch/points.geojson"
printf 'x,y\n1,1\n' | tee "$scratch/points.csv" "$scratch/points.gpkg" >"$scratch/points.XLSX"
bad points 'points.json: is no scene .* holds vector data: export the trees as CSV'
expect 1 'points.csv: is no scene .* is a table: name it in' info "$scratch/points.csv"
expect 1 'points.gpkg: is no scene .* export the trees as CSV' info "$scratch/points.gpkg"
expect 1 'points.geojson: holds vector data: export the trees as CSV' check "$scratch/points.geojson"
expect 1 'points.XLSX: is a workbook: save its sheet as CSV' check "$scratch/points.XLSX"
printf '\357\273\277%s' "$(cat "$scratch/plain.json")" >"$scratch/marked.json"
expect 0 'marked.json: ok' check "$scratch/marked.json"
change unknown '. + {"terain": {}}'
bad unknown 'terain.*did you mean.*terrain'
change type '.terrain.size_m = "large"'
bad type 'size_m'
change negative '.layers[0].spacing_m = -4'
bad negative 'spacing_m.*-4'
change height '.layers[0].height_m = [-3, 5]'
bad height 'height_m'
change species '.layers[0].species = {"oakk": 1}'
bad species 'oakk'
change raster '.terrain = {"kind": "raster", "file": "nowhere.tif"}'
expect 1 'nowhere.tif' info "$scratch/raster.json"
expect 1 'nowhere.tif' render "$scratch/raster.json" -o "$scratch/out.png" --gpu software
expect 1 'raster.json:[0-9]+:[0-9]+: terrain.file: there is no file .*nowhere.tif' check "$scratch/raster.json"
check 'raster: no picture' test ! -e "$scratch/out.png"
# What a scene names is looked for, key by key, and told by its keys from a species.
change named '.sky = {"file": "no.exr"} | .water = {"enabled": true, "map": {"file": "no-water.tif"}} |
    .layers[0].map = {"file": "no-map.tif", "classes": 1} | .layers[0].canopy = {"file": "no-canopy.tif"} |
    .inventories = [{"file": "no.csv", "species": {"*": "oak"}}, {"file": "directory.json", "species": {"*": "oak"}}]'
for key in 'sky.file' 'water.map.file' 'layers\[0\].map.file' 'layers\[0\].canopy.file' 'inventories\[0\].file'; do
    expect 1 "named.json:[0-9]+:[0-9]+: $key: there is no file .*/no" check "$scratch/named.json"
done
expect 1 'inventories\[1\].file: .*is a directory' check "$scratch/named.json"
# Inventories and ground are read as the scene says.
printf 'x,y,species,dbh\n1,1,oak,30\n2,2,elm,30\n' >"$scratch/elm.csv"
change rows '.inventories = [{"file": "elm.csv", "species": {"oak": "oak"}}]'
expect 1 'elm.csv:3: column species: .*"elm" \(1, from line 3\)' check "$scratch/rows.json"
change rows '.inventories = [{"file": "elm.csv", "dbh_unit": "m", "species": {"*": "oak"}}]'
expect 1 'elm.csv:2: column dbh: 30 is too much' check "$scratch/rows.json"
expect 0 'elm.csv: ok' check "$scratch/elm.csv"
echo 'no raster' >"$scratch/ground.tif"
change rows '.terrain = {"kind": "raster", "file": "ground.tif"}'
expect 1 'ground.tif.* not a raster' check "$scratch/rows.json"
# GDAL is loaded where a raster is met, and told of where it is none.
mkdir "$scratch/broken"
for version in $(seq 28 60); do : >"$scratch/broken/libgdal.so.$version"; done
broken="LD_LIBRARY_PATH='$scratch/broken' '$weald'"
check 'a missing GDAL is told' sh -c "$broken check '$scratch/rows.json' 2>&1 | grep -q 'GDAL.* cannot be loaded: .*libgdal'"
check 'and not asked for without a raster' sh -c "$broken check '$tiny'"
# Nor is anything ok that cannot be planted or seen.
change rows '.inventories = [{"file": "elm.csv", "species": {"*": "oak"}, "offset_m": [1e7, 0]}]'
expect 1 'elm.csv: no tree stands on the ground' check "$scratch/rows.json"
change rows '.inventories = [{"file": "elm.csv", "species": {"*": "oak"}, "offset_m": [-1.5, 0], "outside": "error"}]'
expect 1 'elm.csv:2: stands at' check "$scratch/rows.json"
change rows '.terrain = {"size_m": [0, 0]} | .inventories = [{"file": "elm.csv", "species": {"*": "oak"}},
    {"file": "elm.csv", "species": {"*": "oak"}, "offset_m": [1e7, 0]}]'
expect 1 'rows.json: terrain: is 10000 x 0 km; at most' check "$scratch/rows.json"
change rows '.terrain = {"size_m": [0, 0]}'
expect 1 'rows.json:[0-9]+:[0-9]+: terrain.size_m: found 0 x 0' check "$scratch/rows.json"
change rows '.cameras[0].frame = "projected" | .cameras[0].position_m = [5e6, 0, 2]'
expect 1 'rows.json: cameras\[0\].position_m: \(5000000, 0, 2\) is 2000 km or more' check "$scratch/rows.json"
expect 1 'cameras\[0\].position_m: \(5000000' info "$scratch/rows.json"
change layer '.layers[0].name = "model" | .name = "allometry"'
echo '// a "model" with "allometry"' >>"$scratch/layer.json"
expect 0 'layer.json: ok' check "$scratch/layer.json"
change layer '.layers[0].name = "model" | .terain = .terrain | del(.terrain)'
expect 1 'terain.*did you mean.*terrain' check "$scratch/layer.json"
sed 's/"allometry"/"alometry"/' "$root/species/oak.json" >"$scratch/alometry.json"
expect 1 'alometry.*did you mean.*allometry' check "$scratch/alometry.json"

change date '.time = {"date": "2026-02-30"}'
bad date 'date.*2026-02-30.*YYYY-MM-DD'
change placeless '.time = {"date": "2026-02-20", "clock": "12:00"}'
bad placeless 'clock.*latitude_deg'
change suns '.time = {"date": "2026-02-20", "clock": "12:00", "latitude_deg": 47, "longitude_deg": 8} | .sun = {"azimuth_deg": 100}'
bad suns 'sun.*clock'
change wind '.wind = {"speed_mps": -1}'
bad wind 'speed_mps.*-1'
sed 's/"seed": 7/"seed": NaN/' "$scratch/plain.json" >"$scratch/nan.json"
bad nan 'nan.json:[0-9]+'
sed 's/"relief_m": 6/"relief_m": 1e999/' "$scratch/plain.json" >"$scratch/infinite.json"
bad infinite 'infinite.json:[0-9]+'
expect 1 'binary.json' check "$tiny" "$scratch/binary.json"
expect 1 'tiny.json: ok' check "$scratch/binary.json" "$tiny"
expect 1 'nowhere' info "$scratch/raster.json" --data /nowhere

# Species are found from any folder, in the tree that the program or the library lies in; and where they
# are not, what to do is told. In a tree without species first, as far as none are installed.
own=$scratch/own
mkdir -p "$own/bin" "$own/lib" "$own/away"
cp "$weald" "$own/bin"
library=$(ldd "$weald" | awk '/libweald/ { print $3 }')
[ -z "$library" ] || cp -L "$library" "$own/lib/$(basename "$library")"
printf '{"terrain": {"kind": "flat", "size_m": [40, 40]}, "layers": [{"species": "oak"}]}' >"$own/away/a.json"
from_away() { (cd "$own/away" && LD_LIBRARY_PATH=$own/lib:${LD_LIBRARY_PATH:-} "$@"); }
away() { # away PATTERN ARGUMENT...: a line of what the tree's own program says in a folder of its own
    pattern=$1
    shift
    check "away: weald $*" sh -c 'echo "$1" | grep -qE -- "$2"' - "$(from_away "$own/bin/weald" "$@" 2>&1)" "$pattern"
}
if from_away "$own/bin/weald" grow oak --height 4 -o "$own/oak.obj" >/dev/null 2>&1; then
    echo "skip a tree without species: some are installed"
else
    away 'unknown species "oak"; name a species file .* it was looked for in species, .*own/share/weald/species' \
        grow oak --height 4 -o "$own/oak.obj"
    away '"species": \{"oak": "PATH.json"\}; it was looked for in species, .*own/share/weald/species' info a.json
fi
mkdir -p "$own/share/weald"
cp -r "$root/species" "$own/share/weald/species"
away 'oak .*4.0 m high' grow oak --height 4 --detail 0.2 -o "$own/oak.obj"
away '^trees ' info a.json
mv "$own/bin/weald" "$own/away/weald" # the library's tree alone
if [ -n "$library" ]; then
    check 'the library finds its own species' from_away "$own/away/weald" info a.json
fi
rm -r "$own/share"
mkdir "$own/build" "$own/build/cli"
mv "$own/away/weald" "$own/build/cli"
cp -r "$root/species" "$own/species"
check 'so does a program that lies where it was built' from_away "$own/build/cli/weald" info a.json

# inventories
inventory() { # inventory NAME: a scene that plants $scratch/NAME.csv
    jq --arg file "$1.csv" 'del(.layers) | .inventories = [{"file": $file, "species": {"*": "oak"},
        "columns": {"x": "x_m", "y": "y_m", "height": "height_m"}}]' \
        "$scratch/plain.json" >"$scratch/$1.json"
}
printf 'x_m,y_m,height_m\n10,10,12\n20,20,13\n30.5,12.25,9\n' >"$scratch/good.csv"
inventory good
expect 0 'trees +3 ' info "$scratch/good.json"
printf '\357\273\277x_m,y_m,height_m\r\n"10","10","12"\r\n20,20,13\r\n' >"$scratch/bom.csv"
inventory bom
expect 0 'trees +2 ' info "$scratch/bom.json"
printf 'x_m,y_m,height_m\n10,10,12\n20,20\n30,30,9\n' >"$scratch/ragged.csv"
inventory ragged
expect 1 'ragged.csv:3' info "$scratch/ragged.json"
# What trees are called in an inventory is what they are called in the list of those that stand.
printf 'x_m,y_m,height_m,nr\n10,10,12,A-7\n10,10,12,"A ""8"""\n20,20,13,\n' >"$scratch/tagged.csv"
inventory tagged
jq '.inventories[0].columns.id = "nr"' "$scratch/tagged.json" >"$scratch/tags.json"
expect 0 'list.csv: ' export "$scratch/tags.json" -o "$scratch/list.csv"
check 'the list has a column of tags' sh -c "head -1 '$scratch/list.csv' | grep -q ',layer,tag,file,row,dbh_cm\$'"
check 'a tag stands in its row' grep -q '^1,.*,"inventory","A-7","tagged.csv",2,$' "$scratch/list.csv"
check 'a tag with quotes too' grep -q '^2,.*,"inventory","A ""8""","tagged.csv",3,$' "$scratch/list.csv"
check 'a tree without has none' grep -q '^3,.*,"inventory",,"tagged.csv",4,$' "$scratch/list.csv"
printf 'tree_id,x,y,species,dbh_mm\n7,10,10,Fagus sylvatica,305\n9,20,20,Picea abies (L.) H.Karst.,\n' >"$scratch/latin.csv"
jq 'del(.layers) | .inventories = [{"file": "latin.csv", "species": {"Abies alba": "Picea abies"}}]' \
    "$scratch/plain.json" >"$scratch/latin.json"
expect 1 '"Fagus sylvatica" is called "beech" here: add \{"Fagus sylvatica": "beech"\}' check "$scratch/latin.json"
jq '.inventories[0].species = {"Fagus sylvatica": "Fagus sylvatica", "*": "Picea abies"}' "$scratch/latin.json" >"$scratch/named.json"
expect 0 'list.csv: ' export "$scratch/named.json" -o "$scratch/list.csv"
check 'a row leads back to what was measured' grep -q '^1,"beech",.*,"7","latin.csv",2,30.50$' "$scratch/list.csv"
check 'a Latin name is that of its species' grep -q '^2,"spruce",.*,"9","latin.csv",3,$' "$scratch/list.csv"
printf 'x_m,y_m,height_m\n10,10,12\n,10,12\n20,NA,13\n10,10,12\n' >"$scratch/placeless.csv"
inventory placeless
expect 0 'inventory .*: 4 rows, 1 planted, 0 dead, 1 duplicate, 0 outside, 2 without a position' \
    info "$scratch/placeless.json"
check 'info --json: rows without a position are counted' sh -c "'$weald' info '$scratch/placeless.json' --json |
    jq -e '.inventories[0] | .without_position == 2 and .rows == .planted + .duplicates + .without_position'"
# A semicolon is seen to be the delimiter.
printf 'x_m;y_m;height_m\n10;10;12\n' >"$scratch/semicolon.csv"
inventory semicolon
expect 0 'trees +1 ' info "$scratch/semicolon.json"
printf 'x_m|y_m|height_m\n10|10|12\n' >"$scratch/pipes.csv"
inventory pipes
expect 1 'pipes.csv' info "$scratch/pipes.json"
printf 'x_m,y_m,height_m\n"10,5","10,5","12,0"\n' >"$scratch/comma.csv"
inventory comma
expect 1 'comma.csv:2' info "$scratch/comma.json"
printf 'x_m,y_m,height_m\n' | iconv -t UTF-16 >"$scratch/utf16.csv"
inventory utf16
expect 1 'utf16.csv.*UTF-16' info "$scratch/utf16.json"
printf 'x_m,y_m,height_m\n' >"$scratch/none.csv"
inventory none
expect 1 'none.csv' info "$scratch/none.json"
inventory absent
expect 1 'absent.csv' info "$scratch/absent.json"
finish
