#!/bin/sh
# The viewer in a window of its own X server, driven by real key, mouse and window events; what
# they did is read from the report lines that F9 asks for.
#   keys.sh WEALD CLOSE_WINDOW ROOT
set -u
weald=$1
close_window=$2
root=$3
for need in Xvfb xdotool jq ffmpeg; do
    command -v "$need" >/dev/null 2>&1 || {
        echo "skipped: $need is not installed"
        exit 77
    }
done
scratch=$(mktemp -d)
report=$scratch/report
mkdir "$scratch/shots"
sed "s,\.\./\.\./,$root/,g" "$root/tests/viewer/tiny.json" >"$scratch/tiny.json"
viewer=
server=
cleanup() {
    [ -z "$viewer" ] || kill -KILL "$viewer" 2>/dev/null
    [ -z "$server" ] || kill "$server" 2>/dev/null
    rm -rf "$scratch"
}
trap cleanup EXIT
trap 'exit 1' INT TERM

fail() {
    echo "FAIL $*"
    [ ! -s "$report" ] || tail -n 2 "$report"
    sed 's/^/     | /' "$scratch/log"
    exit 1
}

# within SECONDS COMMAND...: polls until it succeeds
within() {
    tries=$(($1 * 10))
    shift
    while ! "$@"; do
        tries=$((tries - 1))
        [ "$tries" -gt 0 ] || return 1
        kill -0 "$viewer" 2>/dev/null || return 1
        sleep 0.1
    done
}

longer_than() { [ "$(wc -l <"$report")" -gt "$1" ]; }
# ask: has the viewer append a line to the report
ask() {
    lines=$(wc -l <"$report")
    xdotool key F9
    within 20 longer_than "$lines" || fail "F9 gives no report"
}
# holds JQ-CONDITION: of the newest line; $before is the line kept by `remember`
holds() { tail -n 1 "$report" | jq -e --argjson before "$before" "$1" >/dev/null; }
remember() { before=$(tail -n 1 "$report"); }
# expect WHAT JQ-CONDITION: holds in one of the next reports
expect() {
    for _ in 1 2 3 4 5 6 7 8; do
        ask
        holds "$2" && {
            echo "ok   $1"
            return
        }
        sleep 0.3
    done
    fail "$1: not $2"
}
hold_key() { # hold_key KEY SECONDS: and for two frames at least, however slow they are
    xdotool keydown "$1"
    sleep "$2"
    ask
    ask
    xdotool keyup "$1"
}
find_window() { window=$(xdotool search --onlyvisible --name '^weald: tiny' 2>/dev/null | head -1) && [ -n "$window" ]; }
start() {
    : >"$report"
    before=null
    "$weald" view "$scratch/tiny.json" --gpu software --size 320x240 --max-fps 5 \
        --report "$report" --screenshots "$scratch/shots" "$@" >"$scratch/log" 2>&1 &
    viewer=$!
    within 60 find_window || fail "no window appears"
    xdotool windowfocus --sync "$window"
    xdotool mousemove --window "$window" 160 120
}
ended() { # ended STATUS WHAT
    status=0
    for _ in $(seq 200); do
        kill -0 "$viewer" 2>/dev/null || break
        sleep 0.1
    done
    ! kill -0 "$viewer" 2>/dev/null || fail "$2: the viewer goes on"
    wait "$viewer" || status=$?
    viewer=
    [ "$status" -eq "$1" ] || fail "$2: exit status $status instead of $1"
    [ "$(tail -n 1 "$report" | jq -r .event)" = exit ] || fail "$2: no last report"
    echo "ok   $2"
}

# Without a display there is no window, and the exit status says so.
status=0
env -u DISPLAY -u WAYLAND_DISPLAY "$weald" view "$scratch/tiny.json" >"$scratch/log" 2>&1 ||
    status=$?
[ "$status" -eq 3 ] || fail "no display: exit status $status instead of 3"
grep -q 'no window can be opened' "$scratch/log" || fail "no display: no message"
echo "ok   no display"

# refused WHAT OPTIONS...: before a forest is planted
refused() {
    what=$1
    shift
    status=0
    "$weald" view "$scratch/tiny.json" "$@" >"$scratch/log" 2>&1 || status=$?
    [ "$status" -eq 1 ] && grep -q "$what" "$scratch/log" && ! grep -q ' trees' "$scratch/log" ||
        fail "$what: exit status $status instead of 1"
    echo "ok   $what"
}

mkfifo "$scratch/display"
# Without -noreset it starts anew when the last window closes, and refuses whoever comes then.
Xvfb -noreset -displayfd 3 -screen 0 1024x768x24 -nolisten tcp 3>"$scratch/display" 2>/dev/null &
server=$!
read -r number <"$scratch/display"
DISPLAY=:$number
export DISPLAY
unset WAYLAND_DISPLAY

refused 'none/report cannot be written: its directory does not exist' --report "$scratch/none/report"
refused 'shots is a directory' --report "$scratch/shots"
refused 'none/weald.png cannot be written' --screenshots "$scratch/none"

start
ask
holds '.gait == "fly" and .width == 320 and .height == 240 and .camera == "south"' ||
    fail "the beginning"
echo "ok   the beginning"

xdotool click 1
expect 'the left button tells of a tree' '.picked_id > 0 and .picked_id <= 200'
xdotool mousemove --window "$window" 160 238 click 1
expect 'and of none where there is ground' '.picked_id == 0'
xdotool mousemove --window "$window" 160 120

remember
hold_key w 0.5
expect 'W flies forward (north)' '.position_m[1] > $before.position_m[1] + 5'
remember
hold_key d 0.3
expect 'D flies right (east)' '.position_m[0] > $before.position_m[0] + 2'
remember
hold_key e 0.3
expect 'E rises' '.position_m[2] > $before.position_m[2] + 2'
remember
xdotool click 4 click 4
expect 'the wheel changes the speed' '.speed_factor > $before.speed_factor * 1.3'
xdotool click 5 click 5
remember
xdotool mousedown 3
sleep 0.3
xdotool mousemove_relative 60 0
sleep 0.3
xdotool mouseup 3
expect 'the right button looks around' '.yaw_deg > $before.yaw_deg + 3'

# With 70 m of ground ahead: slow machines fly far in few frames, and beyond its edge it is level.
xdotool key c
expect 'C goes to the next camera' '.camera == "inside" and .position_m[0] == 10'
on_ground='((.position_m[2] - .ground_m - 1.7) | fabs) < 0.001'
xdotool key f
expect 'F lands on the ground, 1.7 m up' ".gait == \"walk\" and $on_ground"
remember
hold_key w 1
expect 'W walks, 1.7 m above the ground' \
    "(.position_m != \$before.position_m) and $on_ground and .ground_m != \$before.ground_m"
xdotool key f
expect 'F flies again' '.gait == "fly"'

remember
xdotool key m
expect 'M changes the method' '.method != $before.method'
xdotool key l
expect 'L colours by level' '.view == "lod"'
xdotool key l
expect 'L again does not' '.view == "lit"'
remember
xdotool key o
expect 'O is a quarter of an hour later' \
    '((.sun_elevation_deg - $before.sun_elevation_deg) | fabs) | . > 0.1 and . < 3.8'
xdotool keydown shift key o keyup shift
expect 'Shift+O earlier' '((.sun_elevation_deg - $before.sun_elevation_deg) | fabs) < 0.001'
xdotool key t
expect 'T shows times' '.times'
xdotool key h
expect 'H shows help' '.help'
xdotool key h

xdotool key F12
expect 'F12 takes a screenshot' '.screenshots == 1'
shot=$(ls "$scratch"/shots/weald-*.png) || fail "no screenshot"
size=$(ffprobe -v error -show_entries stream=width,height -of csv=p=0 "$shot")
[ "$size" = 320,240 ] || fail "the screenshot is $size"
colors=$(ffmpeg -v error -i "$shot" -f rawvideo -pix_fmt rgb24 - | od -An -v -w3 -tx1 | sort -u | wc -l)
[ "$colors" -gt 100 ] || fail "the screenshot has $colors colours"
echo "ok   the screenshot is a picture"

xdotool windowsize "$window" 400 300
expect 'the picture follows the window' '.width == 400 and .height == 300'
xdotool windowsize "$window" 211 137
expect 'to odd sizes, too' '.width == 211 and .height == 137'

xdotool keydown shift key c keyup shift
expect 'Shift+C saves a camera' '.saved_cameras == 1'
jq -e '.cameras[0].position_m | length == 3' "$scratch/tiny.cameras.json" >/dev/null ||
    fail "no camera in the file"
remember
xdotool key c
expect 'C goes to the one after it' '.camera == "west" and .position_m[0] == -20'
xdotool key c
expect 'and to the saved one' '.camera == "saved-1" and
    ((.position_m[1] - $before.position_m[1]) | fabs) < 0.001'

xdotool key p
expect 'P plays the path' '.path_playing and .position_m[1] > -25'
remember
expect 'the path goes on' '.position_m != $before.position_m'
xdotool key p

xdotool windowunmap --sync "$window"
sleep 0.5
xdotool windowmap --sync "$window"
xdotool windowfocus --sync "$window"
remember
expect 'frames go on after the window was hidden' '.frames > $before.frames'
"$close_window" "$window" || fail "no message to the window"
ended 0 'closing the window ends the viewer'

start --walk --camera west --view albedo
ask
holds '.gait == "walk" and .view == "albedo" and .camera == "west" and .saved_cameras == 1 and '"$on_ground" ||
    fail "options"
echo "ok   options"
xdotool key l
expect 'L colours by level in place of albedo' '.view == "lod"'
xdotool key l
expect 'and comes back to it' '.view == "albedo"'
remember
sleep 1
ask
holds '.frames > $before.frames and .frames <= $before.frames + 12' || fail "five frames a second"
echo "ok   five frames a second"
xdotool key Escape
ended 0 'Escape ends the viewer'

start --camera saved-1 --method continuum --set planting=on_demand
expect 'trees on demand, from a saved camera' '.method == "continuum" and .frames > 2 and .camera == "saved-1"'
xdotool key m
remember
expect 'M leaves the method that alone can draw them' '.method == "continuum" and
    .frames > $before.frames + 1'
grep -q 'needs all trees in memory' "$scratch/log" || fail "M: nothing is said"
xdotool key Escape
ended 0 'and the viewer goes on'

start --gpu-validate
expect 'the viewer is valid Vulkan' '.frames > 3'
xdotool key t windowsize "$window" 300 200
expect 'also after resizing' '.width == 300 and .times'
kill -INT "$viewer"
ended 130 'Ctrl-C ends the viewer'
