#!/bin/sh
# Builds release into DIR (default: build), or only configures DIR with other options.
#   build.sh [DIR]
#   build.sh configure DIR MESON_SETUP_OPTION...
set -eu
cd "$(dirname "$0")/.."

configure() {
    [ ! -f "$1/build.ninja" ] || return 0
    log=$(mktemp)
    meson setup "$@" >"$log" 2>&1 || {
        cat "$log" >&2
        rm -f "$log"
        exit 1
    }
    rm -f "$log"
}

if [ "${1:-}" = configure ]; then
    shift
    configure "$@"
    exit 0
fi
build=${1:-build}
configure "$build" --buildtype=release -Dtests=auto
ninja --quiet -C "$build"
