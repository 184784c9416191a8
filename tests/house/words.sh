#!/bin/sh
# Words that mark unfinished work must not stand in the sources.
#   words.sh ROOT
set -eu
cd "$1"
folder_list=
for folder in src include shaders cli viewer examples bench scripts; do
    [ ! -d "$folder" ] || folder_list="$folder_list $folder"
done
# shellcheck disable=SC2086  # one word a folder
if grep -rnwE 'TODO|FIXME|XXX|HACK|TBD|stub|[Nn]ot implemented|placeholder' $folder_list; then
    echo "words of unfinished work in the lines above"
    exit 1
fi
