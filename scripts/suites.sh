#!/bin/sh
# Runs the suites of weald bench in full and keeps their results in docs/bench, tables in its README.md.
# Stopped, the same command goes on where it was; `rm -rf out/suites` begins anew.
#   scripts/suites.sh BUILD [SUITE...]
set -eu
cd "$(dirname "$0")/.."
build=${1:-build}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- seeds popping scale quality
page=docs/bench/README.md

# table SUITE COLUMN...: a row a method, a column a place; cells hold the columns of results.csv
table() {
    results=docs/bench/$1/results.csv
    shift
    awk -F, -v columns="$*" '
    function short(number) {
        return number == "" ? "-" : sprintf(number >= 100 ? "%.0f" : number >= 10 ? "%.1f" : "%.3g", number)
    }
    /^#/ { next }
    $1 == "scene" { n = split(columns, names, " "); for (i = 1; i <= NF; i++) at[$i] = i; next }
    {
        place = $1 ", " $2
        if (!(place in trees)) { trees[place] = $at["trees"]; places[++p] = place }
        if (!($3 in known)) { known[$3] = 1; methods[++m] = $3 }
        cell = ""
        for (i = 1; i <= n; i++)
            cell = cell (i > 1 ? ", " : "") short($at[names[i]])
        cells[$3, place] = cell
    }
    END {
        line = "| method |"; rule = "|---|"; count = "| trees |"
        for (k = 1; k <= p; k++) {
            line = line " " places[k] " |"; rule = rule "---|"
            count = count " " sprintf("%.0f", trees[places[k]]) " |"
        }
        print line; print rule; print count
        for (j = 1; j <= m; j++) {
            line = "| " methods[j] " |"
            for (k = 1; k <= p; k++)
                line = line " " cells[methods[j], places[k]] " |"
            print line
        }
    }' "$results"
}

# fill NAME: standard input replaces what stands between NAME's two marks on the page
fill() {
    sed -i -e "/<!-- $1 -->/,/<!-- \/$1 -->/{/<!-- $1 -->/{p;r /dev/stdin
        d};/<!-- \/$1 -->/!d}" "$page"
}

trap : INT TERM # weald leaves what it has; then its time is noted, too
for suite; do
    work=out/suites/$suite
    kept=docs/bench/$suite
    mkdir -p "$work" "$kept"
    begin=$(date +%s)
    status=0
    "$build/cli/weald" bench --suite "$suite" --gpu software -o "$work" || status=$?
    echo "$(($(date +%s) - begin))" >>"$work/seconds"
    [ "$status" -eq 0 ] || exit "$status"
    cp "$work/results.csv" "$work/results.json" "$work/report.html" "$kept/"
    case $suite in
    seeds | quality) table "$suite" frame_ms flip block_rmse_pct | fill "$suite" ;;
    scale | density) table "$suite" frame_ms device_mb | fill "$suite" ;;
    popping)
        table popping popping_mean_pct popping_p999_pct popping_step_pct | fill popping
        table popping step_full_reduced_pct step_reduced_billboard_pct step_full_billboard_pct \
            step_billboard_canopy_pct | fill popping-steps
        ;;
    esac
    echo "suite-$suite-s $(awk '{ s += $1 } END { print s }' "$work/seconds") s"
done
