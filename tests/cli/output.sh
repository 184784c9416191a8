#!/bin/sh
# Pictures on software Vulkan, and outputs that cannot be.
set -u
. "$(dirname "$0")/lib.sh"
mkdir "$scratch/out"
soft="--gpu software"
out=$scratch/out

# shellcheck disable=SC2086  # $soft is two words
{
    expect 0 "a.png: 160x90, 1 sample, .* MB, .* s" render "$tiny" -o "$out/a.png" $soft
    expect 0 . render "$tiny" -o "$out/threads.png" $soft --threads 3
    draw 'seed.png: ' render "$tiny" -o "$out/seed.png" $soft --seed 8
    draw 'lod.png: ' render "$tiny" -o "$out/lod.png" $soft --view lod
    draw 'west.png: ' render "$tiny" -o "$out/west.png" $soft --camera west
    draw 'path.png: ' render "$tiny" -o "$out/path.png" $soft --path fly --time 2
    draw 'separate.png: ' render "$tiny" -o "$out/separate.png" $soft --method separate
    draw 'small.png: 33x47, 3 samples' render "$tiny" -o "$out/small.png" $soft --size 33x47 --samples 3
    draw 'pixel.png: 1x1' render "$tiny" -o "$out/pixel.png" $soft --size 1x1
    draw 'own.png: ' render "$tiny" -o "$out/own.png" $soft --method continuum
    draw 'coarse.png: ' render "$tiny" -o "$out/coarse.png" $soft --method continuum --max-error 8
    draw 'matte.exr: ' render "$tiny" -o "$out/matte.exr" $soft --samples 4 --layers color,cryptomatte \
        --set time.date=2026-10-18 --set wind.speed_mps=7 --set ground.snow=0.25
    draw 'layers.exr: ' render "$tiny" -o "$out/layers.exr" $soft
    drawn
    expect 0 'validate.png: ' render "$tiny" -o "$out/validate.png" $soft --gpu-validate
    expect 0 'trees .*[0-9]' render "$tiny" -o "$out/times.png" $soft --times
    cp "$scratch/output" "$scratch/times"
    check 'and the whole frame' grep -q 'whole frame' "$scratch/times"
    expect 2 'there is no layer "colour"' render "$tiny" -o "$out/none.exr" $soft --layers depth,colour
    expect 2 'layers is for .exr' render "$tiny" -o "$out/none.png" $soft --layers depth
}
check 'threads change no picture' cmp "$out/a.png" "$out/threads.png"
check 'validation changes no picture' cmp "$out/a.png" "$out/validate.png"
check 'an error bound changes the picture' sh -c "! cmp -s '$out/own.png' '$out/coarse.png'"
for other in seed lod west path; do
    check "$other changes the picture" sh -c "! cmp -s '$out/a.png' '$out/$other.png'"
done
colors() { # distinct colours of a picture
    ffmpeg -v error -i "$1" -f rawvideo -pix_fmt rgb24 - | od -An -v -w3 -tx1 | sort -u | wc -l
}
check 'a picture has many colours' test "$(colors "$out/a.png")" -gt 200
size=$(ffprobe -v error -show_entries stream=width,height -of csv=p=0 "$out/small.png")
check 'size 33x47' test "$size" = 33,47
size=$(ffprobe -v error -show_entries stream=width,height -of csv=p=0 "$out/layers.exr")
check 'EXR can be read' test "$size" = 160,90
for layer in Z N.X albedo.R species tree_id velocity.X; do
    check "EXR names layer $layer" grep -aqF "$layer" "$out/layers.exr"
done
for key in name hash conversion manifest MurmurHash3_32 uint32_to_float32 tree_1; do
    check "a matte's header holds $key" grep -aqF "$key" "$out/matte.exr"
done
for key in '"time":{"date":"2026-10-18","clock":null}' '"wind":{"speed_mps":7.0,' '"snow":0.25'; do
    check "pictures tell of their weather: $key" grep -aqF "$key" "$out/matte.exr"
done
# A camera that the viewer saved, in the working directory.
echo '{"cameras": [{"name": "saved-1", "position_m": [31, 21.5, 30], "yaw_deg": 0, "pitch_deg": -90, "fov_deg": 40}]}' \
    >"$out/tiny.cameras.json"
# shellcheck disable=SC2086
(cd "$out" && "$weald" render "$tiny" -o saved.exr $soft --camera saved-1 --size 16x9 -q)
check 'a saved camera is one of --camera' grep -aqF '"position_m":[31.0,21.5,30.0]' "$out/saved.exr"
check 'a matte holds no other layer' sh -c "! grep -aqF albedo '$out/matte.exr'"
check '--quiet prints nothing' sh -c \
    "'$weald' render '$tiny' -o '$out/q.png' $soft --quiet 2>&1 | ( ! grep . )"

# What cannot be, with an older file in place that must survive.
cp "$out/a.png" "$out/keep.png"
# shellcheck disable=SC2086
{
    expect 1 'no camera "wset", did you mean "west"' render "$tiny" -o "$out/keep.png" $soft \
        --camera wset
    expect 1 'there are: south, inside, west' render "$tiny" -o "$out/keep.png" $soft --camera nowhere
    expect 1 'there are: fly' render "$tiny" -o "$out/keep.png" $soft --path nowhere
    expect 1 'no-such-gpu' render "$tiny" -o "$out/keep.png" --gpu no-such-gpu
    expect 1 'max-error is for the method continuum, not for octree' render "$tiny" \
        -o "$out/keep.png" $soft --method octree --max-error 2
    expect 2 'must be a number from 0.25 to 32' render "$tiny" -o "$out/keep.png" $soft --max-error 0
    expect 2 'must be a number from 0.25 to 32' render "$tiny" -o "$out/keep.png" $soft --max-error nan
    expect 2 'a still must not depend on a clock' render "$tiny" -o "$out/keep.png" $soft --budget-ms 40
    expect 1 'does not exist' render "$tiny" -o "$out/none/a.png" $soft
    expect 2 'must end in' render "$tiny" -o "$out" $soft
    mkdir "$out/dir.png"
    expect 1 'is a directory' render "$tiny" -o "$out/dir.png" $soft
    expect 1 'cannot be written' render "$tiny" -o /proc/a.png $soft
    ln -s /dev/full "$out/full.png"
    expect 1 'device' render "$tiny" -o "$out/full.png" $soft
}
# Nor do pictures replace what they are made from.
# shellcheck disable=SC2086  # $soft is two words
{
    expect 0 'sky-0.exr: ' render "$tiny" -o "$out/sky-0.exr" $soft --size 8x4 --layers color
    cp "$out/sky-0.exr" "$scratch/sky.exr"
    expect 1 'sky-0.exr: is the sky of' render "$tiny" --set "sky.file=$out/sky-0.exr" -o "$out/sky-0.exr" $soft
    expect 1 'sky-0.exr: is the sky of' render "$tiny" --set "sky.file=$out/sky-0.exr" -o "$out/sky-%d.exr" \
        --path fly --frames 2 $soft
}
check 'a sky stays as it was' cmp "$out/sky-0.exr" "$scratch/sky.exr"
check 'a failed render keeps the older file' cmp "$out/a.png" "$out/keep.png"

# A full disk, as a limit on the size of files: one block of 512 bytes.
for name in keep.png full.exr; do
    status=0
    (
        ulimit -f 1
        exec "$weald" render "$tiny" -o "$out/$name" --gpu software
    ) >"$scratch/limit" 2>&1 || status=$?
    check "full disk: exit 1 for $name" test "$status" -eq 1
    check "full disk: message for $name" grep -q "$name" "$scratch/limit"
done
check 'full disk: older file kept' cmp "$out/a.png" "$out/keep.png"
check 'full disk: nothing half written' test ! -e "$out/full.exr"
left=$(find "$out" -name '.*' -o -name '*tmp*' -o -name '*weald-*' | head -3)
check "no temporary files are left: $left" test -z "$left"
finish
