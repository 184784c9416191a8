#!/bin/sh
# Makes the pictures of docs/gallery.md, path-traced ones beside them, and fills in the page's errors.
# Stopped, the same command goes on.
#   scripts/gallery.sh BUILD [SIZE [SAMPLES [PATHS]]]
# DATA=DIR holds the files of scenes that need --data (default: ../shared/data if it is there).
set -eu
cd "$(dirname "$0")/.."
build=${1:-build}
size=${2:-1920x1080}
samples=${3:-16}
paths=${4:-7}
data=${DATA:-../shared/data}
work=out/gallery-$size
shown=docs/img/gallery
most=390kb

mkdir -p "$work" "$shown"
if [ -d "$data" ]; then
    "$build/bench/gallery" "$work" --size "$size" --samples "$samples" --paths "$paths" --data "$data"
else
    "$build/bench/gallery" "$work" --size "$size" --samples "$samples" --paths "$paths"
fi

# At the best quality whose file is small enough to be kept in the repository.
for picture in "$work"/*.png; do
    name=$(basename "$picture" .png)
    convert "$picture" -sampling-factor 4:2:0 -interlace JPEG -define "jpeg:extent=$most" "$shown/$name.jpg"
done

# Rows of the page that carry <!-- NAME --> get their figures.
for figures in "$work"/*.txt; do
    name=$(basename "$figures" .txt)
    read -r flip bias <"$figures"
    sed -i "s|<!-- $name -->.*<!-- -->|<!-- $name -->FLIP $flip, mean radiance $bias%<!-- -->|" docs/gallery.md
done
echo "docs/gallery.md: pictures in $shown"
