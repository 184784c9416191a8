#!/bin/sh
# Films: whole, stopped, and impossible ones.
set -u
. "$(dirname "$0")/lib.sh"
mkdir "$scratch/out"
out=$scratch/out
size="--size 64x48 --gpu software"

frames() { # frames in a film that can be decoded
    ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 "$1"
}
complete_png() { # a PNG ends with an IEND chunk
    [ "$(tail -c 8 "$1" | head -c 4)" = IEND ]
}

# shellcheck disable=SC2086
{
    expect 0 'fly.mp4: 5 frames' render "$tiny" -o "$out/fly.mp4" --path fly --frames 5 $size
    expect 0 'wind.mp4: 3 frames' render "$tiny" -o "$out/wind.mp4" --camera west --frames 3 $size
    expect 0 '8 frames' render "$tiny" -o "$out/speed.mp4" --path fly --fps 2 $size
    expect 0 '3 frames' render "$tiny" -o "$out/f-%05d.png" --path fly --frames 3 $size
    expect 0 '2 frames' render "$tiny" -o "$out/e-%d.exr" --path fly --frames 2 $size
    expect 0 '8 frames' render "$tiny" -o "$out/m-%d.exr" --path fly --fps 2 $size
    expect 0 . render "$tiny" -o "$out/still.exr" --path fly --time 1 --fps 2 $size
    expect 0 . render "$tiny" -o "$out/first.exr" --path fly --fps 2 $size
    expect 0 'budget 1 ms: 6 frames took longer; error at the end 1[0-9]' render "$tiny" \
        -o "$out/held.mp4" --method continuum --budget-ms 1 --frames 6 $size
    expect 2 'exclude each other' render "$tiny" -o "$out/p.mp4" --budget-ms 9 --max-error 2 $size
    expect 1 'budget-ms is for the method continuum' render "$tiny" -o "$out/p.mp4" --method octree \
        --budget-ms 9 $size
    expect 1 'even' render "$tiny" -o "$out/odd.mp4" --frames 2 --size 63x47 --gpu software
    expect 1 'none' render "$tiny" -o "$out/none/f.mp4" --frames 2 $size
    expect 1 'nowhere' render "$tiny" -o "$out/p.mp4" --path nowhere $size
    expect 1 . render "$tiny" -o "$out/g-%s.png" --frames 2 $size
    expect 1 . render "$tiny" -o "$out/g-%d-%d.png" --frames 2 $size
    expect 1 . render "$tiny" -o "$out/none/g-%d.png" --frames 2 $size
}
check 'fly.mp4 has 5 frames' test "$(frames "$out/fly.mp4")" = 5
check 'speed.mp4 has 4 s at 2 a second' test "$(frames "$out/speed.mp4")" = 8
check 'the camera moves' sh -c "! cmp -s '$out'/f-00000.png '$out'/f-00001.png"
check 'numbered pictures' complete_png "$out/f-00002.png"
check 'a still is as a frame, its motion too' cmp "$out/still.exr" "$out/m-2.exr"
check 'the first as well' cmp "$out/first.exr" "$out/m-0.exr"
check 'numbered layers' test -s "$out/e-1.exr"
rm -f "$out"/*

# As many frames as keys: each is what a camera there sees.
sed -e 's,^ *//.*,,' -e "s,\.\./\.\./,$root/,g" "$tiny" >"$scratch/plain.json"
jq '.wind.speed_mps = 0 | .cameras = [range(5) | {name: "c\(.)", position_m: [10 + . * 3.7, 5 + . * 1.3, 6],
    look_at_m: [30, 20 + . * 2, 3]}] | .paths = [{name: "p", duration_s: 7.3, keys: (.cameras | map(del(.name)))}]' \
    "$scratch/plain.json" >"$scratch/keys.json"
# shellcheck disable=SC2086
{
    expect 0 '5 frames' render "$scratch/keys.json" -o "$out/k-%d.png" --path p --frames 5 $size
    expect 0 . render "$scratch/keys.json" -o "$out/still.png" --camera c3 $size
}
check 'frame 3 is the key 3' cmp "$out/still.png" "$out/k-3.png"

# The sun of a day: the last frame is a still's at that hour.
jq '.time = {date: "2026-06-21", latitude_deg: 48, longitude_deg: 11} | del(.sun)' "$scratch/keys.json" >"$scratch/day.json"
# shellcheck disable=SC2086
{
    day="$scratch/day.json $size --camera c3"
    expect 0 '3 frames' render $day -o "$out/d-%d.png" --frames 3 --clock 05:30-12:00
    expect 0 . render $day -o "$out/noon.png" --clock 12:00
    expect 0 . render $day -o "$out/clock.png" --set time.clock=12:00
    expect 2 'no hour like 17:30' render $day -o "$out/none.png" --clock 25:00
    for hour in 7 -0:30 +7:30 07:60 24:01 07:30- 05:00-7:00 05:00-07:00x; do
        expect 2 'no hour like 17:30' render $day -o "$out/none.png" "--clock=$hour"
    done
    expect 2 'a still has one hour' render $day -o "$out/none.png" --clock 05:00-09:00
    expect 1 'needs date, latitude_deg' render "$scratch/keys.json" $size -o "$out/none.png" --clock 12:00
}
check 'an hour is the one of the scene' cmp "$out/noon.png" "$out/clock.png"
check 'the last frame is of the last hour' cmp "$out/noon.png" "$out/d-2.png"
check 'the sun moves' sh -c "! cmp -s '$out/d-0.png' '$out/d-1.png' && ! cmp -s '$out/d-1.png' '$out/d-2.png'"

# Parts of it: as in the whole, each with its own checkpoint.
mkdir "$out/parts"
# shellcheck disable=SC2086
{
    part="render $scratch/keys.json -o $out/parts/k-%d.png --path p --frames 5 $size"
    touch "$out/parts/k-%d.png.partial" "$out/parts/k-%d.png.4.partial"
    expect 0 '3 frames' $part --only 1-3
    check 'and no others' test ! -e "$out/parts/k-0.png" -a ! -e "$out/parts/k-4.png"
    for i in 1 2 3; do
        check "frame $i alone is as in the whole" cmp "$out/k-$i.png" "$out/parts/k-$i.png"
    done
    check 'checkpoints of other parts stay' test "$(find "$out/parts" -name '*.partial' | wc -l)" -eq 2
    rm "$out/parts"/*.partial
    printf '%s\n' "$part --only 2-3" "$part --only 4-4" >"$scratch/parts"
    expect 0 'parts: 1 lines left out' batch "$scratch/parts" --skip-existing
    check 'frame 4 alone is as in the whole' cmp "$out/k-4.png" "$out/parts/k-4.png"
    expect 1 'the film has frames 0 to 4' $part --only 3-5
    expect 2 'found no two numbers' $part --only 3-2
    expect 2 'found no two numbers' $part --only 3
    expect 2 'is for numbered files' render "$scratch/keys.json" -o "$out/k.mp4" --only 1-2 $size
}
rm -r "$out/parts"
rm -f "$out"/*

# start NAME FRAMES OPTION...: a film in the background
start() {
    name=$1
    count=$2
    shift 2
    # shellcheck disable=SC2086
    "$weald" render "$tiny" -o "$out/$name" --path fly --frames "$count" $size "$@" >"$scratch/log" 2>&1 &
    pid=$!
}
# await FILE-TEST...: until it holds, at most a minute
await() {
    for _ in $(seq 600); do
        "$@" >/dev/null 2>&1 && return 0
        sleep 0.1
    done
    return 1
}
larger() { # larger FILE BYTES
    [ "$(wc -c <"$1")" -gt "$2" ]
}
begun() { # begun FILM: some frames are kept, or all
    [ -e "$1" ] || larger "$1.partial" 20000
}
stop() { # stop SIGNAL STATUS
    kill "-$1" "$pid"
    status=0
    wait "$pid" || status=$?
    check "$1: exit status $2, was $status" test "$status" -eq "$2"
}

start 's-%05d.png' 4000
check 'frames appear while filming' await test -e "$out/s-00003.png"
stop INT 130
check 'the message counts what is kept' grep -qE 'finished [0-9]+ of 4000' "$scratch/log"
bad=0
for file in "$out"/s-*.png; do
    complete_png "$file" || bad=$((bad + 1))
done
check 'every picture left is whole' test "$bad" -eq 0
check 'nothing else is left' sh -c "! ls -A '$out' | grep -vE '^s-[0-9]{5}\\.png$|^s-%05d\\.png\\.partial$'"
said=$(sed -n 's/.*finished \([0-9]*\) of.*/\1/p' "$scratch/log")
sum=$(cksum <"$out/s-00001.png")
printf half >"$out/.2147483646.2147483647-s-$(printf %05d "$said").png" # as a kill leaves the frame that is being written
start 's-%05d.png' 4000
check 'the same command goes on' await grep -q "going on after $said of 4000" "$scratch/log"
check 'nothing of a killed process is left' await sh -c "! ls -A '$out' | grep -q '^\.2147'"
stop INT 130
said=$(sed -n 's/.*finished \([0-9]*\) of.*/\1/p' "$scratch/log")
printf '#' >>"$out/s-00002.png"
start 's-%05d.png' 4000
check 'the same command goes on where a picture is no more what it was' \
    await grep -q 'going on after 2 of 4000' "$scratch/log"
check 'beyond where it was' await test -e "$out/s-$(printf %05d "$said").png"
stop INT 130
check 'pictures are whole again' complete_png "$out/s-00002.png"
check 'the others are left alone' test "$(cksum <"$out/s-00001.png")" = "$sum"
rm -f "$out"/*

# shellcheck disable=SC2086
expect 0 '12 frames' render "$tiny" -o "$out/whole.mp4" --path fly --frames 12 --fps 3 $size
for _ in $(seq 20); do # a busy machine may let a film finish before it is killed
    rm -f "$out/killed.mp4"
    start killed.mp4 12 --fps 3
    check 'frames are kept' await begun "$out/killed.mp4"
    kill -KILL "$pid"
    wait "$pid" 2>/dev/null
    [ -e "$out/killed.mp4" ] || break
done
check 'a killed film is not there' test ! -e "$out/killed.mp4"
check 'its frames are' test -s "$out/killed.mp4.partial"
cp "$out/killed.mp4.partial" "$scratch/damaged"
printf '#' | dd of="$scratch/damaged" bs=1 seek=12000 conv=notrunc 2>/dev/null
# shellcheck disable=SC2086
{
    expect 1 'another scene' render "$tiny" -o "$out/killed.mp4" --path fly --frames 12 --fps 3 $size \
        --samples 2
    expect 1 'another scene' render "$tiny" -o "$out/killed.mp4" --path fly --frames 12 --fps 3 $size \
        --set wind.speed_mps=9
    expect 0 'going on after [1-9][0-9]* of 12' render "$tiny" -o "$out/killed.mp4" --path fly \
        --frames 12 --fps 3 $size
    check 'as if it had never been killed' cmp "$out/whole.mp4" "$out/killed.mp4"
    cp "$scratch/damaged" "$out/killed.mp4.partial"
    expect 0 'going on after [1-9] of 12' render "$tiny" -o "$out/killed.mp4" --path fly --frames 12 \
        --fps 3 $size
}
check 'what is damaged is drawn anew' cmp "$out/whole.mp4" "$out/killed.mp4"
check 'nothing else is left' test "$(ls -A "$out" | wc -l)" = 2
rm -f "$out"/*

start stopped.mp4 4000
check 'progress in plain lines' await grep -q 'frames 0%' "$scratch/log"
check 'frames are kept' await larger "$out/stopped.mp4.partial" 20000
stop TERM 143
kept=$(frames "$out/stopped.mp4")
check "a stopped film plays ($kept frames)" test "${kept:-0}" -gt 0
said=$(sed -n 's/.*finished \([0-9]*\) of.*/\1/p' "$scratch/log")
check "and has as many frames as said ($said)" test "${kept:-none}" = "$said"
check 'nothing else is left' sh -c "! ls -A '$out' | grep -vE '^stopped.mp4(.partial)?$'"
rm -f "$out"/*

status=0
(
    ulimit -f 8
    # shellcheck disable=SC2086
    exec "$weald" render "$tiny" -o "$out/full.mp4" --path fly --frames 60 $size
) >"$scratch/output" 2>&1 || status=$?
check "full disk in a film: exit 1, was $status" test "$status" -eq 1
check 'full disk in a film: nothing half written' sh -c "! ls -A '$out' | grep -vx full.mp4.partial"
finish
