#!/bin/sh
# Each public header compiles alone, first in its file, as C17 and as C++17, without a warning; both see all its
# constants.
#   headers.sh ROOT CC CXX
set -eu
cd "$1"
warnings='-Wall -Wextra -Wpedantic -Werror -Wshadow'
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0
for header in include/weald/*.h; do
    name=weald/$(basename "$header")
    for language in c c++; do
        source=$scratch/alone.$language
        standard=-std=${language}17
        compiler=$2
        [ "$language" = c ] || compiler=$3
        # Twice: the include guard is part of the promise.
        printf '#include <%s>\n#include <%s>\nextern int alone;\n' "$name" "$name" >"$source"
        printf 'void use(void);\nvoid use(void)\n{\n' >>"$source"
        grep -o '\<WD_[A-Z0-9_]*[A-Z0-9]\>' "$header" | sort -u | sed 's/.*/    (void)(&);/' >>"$source"
        printf '}\n' >>"$source"
        # shellcheck disable=SC2086
        if $compiler -x "$language" $standard $warnings -fsyntax-only -Iinclude "$source"; then
            echo "ok   $name $language"
        else
            echo "FAIL $name $language"
            failed=1
        fi
    done
done
exit "$failed"
