#!/bin/sh
# Names of the tests of a build directory that begin with one of the given folders.
#   select-tests.sh BUILD FOLDER...
set -eu
build=$1
shift
folders=$(printf '%s|' "$@")
meson introspect "$build" --tests | jq -r '.[].name' | grep -E "^(${folders%|})(-|\$)" | grep -v -- "-gpu\$"
