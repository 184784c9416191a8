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

# run ARGUMENTS: result in $scratch/KEY.out, made once for the same arguments
run() {
    key=$(printf '%s' "$*" | cksum | tr ' ' -)
    out=$scratch/$key.out
    [ ! -e "$out" ] || return 0
    case $1 in
    info)
        shift
        "$weald" info "$scene" "$@" -q >"$out" 2>"$scratch/errors"
        ;;
    *)
        # shellcheck disable=SC2086 # words of an option
        "$weald" render "$scene" -o "$scratch/picture.png" $size "$@" -q 2>"$scratch/errors" &&
            mv "$scratch/picture.png" "$out"
        ;;
    esac
}

covered=0
rows=0
sed -n '/^## Every row/,$ {/^| [GRWOI][0-9]/p}' "$root/docs/methods.md" >"$scratch/table"
while IFS='|' read -r _ row _ with against must _; do
    row=$(echo $row)
    rows=$((rows + 1))
    with=$(echo "$with" | sed 's/[^`]*`\([^`]*\)`.*/\1/' | sed "s|MODEL|$scratch/artist.obj|")
    against=$(echo "$against" | sed 's/[^`]*`\([^`]*\)`.*/\1/')
    # words of a row are options without blanks in them
    # shellcheck disable=SC2086
    if run $with && first=$out && run $against && second=$out; then
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
        echo "FAIL $row: $with"
        sed 's/^/     | /' "$scratch/errors"
    fi
done <"$scratch/table"
echo "rows-covered $covered rows"
[ "$covered" -eq "$rows" ] && [ "$rows" -eq 38 ]
