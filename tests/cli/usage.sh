#!/bin/sh
# Command lines, right and wrong, that need no scene.
set -u
. "$(dirname "$0")/lib.sh"

status=0
"$weald" >"$scratch/output" 2>&1 || status=$?
check 'no arguments: usage, exit 2' test "$status" -eq 2
expect 0 '^weald [0-9]+\.[0-9]+' --version
expect 0 'weald render scenes/valley.json' --help
for command in render grow export view info check batch schema devices bench methods manual; do
    expect 0 '^Examples:' "$command" --help
    cp "$scratch/output" "$scratch/help"
    check 'whose options fit 80 columns' sh -c "! sed -n '/^Options:/,/^\$/p' '$scratch/help' | grep -E '.{81}'"
    expect 0 '^  weald ' "$command" -h
done
expect 2 'no command rendr, did you mean render\?' rendr "$tiny"
expect 2 'no command xyzzy$' xyzzy

expect 2 'no option --sise, did you mean --size\?' render "$tiny" -o a.png --sise 2x2
expect 2 'no option --camrea=x, did you mean --camera' render "$tiny" --camrea=x
expect 2 'no option --frobnicate$' render "$tiny" --frobnicate
expect 2 'no option --output' view "$tiny" --output a.png
expect 2 'no option -x' render "$tiny" -x
expect 2 "Try 'weald render --help'" render "$tiny" -x
expect 2 '--size needs a value: WxH' render "$tiny" --size
expect 2 '--times=1 takes no value' render "$tiny" --times=1
expect 2 'missing: SCENE' render -o a.png
expect 2 'one too many: b.json' render a.json b.json -o a.png
expect 2 'missing: FILE' check
expect 2 'must not be empty' render '' --camera ''

for size in 0x600 600x0 100000x100000 16385x1 -1x5 12x x12 12 axb 1x2x3 99999999999999999999x5 \
    0x0x 1.5x2 ' ' nanxnan; do
    expect 2 'each from 1 to 16384' render "$tiny" -o "$scratch/a.png" --size "$size"
done
for samples in 0 -1 1.5 many 65537 18446744073709551617 ''; do
    expect 2 'whole number from 1 to 65536' render "$tiny" -o "$scratch/a.png" --samples "$samples"
done
expect 2 'whole number from 1' render "$tiny" -o a.mp4 --frames 0
for fps in 0 nan inf -1 1e9; do
    expect 2 'a number from 0.01 to 1000' render "$tiny" -o a.mp4 --fps "$fps"
done
expect 2 'a number from 0' render "$tiny" -o a.png --time nan
expect 2 'whole number from 1 to 1024' info "$tiny" --threads 0

expect 2 'did you mean lod\?' render "$tiny" -o a.png --view lodd
expect 2 'no method "octre", did you mean "octree"\?' render "$tiny" -o a.png --method octre
expect 2 'there are: .*separate' render "$tiny" -o a.png --method painting
expect 2 'no method "octre"' view "$tiny" --method octre
expect 2 'no output named' render "$tiny"
expect 2 'must end in .png, .exr, .mp4, .m4v, .mov or .mkv' render "$tiny" -o a.gif
expect 2 'must end in .png, .exr, .mp4, .m4v, .mov or .mkv' render "$tiny" -o .png
for film in a.mp4 a.M4V a.mov a.mkv; do
    expect 2 'exclude each other' render "$tiny" -o "$film" --frames 5 --camera a --path b
done
expect 2 'holds one frame' render "$tiny" -o a.png --frames 5
expect 2 'exclude each other' render "$tiny" -o a.png --camera a --path b
for layer in velocity cryptomatte; do
    expect 2 "reference has no layer $layer" render "$tiny" -o a.exr --reference --layers "depth,$layer"
done
expect 2 'there are: scene, species' schema tree

expect 2 'there is no option --optoin, did you mean --option\?' render "$tiny" --optoin a=b
expect 2 'must be NAME=VALUE' render "$tiny" -o a.png --option max_cull_depth
expect 1 'setting methods.@method.max_cul_depth=3: .*did you mean "max_cull_depth"\?' \
    info "$tiny" --method octree --option max_cul_depth=3
expect 1 'whole number from 1 to 16' info "$tiny" --method octree --option max_cull_depth=17
expect 1 'setting methods.@method.faithful=true: unknown key; separate takes: none' info "$tiny" --method separate --faithful
expect 1 'did you mean "speed_mps"\?' info "$tiny" --set wind.sped_mps=0
expect 1 'no item "99" in the list; it has' info "$tiny" --set cameras.99=1
expect 1 'leads through' info "$tiny" --set seed.x=1
expect 0 'max_cull_depth +a whole number from 1 to 16 \(default 7; G5\)' methods
expect 0 '^octree' methods octree
expect 2 'did you mean "octree"' methods octre

for kind in scene species; do
    check "schema $kind is JSON" sh -c "'$weald' schema $kind | jq -e '.properties | length > 3'"
done
expect 0 'llvmpipe|lavapipe' devices
check 'a full standard output is a failure' sh -c "! '$weald' schema scene >/dev/full"
check 'manual page names every command' sh -c "'$weald' manual | grep -c '^.SS weald' | grep -qx 12"
if command -v groff >/dev/null 2>&1; then
    check 'manual page is clean roff' sh -c \
        "'$weald' manual | groff -man -ww -z -Tutf8 2>&1 | ( ! grep . )"
fi
finish
