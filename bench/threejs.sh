#!/bin/sh
# continuum beside three.js, which the peers folder describes: 75,000 trees on a square kilometre, 800 x
# 600, eye at 60 m over a corner, lit, shadowed, in wind. Where the peer cannot run, says so and ends well.
#   threejs.sh BUILD
set -eu
build=$(realpath "$1")
peers=../shared/peers/web
skip() {
    echo "skipped: $1"
    exit 0
}
[ -f "$peers/forest.html" ] || skip "no $peers"
for need in node npm chromium xvfb-run; do
    command -v "$need" >/dev/null || skip "$need is not installed"
done
folder=${XDG_CACHE_HOME:-$HOME/.cache}/weald-bench/threejs
mkdir -p "$folder"
cp "$peers/package.json" "$peers/run.mjs" "$peers/forest.html" "$peers/tree.png" "$folder"
[ -d "$folder/node_modules/three" ] ||
    (cd "$folder" && npm install --silent --no-fund --no-audit >/dev/null 2>&1) ||
    skip "npm cannot install three.js here"
frame_ms() { # of continuum, from above
    "$build/bench/figures" continuum-frame-ms | tee /dev/stderr |
        sed -n 's/^overview  *continuum  *frame  *\([0-9.]*\) ms.*/\1/p'
}
peer_ms() {
    (cd "$folder" && XDG_RUNTIME_DIR=/tmp xvfb-run -a node run.mjs \
        "n=75000&fr=20&lit=1&wind=1&shadow=1") | tee /dev/stderr |
        sed -n 's/.*"median":\([0-9.]*\).*/\1/p'
}
ours='' theirs=''
for turn in 1 2 3; do # other work on the machine comes and goes: in turn, and the middle one of each
    ours="$ours $(frame_ms)"
    peer=$(peer_ms)
    [ -n "$peer" ] || skip "three.js gave no time"
    theirs="$theirs $peer"
    echo "turn $turn: continuum ${ours##* } ms, three.js $peer ms"
done
middle() {
    printf '%s\n' "$@" | sort -n | sed -n 2p
}
awk -v a="$(middle $ours)" -v c="$(middle $theirs)" 'BEGIN {
    printf "continuum %.1f ms, three.js %.1f ms\n", a, c
    printf "continuum-vs-threejs %.2f x\n", a / c }'
