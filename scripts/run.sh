#!/bin/sh
# Shows the default scene: in a window where there is a display that works, else as a picture.
set -eu
cd "$(dirname "$0")/.."

weald=${1:-build}/cli/weald
no_display=3 # exit status of `weald view` where no window can be opened

if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    status=0
    "$weald" view scenes/valley.json || status=$?
    [ "$status" -eq "$no_display" ] || exit "$status"
    echo "No window can be opened here; rendering a picture instead."
fi
mkdir -p out
"$weald" render scenes/valley.json -o out/valley.png
echo "The picture is in $PWD/out/valley.png"
