#!/bin/sh
# Files stay readable: no C source or header beyond 800 lines, the example of embedding within 150.
#   sizes.sh ROOT
set -eu
cd "$1"
find src include shaders cli viewer bench examples -type f \( -name '*.[ch]' -o -name '*.cpp' \
    -o -name '*.glsl' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag' \) -exec wc -l {} + |
    awk '$2 != "total" && ($1 > 800 || ($2 ~ /embed.c$/ && $1 > 150)) {
             print $2 ": " $1 " lines"; bad++ }
         END { exit bad > 0 }'
