#!/bin/sh
# Makes the pictures of README.md and docs/ (those of docs/gallery.md: gallery.sh).
#   scripts/pictures.sh BUILD [NAME]...    e.g. valley rows; without names, all
# DATA=DIR holds the files of scenes that need --data (default: ../shared/data if it is there; without, those
# pictures stay as they are).
set -eu
cd "$(dirname "$0")/.."
build=${1:-build}
[ $# -eq 0 ] || shift
wanted=$*
data=${DATA:-../shared/data}
shown=docs/img
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

is_wanted() { # is_wanted NAME
    case " ${wanted:-$1} " in
    *" $1 "*) ;;
    *) return 1 ;;
    esac
}

render() { # render SCENE FILE SIZE OPTION...
    render_scene=$1 render_file=$2 render_size=$3
    shift 3
    "$build/cli/weald" render "scenes/$render_scene.json" -o "$render_file" --size "$render_size" --samples 16 "$@"
}

jpeg() { # jpeg NAME SCENE SIZE CAMERA
    is_wanted "$1" || return 0
    render "$2" "$scratch/$1.png" "$3" --camera "$4"
    convert "$scratch/$1.png" -quality 88 "$shown/$1.jpg"
}

# Every method's picture of bench75k from a camera.
methods() { # methods CAMERA
    is_wanted "methods-$1" || return 0
    for method in octree separate grid impostor lod dissolve patch views zfield continuum; do
        render bench75k "$scratch/$method.png" 320x240 --camera "$1" --method "$method"
        set -- "$@" "$scratch/$method.png"
    done
    methods_camera=$1
    shift
    montage "$@" -tile 5x -geometry +0+0 -quality 88 "$shown/methods-$methods_camera.jpg"
}

# Artists' models as they are, and as scenes draw them near, in the middle distance and far away.
models() {
    is_wanted models || is_wanted models-range || return 0
    while read -r file height near middle far; do
        name=$(basename "$file" | sed 's/\..*//')
        for distance in whole "$near" "$middle" "$far"; do
            options="--form seen --camera-distance $distance"
            [ "$distance" != whole ] || options=
            # shellcheck disable=SC2086 # words of an option
            "$build/cli/weald" grow "$data/models/$file" --height "$height" --size 360x360 $options \
                -o "$scratch/$name-$distance.png"
        done
        set -- "$@" "$scratch/$name-whole.png"
        first="${first:-} $scratch/$name-$near.png"
        second="${second:-} $scratch/$name-$middle.png"
        third="${third:-} $scratch/$name-$far.png"
    done <<'MODELS'
sycamoreMaple/sycamoreMaple.obj 18 6.3 43 144
pine/pine.obj 20 7 48 160
sabalPalmeto/sabalPalmeto.obj 14 4.9 34 112
bush/bush.obj 3 1.05 7.2 24
cypress/cypress.obj 12 4.2 29 96
quaternius/BirchTree_4.glb 12 4.2 29 96
quaternius/CommonTree_Dead_1.glb 9 3.15 22 72
ez-tree/flower_white.glb 0.5 0.175 1.2 4
MODELS
    montage "$@" -tile 8x -resize 170x170 -geometry +0+0 "$shown/models.png"
    # shellcheck disable=SC2086 # names without blanks
    montage $first $second $third -tile 8x -resize 180x180 -geometry +0+0 "$scratch/ranges.png"
    for camera in near middle far; do
        render models "$scratch/$camera.png" 480x270 --camera "$camera" --data "$data"
    done
    montage "$scratch/near.png" "$scratch/middle.png" "$scratch/far.png" -tile 3x -geometry +0+0 "$scratch/scenes.png"
    convert "$scratch/ranges.png" "$scratch/scenes.png" -append -quality 88 "$shown/models-range.jpg"
}

rows() {
    is_wanted rows || return 0
    mkdir "$scratch/rows"
    # some options count pixels: whether pictures differ as they should is for the test to tell, at its own size
    tests/methods/rows.sh "$build/cli/weald" . "$scratch/rows" || :
    sed -n '/^## Every row/,$ {/^| [GRWOI][0-9]/p}' docs/methods.md >"$scratch/table"
    while read -r _ row _; do
        [ ! -f "$scratch/rows/$row.png" ] || set -- "$@" "$scratch/rows/$row.png"
    done <"$scratch/table"
    montage "$@" -tile 4x -resize 504x189 -geometry +0+0 -quality 88 "$shown/rows.jpg"
}

# Birches in fog, drawn and path-traced.
fog() {
    is_wanted fog || return 0
    for how in "--samples 16" "--samples 160 --reference"; do
        set -- "$@" "$scratch/fog$#.png"
        # shellcheck disable=SC2086 # words of options
        "$build/cli/weald" render scenes/gallery/birches.json --set fog.visibility_m=150 --set fog.height_m=25 \
            --size 640x360 $how -o "$scratch/fog$(($# - 1)).png"
    done
    convert "$@" +append -quality 88 "$shown/fog.jpg"
}

# A meadow whose trees have all grown as in a stand, and as their neighbours let them.
neighbours() {
    is_wanted neighbours || return 0
    render valley "$scratch/stand.png" 560x315 --camera lake --set 'in_the_open={}'
    render valley "$scratch/open.png" 560x315 --camera lake
    montage "$scratch/stand.png" "$scratch/open.png" -tile 2x -geometry +0+0 -quality 88 "$shown/neighbours.jpg"
}

# From sunrise to sunset in the valley.
day() {
    is_wanted day || return 0
    render valley "$scratch/day-%d.png" 400x225 --camera overview --frames 6 --clock 04:20-20:40 \
        --set time.date=2026-06-21 --set time.latitude_deg=48 --set time.longitude_deg=11
    montage "$scratch"/day-?.png -tile 3x -geometry +2+2 -quality 88 "$shown/day.jpg"
}

sheet() { # sheet NAME SPECIES...
    is_wanted "$1" || return 0
    sheet_name=$1
    shift
    "$build/cli/weald" grow --sheet "$@" --size 150x150 -o "$shown/$sheet_name.png"
}

jpeg valley valley 1280x720 glade
jpeg guerrero guerrero 640x400 overview
jpeg rpi rpi 640x400 overview
jpeg bruneton bruneton 640x400 slope
jpeg 3dworld 3dworld 640x400 overview
jpeg osg osg 640x400 walk
jpeg intel intel 640x400 walk
jpeg river river 960x540 bank
day
neighbours
methods overview
methods walk
fog
! is_wanted hedges || render hedges "$shown/hedges.png" 960x540 --option near_px=2
rows
sheet sheet oak birch spruce coconut
sheet forms oak
if [ -d "$data" ]; then
    for scene in bei quesnel nouragues boreas bigtujunga augusta luxembourg colorado; do
        ! is_wanted "$scene" || render "$scene" "$shown/$scene.png" 960x540 --data "$data"
    done
    models
fi
