#!/bin/sh
# The suite popping of weald bench tells what changes at once from what fades, and at which boundary.
#   popping.sh PROGRAM ROOT
set -eu
. "$(dirname "$0")/lib.sh"

# pops NAME SCENE TRUTHS OPTION...: results in $dir/results.json; runs with equal TRUTHS share the
# path-traced frames, as they show the same trees
pops() {
    dir=$scratch/$1
    scene=$2
    truths=$scratch/truths-$3
    shift 3
    mkdir "$dir"
    [ ! -e "$truths" ] || mv "$truths" "$dir/reference"
    expect 0 'report.html' bench "$scene" --suite popping --quick --gpu software -o "$dir" "$@"
    mv "$dir/reference" "$truths"
}

# One oak that a boundary passes over while the eye comes nearer: the step is told for that boundary and no
# other, and is larger where levels change at once.
oak=$root/tests/forest/one.json
grove=$root/tests/cli/grove.json
steps() {
    name=$1
    shift
    pops "$name" "$oak" oak --set cameras.0.fov_deg=30 "$@"
    found=$(jq -c '.rows[0] | [.step_full_reduced_pct, .step_reduced_billboard_pct,
        .step_full_billboard_pct, .step_billboard_canopy_pct]' "$dir/results.json")
    over_all=$(jq '.rows[0].popping_p999_pct' "$dir/results.json")
}

hard() {
    hard=$found
    hard_over_all=$over_all
}

# boundary WHAT INDEX RATIO OVER_ALL: at once there is a step at INDEX, alone, RATIO times the one found now that levels
# are blended, and over all OVER_ALL times as much changes
boundary() {
    check "$1: only there: $hard" jq -ne "[$hard | to_entries[] | select(.value != null) | .key] == [$2]"
    check "$1: a step of $hard at once, $found blended" jq -ne "${hard}[$2] > 0.5 and ${hard}[$2] > $3 * ${found}[$2]"
    check "$1: over all $hard_over_all at once, $over_all blended" \
        jq -ne "$hard_over_all > $4 * $over_all and $over_all > 0"
}

steps lod-full --methods lod --set methods.lod.full_m=50 --set methods.lod.reduced_m=100 \
    --set methods.lod.faithful=true
check "lod, full to reduced: only there: $found" \
    jq -ne "[$found | to_entries[] | select(.value != null) | .key] == [0]"

near='--methods lod --set methods.lod.full_m=5 --set methods.lod.reduced_m=50'
# shellcheck disable=SC2086
steps lod-hard $near --set methods.lod.faithful=true
hard
traced=$(ls "$truths" | wc -l)
# shellcheck disable=SC2086
steps lod-soft $near
check 'settings of methods ask for no truth of their own' [ "$(ls "$truths" | wc -l)" -eq "$traced" ]
# 5.6 and 5.4 over all, where billboards alone make 5.35; 7.4 and 5.5 while meshes and billboards were lit less alike
boundary 'lod, reduced to billboard' 1 2 1.02

steps patch-hard --methods patch --set methods.patch.near_begin_m=49.9 \
    --set methods.patch.near_end_m=50 --set quality.mesh_distance_m=5
hard
steps patch-soft --methods patch --set methods.patch.near_begin_m=44 \
    --set methods.patch.near_end_m=50 --set quality.mesh_distance_m=5
boundary 'patch, reduced to billboard' 1 4 2.5

full='--methods dissolve --set methods.dissolve.billboard_m=49.4 --set methods.dissolve.branches_m=200
    --set methods.dissolve.leaves_begin_m=200 --set methods.dissolve.leaves_end_m=300'
# shellcheck disable=SC2086
steps dissolve-hard $full --set methods.dissolve.overlap_m=0.01
hard
# shellcheck disable=SC2086
steps dissolve-soft $full --set methods.dissolve.overlap_m=8
boundary 'dissolve, full to billboard' 2 1.3 1.05

# trees that give way to the canopy's map, and trees that do not
canopy() {
    pops "canopy-$1" "$grove" canopy --methods zfield --set methods.zfield.near_m=0 \
        --set layers.0.spacing_m=3 --set methods.zfield.rows=4 --set methods.zfield.size=32 --set methods.zfield.fade=0 \
        --set "methods.zfield.range_m=$1"
    found=$(jq -c '[.rows[] | .step_billboard_canopy_pct]' "$dir/results.json")
}
canopy 35
check "canopy: steps of $found" jq -ne "[${found}[] | numbers] | length > 0"
canopy 0
check "canopy: none without a boundary: $found" jq -ne "[${found}[] | numbers] | length == 0"
finish
