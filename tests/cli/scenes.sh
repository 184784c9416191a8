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
