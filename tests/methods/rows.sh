#!/bin/sh
# Runs the table of rows in docs/methods.md: each row is drawn (or told) twice, with its option and
# against another setting, and the two must differ, or agree, as the table says.
#   rows.sh WEALD ROOT [FOLDER]
# With a folder, larger pictures are drawn and each row's two are left there side by side, as ROW.png.
set -u
weald=$1
root=$2
folder=${3:-}
size=${folder:+--size 288x216 --samples 4}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
scene=$root/tests/methods/rows.json

# Row O4 draws a file from elsewhere: any model file will do.
"$weald" grow "$root/species/birch.json" -o "$scratch/artist.obj" --detail 0.2 -q || exit 1

# result ARGUMENTS: $out is the file of what they draw or tell
result() {
    out=$scratch/$(printf '%s' "$*" | cksum | tr ' ' -).out
}

# words COLUMN: the options in a column of a row
words() {
    echo "$1" | sed "s/[^\`]*\`\([^\`]*\)\`.*/\1/; s|MODEL|$scratch/artist.obj|"
}

# make ARGUMENTS: tells it now, or has it drawn with all others
make() {
    result "$@"
    [ ! -e "$out" ] || return 0
    case $1 in
    info)
        shift
        "$weald" info "$scene" "$@" -q >"$out" || rm -f "$out"
        ;;
    *)
        : >"$out"
        echo "render $scene -o $out.png $size $* -q" >>"$scratch/pictures"
        ;;
    esac
}

# by_forest: lines that share a forest follow each other: those with the same settings and no options of methods
by_forest() {
    awk '{
        settings = ""
        for (i = 1; i <= NF; i++)
            if ($i == "--set") settings = settings " " $(i + 1)
            else if ($i == "--option" || $i == "--faithful") settings = settings " " $0
        print settings "\t" $0
    }' | sort -s -t "$(printf '\t')" -k 1,1 | cut -f 2-
}

covered=0
rows=0
sed -n '/^## Every row/,$ {/^| [GRWOI][0-9]/p}' "$root/docs/methods.md" >"$scratch/table"
# words of a row are options without blanks in them
# shellcheck disable=SC2046,SC2086,SC2116
while IFS='|' read -r _ _ _ with against _; do
    make $(words "$with")
    make $(words "$against")
done <"$scratch/table"
by_forest <"$scratch/pictures" | "$weald" batch - -q

# shellcheck disable=SC2046,SC2086,SC2116
while IFS='|' read -r _ row _ with against must _; do
    row=$(echo $row)
    with=$(words "$with")
    against=$(words "$against")
    rows=$((rows + 1))
    result $with
    first=$out
    result $against
    second=$out
    for out in "$first" "$second"; do
        [ ! -e "$out.png" ] || mv "$out.png" "$out"
    done
    if [ -s "$first" ] && [ -s "$second" ]; then
        [ -z "$folder" ] || [ "${with%% *}" = info ] ||
            ffmpeg -v error -y -f png_pipe -i "$first" -f png_pipe -i "$second" \
                -filter_complex hstack "$folder/$row.png" </dev/null
        if cmp -s "$first" "$second"; then found=agree; else found=differ; fi
        if [ "$found" = "$(echo $must)" ]; then
            covered=$((covered + 1))
            echo "ok   $row: $with"
        else
            echo "FAIL $row: $with and $against $found"
        fi
    else
        echo "FAIL $row: $with or $against"
    fi
done <"$scratch/table"
echo "rows-covered $covered rows"
[ "$covered" -eq "$rows" ] && [ "$rows" -eq 38 ]
