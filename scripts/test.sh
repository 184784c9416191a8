#!/bin/sh
# Every test: the release build on software Vulkan, and what needs no GPU again under ASan and UBSan, by another
# compiler at -O1: hashes of worlds and trees are part of the tests and must not move.
set -eu
cd "$(dirname "$0")/.."
build=${1:-build}

software=
for file in /usr/share/vulkan/icd.d/lvp_icd.*json /etc/vulkan/icd.d/lvp_icd.*json; do
    [ ! -f "$file" ] || software=$file
done
[ -n "$software" ] || {
    echo "test: no software Vulkan driver (lvp_icd.json); install mesa-vulkan-drivers" >&2
    exit 1
}
export VK_DRIVER_FILES="$software" VK_ICD_FILENAMES="$software"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'trap "" TERM; kill 0; exit 130' INT # what is started beside the tests knows no Ctrl-C
step() { # step NAME COMMAND...: runs it, remembers a failure, goes on
    step_name=$1
    shift
    printf '\n=== %s\n' "$step_name"
    step_begin=$(date +%s)
    if "$@"; then
        printf '%s: passed (%s s)\n' "$step_name" $(($(date +%s) - step_begin))
    else
        printf '%s: FAILED (%s s)\n' "$step_name" $(($(date +%s) - step_begin))
        printf ', %s' "$step_name" >>"$scratch/failed"
    fi
}

scripts/build.sh "$build"
# A build made before the test packages were there has the tests switched off.
meson introspect "$build" --tests | grep -q '"name"' ||
    meson setup --reconfigure -Dtests=enabled "$build" >/dev/null
scripts/build.sh "$build"

# Tests of windows wait, and linkers and many tests have one thread: the other build fills the processors
# meanwhile.
step 'sanitizers and second compiler' scripts/test-sanitizers.sh >"$scratch/others" 2>&1 </dev/null &
step release meson test -C "$build" --no-rebuild --print-errorlogs
echo 'waiting for the sanitizers'
wait $!
cat "$scratch/others"

printf '\n'
[ ! -s "$scratch/failed" ] || {
    echo "Tests FAILED in: $(cut -c3- "$scratch/failed")"
    exit 1
}
echo "All tests passed."
