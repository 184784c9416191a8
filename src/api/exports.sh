#!/bin/sh
# Prints the linker's version script of a library that exports what these headers declare, and nothing else.
#   exports.sh HEADER...
set -eu
echo '{ global:'
sed -nE 's/^[a-z][a-z0-9_ *]*[ *](wd_[a-z0-9_]+)\(.*/    \1;/p' "$@"
echo 'local: *; };'
