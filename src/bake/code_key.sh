#!/bin/sh
# A header with a number that changes whenever one of the files does:
#   code_key.sh FILE... > HEADER
set -eu
key=$(for file in "$@"; do cat "$file"; done | sha256sum | cut -c1-16)
printf '#define WD_CODE_KEY 0x%sull\n' "$key"
