#!/bin/sh
# Times ez-tree, which the peers folder describes; where it cannot be had, says so and ends well.
set -eu
peers=../shared/peers/web
skip() {
    echo "skipped: $1"
    exit 0
}
[ -f "$peers/ez.mjs" ] || skip "no $peers"
command -v node >/dev/null || skip "node is not installed"
command -v npm >/dev/null || skip "npm is not installed"
folder=${XDG_CACHE_HOME:-$HOME/.cache}/weald-bench/ez-tree
mkdir -p "$folder"
cp "$peers/package.json" "$peers/ez.mjs" "$folder"
cd "$folder"
[ -d node_modules/@dgreenheck/ez-tree ] || npm install --silent --no-fund --no-audit >/dev/null 2>&1 ||
    skip "npm cannot install ez-tree here"
node ez.mjs
