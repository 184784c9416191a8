#!/bin/sh
# Single trees and scenes as pictures and as files for other programs.
set -u
. "$(dirname "$0")/lib.sh"
mkdir "$scratch/out"
out=$scratch/out
cd "$root" || exit 1
small="--size 96x96 --samples 1 --gpu software"
sound() { python3 "$root/tests/cli/glb_check.py" "$@"; }

cat >"$out/planted.json" <<EOF
{"terrain": {"kind": "flat", "size_m": [40, 40]}, "variants": 2,
 "species": {"mine": "oak.obj"},
 "layers": [{"species": {"mine": 1}, "spacing_m": 8, "height_m": [4, 7]}]}
EOF
# Ground with coordinates of its own, but without a system that they are of.
sed 's/"size_m": \[40, 40\]/"window_m": [500000, 4600000, 500040, 4600040]/' "$out/planted.json" >"$out/afar.json"
# shellcheck disable=SC2086  # $small is many words
{
    expect 0 'oak .* m high, .*20 years; triangles' grow oak --age 20 --open 1 --seed 3 -o "$out/oak.glb"
    expect 0 'oak.obj: ' grow oak --height 5 --detail 0.2 -o "$out/oak.obj"
    expect 0 'oak.png: ' grow oak --height 5 -o "$out/oak.png" $small --gpu-validate
    draw 'autumn.png: ' grow oak --height 5 --season autumn -o "$out/autumn.png" $small
    draw 'cards.png: ' grow oak --height 5 --form cards -o "$out/cards.png" $small
    draw 'near.png: ' grow oak --height 5 --camera-distance 3 -o "$out/near.png" $small
    draw 'model.png: ' grow "$out/oak.obj" --height 9 -o "$out/model.png" $small
    draw 'oak .*9.0 m high' grow "$out/oak.glb" --height 9 -o "$out/again.glb"
    draw 'three.glb: ' grow birch --height 4 --detail 0.2 --variants 3 -o "$out/three.glb"
    draw 'layers.exr: ' grow oak --height 5 -o "$out/layers.exr" $small
    draw 'tiny.glb: ' export "$tiny" -o "$out/tiny.glb"
    draw 'oak.glb: ' check "$out/oak.glb" "$out/oak.obj"
    draw 'trees.csv: ' export "$tiny" -o "$out/trees.csv"
    draw 'afar.glb: ' export "$out/afar.json" -o "$out/afar.glb"
    draw 'afar.csv: ' export "$out/afar.json" -o "$out/afar.csv"
    draw '"name": "mine"' info "$out/planted.json" --json
    drawn
    check 'a model is read without standard input' sh -c "'$weald' check '$out/oak.obj' <&-"
    check 'and without a place for messages' sh -c "'$weald' check '$out/oak.obj' <&- 2>&-"
}
# shellcheck disable=SC2086  # $small is many words
expect 0 'planted.png: ' render "$out/planted.json" -o "$out/planted.png" $small --gpu-validate
check 'oak.glb is sound' sound "$out/oak.glb" roots=1 levels=1
check 'a model written again is sound' sound "$out/again.glb" roots=1 levels=1
check 'three variants are sound' sound "$out/three.glb" roots=3 levels=3
trees=$("$weald" info "$tiny" --json | jq .tree_count)
check 'a scene is sound' sound "$out/tiny.glb" "instances=$trees" mirrored=2 "trees=$out/trees.csv"
check 'a scene afar stands where its list says' sound "$out/afar.glb" "trees=$out/afar.csv"

# A forest's list of trees, planted again from that list, is the same list.
check 'a row for each tree' test "$(wc -l <"$out/trees.csv")" -eq $((trees + 1))
cat >"$out/listed.json" <<EOF
{"terrain": {"kind": "flat", "size_m": [80, 40]},
 "species": {"oak": "$root/species/oak.json", "spruce": "$root/species/spruce.json"},
 "inventories": [{"file": "trees.csv", "species": {"oak": "oak", "spruce": "spruce"}}]}
EOF
expect 0 'listed.csv: ' export "$out/listed.json" -o "$out/listed.csv"
for list in trees listed; do
    cut -d, -f2-4,6-7 "$out/$list.csv" | sort >"$out/$list.sorted"
done
check 'a list planted again is the same list' cmp "$out/trees.sorted" "$out/listed.sorted"
for other in autumn cards near model; do
    check "$other changes the picture" sh -c "! cmp -s '$out/oak.png' '$out/$other.png'"
done
"$weald" grow oak --age 20 --open 1 --seed 3 -o "$out/same.glb" -q
check 'the same tree, the same bytes' cmp "$out/oak.glb" "$out/same.glb"
"$weald" grow 'Quercus robur L.' --age 20 --open 1 --seed 3 -o "$out/same.glb" -q
check 'the same by its Latin name' cmp "$out/oak.glb" "$out/same.glb"
for file in oak.mtl oak-oak-wood.png oak-oak-leaf.png; do
    check "$file lies beside oak.obj" test -s "$out/$file"
done

# The Khronos validator, where node finds it: after `npm install --prefix FOLDER gltf-validator`, with NODE_PATH
# FOLDER/node_modules.
if command -v node >/dev/null 2>&1 && node -e 'require.resolve("gltf-validator")' >/dev/null 2>&1; then
    for name in oak again three tiny; do
        check "the Khronos validator finds no error in $name.glb" node -e "
            const validator = require('gltf-validator');
            const bytes = new Uint8Array(require('fs').readFileSync('$out/$name.glb'));
            validator.validateBytes(bytes).then(report => {
                console.log(report.issues);
                process.exit(report.issues.numErrors ? 1 : 0);
            });"
    done
else
    echo "skipped: the Khronos validator, which node does not find (gltf-validator, NODE_PATH)"
fi

# Hedges: to a box, and to the closed mesh that a cut plant's own box is.
printf 'v %s\n' '-0.6 0.1 -0.4' '0.6 0.1 -0.4' '0.6 0.1 0.4' '-0.6 0.1 0.4' '-0.6 1.5 -0.4' '0.6 1.5 -0.4' \
    '0.6 1.5 0.4' '-0.6 1.5 0.4' >"$out/box.obj"
printf 'f %s\n' '1 2 3 4' '8 7 6 5' '1 5 6 2' '2 6 7 3' '3 7 8 4' '4 8 5 1' >>"$out/box.obj"
grep -v '^f 1 2' "$out/box.obj" >"$out/open.obj"
expect 0 'beech .* 1\.5 m high' grow beech --clip 1.2x0.8x1.5 -o "$out/hedge.glb"
expect 0 'beech .* 1\.4 m high' grow beech --clip "$out/box.obj" -o "$out/meshed.glb"
expect 1 'WIDTHxDEPTHxHEIGHT' grow beech --clip 1x2 -o "$out/a.glb"
expect 1 'not closed' grow beech --clip "$out/open.obj" -o "$out/a.glb"
expect 1 'it has no branches' grow fern --clip 1x1x1 -o "$out/a.glb"
expect 1 'allowed is one of the two' grow beech --clip 1x1x1 --height 2 -o "$out/a.glb"
cat >"$out/hedge.json" <<EOF
{"terrain": {"kind": "flat", "size_m": [4, 4]}, "variants": 1,
 "species": {"hedge": "$root/species/beech.json"}, "clips": {"hedge": {"box_m": [1.1, 0.7, 1.7]}},
 "layers": [{"species": "hedge", "spacing_m": 0.8, "yaw_deg": 0, "height_m": 1.7, "aspect": 1}]}
EOF
# shellcheck disable=SC2086  # $small is many words
expect 0 . render "$out/hedge.json" -o "$out/hedge.png" $small --gpu-validate
sed 's/"clips": {"hedge"/"clips": {"hedges"/' "$out/hedge.json" >"$out/wrong.json"
expect 1 'has the species "hedges"' check "$out/wrong.json"

# Scenes cut to meshes too.
hedge_scene() { # NAME CLIP: the hedge's scene with another clip
    sed "s|{\"box_m\": \[1.1, 0.7, 1.7\]}|$2|" "$out/hedge.json" >"$out/$1.json"
}
printf 'v %s\n' '-0.6 nan -0.4' '0.6 0 0' '0 1 0' >"$out/nan.obj"
echo 'f 1 2 3' >>"$out/nan.obj"
hedge_scene meshed '{"mesh": "box.obj"}'
hedge_scene leaky '{"mesh": "open.obj"}'
hedge_scene broken '{"mesh": "nan.obj"}'
hedge_scene lost '{"mesh": "lost.obj"}'
hedge_scene text '{"mesh": "hedge.json"}'
hedge_scene both '{"mesh": "box.obj", "box_m": [1, 1, 1]}'
hedge_scene neither '{}'
# shellcheck disable=SC2086  # $small is many words
expect 0 . render "$out/meshed.json" -o "$out/meshed.png" $small --gpu-validate
expect 1 'open.obj is not closed' render "$out/leaky.json" -o "$out/a.png" -q
expect 1 'nan.obj.*' render "$out/broken.json" -o "$out/a.png" -q
expect 1 'there is no file .*lost.obj' check "$out/lost.json"
expect 1 'allowed are .obj, .gltf, .glb, .fbx and .dae' check "$out/text.json"
expect 1 'both box_m and mesh' check "$out/both.json"
expect 1 'neither box_m nor mesh' check "$out/neither.json"

# What cannot be.
expect 2 'no output named' grow oak
expect 2 'must end in .glb, .obj, .png or .exr' grow oak -o "$out/a.fbx"
expect 2 'no species named' grow -o "$out/a.png"
expect 2 'a sheet is a .png' grow --sheet oak -o "$out/a.glb"
expect 2 'goes with one species' grow oak birch --variants 2 -o "$out/a.glb"
expect 2 'must end in .glb or .csv' export "$tiny" -o "$out/a.obj"
expect 1 'did you mean "oak"\?' grow oka -o "$out/a.glb"
expect 1 'there is no season "sommer"' grow oak --season sommer -o "$out/a.glb"
expect 1 'exclude each other' grow oak --season summer --month 3 -o "$out/a.glb"
expect 1 'allows' grow oak --height 100 -o "$out/a.glb"
expect 1 'allowed is one of the two' grow oak --height 10 --age 50 -o "$out/a.glb"
expect 1 'there is no form "flat"' grow oak --form flat -o "$out/a.png"
expect 1 'no such file' grow none.obj -o "$out/a.glb"
for option in --age --dbh --detail --month --seed --variants; do
    expect 1 'it is a model, for which a height alone' grow "$out/oak.obj" "$option" 2 -o "$out/a.glb"
done
expect 1 'it is a model, for which a height alone' grow "$out/oak.obj" --open 1 -o "$out/a.glb"
expect 1 'it is a model, for which a height alone' grow "$out/oak.obj" --season autumn -o "$out/a.glb"
expect 1 'directory does not exist' grow oak -o "$out/none/a.glb"
expect 1 'at most 10 are written' export "$tiny" --max-trees 10 -o "$out/a.glb"
expect 1 'at most 10 are written' export "$tiny" --max-trees 10 -o "$out/a.csv"
sed 's/"spacing_m": *[0-9.]*/"spacing_m": 0.0001/' "$root/species/oak.json" >"$out/dense.json"
expect 1 'has more than [0-9]* branches' export "$tiny" --set "species.oak=$out/dense.json" -o "$out/a.glb"
head -c 30000 "$out/oak.glb" >"$out/cut.glb"
expect 1 'cut.glb: ' grow "$out/cut.glb" -o "$out/a.glb"
expect 1 'cut.glb: ' check "$out/cut.glb"
check 'a failed command leaves nothing' sh -c "! ls '$out' | grep -E '^a\\.|weald-'"

# What is read is never written over, whatever links lead there.
ln -s "$out/oak.glb" "$out/link.glb"
sed 's/^o oak/o own/' "$out/oak.obj" >"$out/own.obj"
ln "$out/trees.csv" "$out/hard.csv"
(cd "$out" && sha256sum oak.* own.obj oak-oak-* box.obj trees.csv) >"$scratch/sums"
expect 1 'oak.glb: is the model of' grow "$out/oak.glb" -o "$out/oak.glb"
expect 1 'link.glb: is the model of' grow "$out/oak.glb" -o "$out/link.glb"
expect 1 'oak.glb: is the model of' grow "$out/link.glb" -o "$out/../out/oak.glb"
expect 1 'oak.mtl: is the material library of' grow "$out/own.obj" -o "$out/oak.obj"
expect 1 'oak-oak-leaf.png: is the texture of' grow "$out/own.obj" -o "$out/oak-oak-leaf.png" --gpu software
expect 1 'oak-oak-leaf.png: is the texture of' grow --sheet "$out/own.obj" -o "$out/oak-oak-leaf.png" --gpu software
expect 1 'box.obj: is the clip of' grow beech --clip "$out/box.obj" -o "$out/box.obj"
expect 1 'trees.csv: is the inventory of' export "$out/listed.json" -o "$out/trees.csv"
expect 1 'hard.csv: is the inventory of' export "$out/listed.json" -o "$out/hard.csv"
check 'and all of it is as it was' sh -c "cd '$out' && sha256sum -c --quiet '$scratch/sums'"

expect 0 "sheet.png: " grow --sheet "$out/oak.obj" -o "$out/sheet.png" --gpu software --size 96x96 --samples 2
check 'a sheet is no small picture' test "$(wc -c <"$out/sheet.png")" -gt 20000
finish
