#!/bin/sh
# weald bench: a small suite, its files, going on after an interruption, bad input.
#   bench.sh PROGRAM ROOT
set -eu
. "$(dirname "$0")/lib.sh"
out=$scratch/bench
grove=$root/tests/cli/grove.json

expect 2 'no directory named' bench --suite quality
expect 2 'no suite named' bench -o "$out"
expect 2 'no suite "qualty", did you mean quality' bench --suite qualty -o "$out"
expect 2 'no method "octre", did you mean octree' bench --suite quality --methods octre -o "$out"
expect 2 'no metric "flop", did you mean flip' bench --suite quality --metric flop -o "$out"
expect 1 'No such file' bench --suite quality -o "$scratch/none/bench"
expect 1 'No such file|cannot' bench "$scratch/none.json" --suite quality --quick -o "$out"
expect 2 'would both be "grove" in the results' bench "$grove" "$scratch/grove.json" --suite quality -o "$out"
rm -rf "$out"

run() {
    expect 0 "$1" bench "$grove" --suite quality --quick --methods octree,separate --gpu software \
        -o "$out"
}
run 'results.csv, results.json, report.html'
check 'a row a method' [ "$(grep -c '^grove,' "$out/results.csv")" -ge 2 ]
check 'errors in the rows' jq -e \
    '[.rows[] | select(.flip > 0 and .flip < 1 and .ssim > 0 and .frame_ms > 0)] | length >= 2' \
    "$out/results.json"
check 'frames counted, the noise of the reference told' jq -e \
    '[.rows[] | select(.frames >= 1 and .noise_flip > 0 and .noise_block_rmse_pct > 0)] | length >= 2' \
    "$out/results.json"
check 'the machine in the report' grep -q 'llvmpipe' "$out/report.html"

# beside an earlier run, which this one was half as fast as
mkdir "$scratch/earlier"
awk -F, -v OFS=, 'NR == 1 { $0 = $0 " fog.visibility_m=500" } NR == 2 { for (i = 1; i <= NF; i++) at[$i] = i }
    NR > 2 { $at["frame_ms"] /= 2; $at["flip"] -= 0.01 } $3 != "separate"' "$out/results.csv" >"$scratch/earlier/results.csv"
run_against() { # DIR STATUS PATTERN
    expect "$2" "$3" bench "$grove" --suite quality --quick --methods octree,separate --gpu software -o "$out" --against "$1"
}
run_against "$scratch/earlier" 0 'was measured otherwise: weald bench quality .*fog.visibility_m=500'
cp "$scratch/output" "$scratch/told"
check 'times and errors are beside each other' grep -qE 'octree .* 2\.00 .* \+0\.0100$' "$scratch/told"
check 'and what both have is counted' grep -qE '^1 of 2 rows are in both' "$scratch/told"
sed 's/^grove,/grove,no number,/' "$out/results.csv" >"$scratch/earlier/results.csv"
run_against "$scratch/earlier" 1 'earlier/results.csv:3: is no row of results'
run_against "$scratch/none" 1 'none/results.csv: cannot be read: .*; --against names the directory'

# what is best by a metric of which more is better, or of which 0 is
# shaded METRIC OCTREE SEPARATE: $scratch/shaded has the methods that the report shades by these values, octree's time
# being twice that of separate
shaded() {
    awk -F, -v OFS=, -v column="$1" 'NR == 2 { for (i = 1; i <= NF; i++) at[$i] = i }
        NR > 2 { slow = $3 == "octree"; $at["frame_ms"] = slow ? 20 : 10; $at[column] = slow ? '"$2"' : '"$3"' } 1' \
        "$scratch/rows.csv" >"$out/results.csv"
    expect 0 'report.html' bench "$grove" --suite quality --quick --methods octree,separate --gpu software \
        --metric "$1" -o "$out"
    sed 's/<tr>/\n/g' "$out/report.html" | sed -n 's/.*<td class="m[0-9]">\([a-z]*\)<.*class="best".*/\1/p' | tr '\n' ' ' \
        >"$scratch/shaded"
}
cp "$out/results.csv" "$scratch/rows.csv"
shaded ssim 0.9 0.8
check 'more of SSIM is better' grep -qx 'octree separate ' "$scratch/shaded"
check 'and so it is told' grep -q 'both faster and higher in SSIM' "$out/report.html"
shaded ssim 0.7 0.8
check 'less of it is worse' grep -qx 'separate ' "$scratch/shaded"
shaded radiance_bias_pct 1 -5
check 'a bias is better the nearer it is to 0' grep -qx 'octree separate ' "$scratch/shaded"
shaded flip 0.2 0.1
check 'less of FLIP is better' grep -qx 'separate ' "$scratch/shaded"
cp "$scratch/rows.csv" "$out/results.csv"

# an interruption in the middle of a line: what is whole stays, the rest is measured again
rows=$(grep -c '^grove,' "$out/results.csv")
head -n 3 "$out/results.csv" >"$scratch/cut"
printf 'grove,cut off' >>"$scratch/cut"
cp "$scratch/cut" "$out/results.csv"
run '1 results are there already'
check 'all rows again' [ "$(grep -c '^grove,' "$out/results.csv")" -eq "$rows" ]
expect 1 'another suite' bench "$grove" --suite scale --quick -o "$out"

# one process at a time
exec 9<"$out"
flock 9
expect 1 'another process is at work' bench "$grove" --suite quality --quick --gpu software -o "$out"
exec 9<&-

# a report that cannot be written
mv "$out/report.html" "$scratch/report.html"
mkdir "$out/report.html"
expect 1 'report.html cannot be written' bench "$grove" --suite quality --quick \
    --methods octree,separate --gpu software -o "$out"
rmdir "$out/report.html"
mv "$scratch/report.html" "$out/report.html"
cp "$out/results.csv" "$scratch/results.csv"
rm "$out/results.csv"
mkdir "$out/results.csv"
expect 1 'results.csv' bench "$grove" --suite quality --quick --gpu software -o "$out"
rmdir "$out/results.csv"
mv "$scratch/results.csv" "$out/results.csv"

# a reference picture of another size is refused
set -- "$out"/reference/*.exr
if [ "$weald" ]; then
    "$weald" render "$grove" -o "$scratch/other.exr" --size 40x30 --gpu software -q
    cp "$scratch/other.exr" "$1"
    head -n 2 "$out/results.csv" >"$scratch/heads"
    cp "$scratch/heads" "$out/results.csv"
    expect 1 'reference/grove-.* 40 x 30 pixels, not 128 x 96' bench "$grove" --suite quality --quick --methods octree --gpu software -o "$out"
fi

# times alone: no metric; what is set and how large frames are is told, names are no markup, earlier methods stay
named=$scratch/named.json
sed -e 's|"south"|"<u>road"|' -e "s|\.\./\.\./species|$root/species|g" "$grove" >"$named"
expect 2 'which the suite density does not measure' bench "$named" --suite density --metric ssim -o "$scratch/named"
timed() { # timed STATUS PATTERN METHOD
    expect "$1" "$2" bench "$named" --suite density --quick --size 64x48 --methods "$3" --gpu software \
        --set wind.speed_mps=0 -o "$scratch/named"
}
timed 0 '^method +median ms +p95 ms +GPU ms +CPU ms +draws +triangles +device MB$' octree
cp "$scratch/named/machine.txt" "$scratch/machine.txt"
sed -i 's/^device: .*/device: another/' "$scratch/named/machine.txt"
timed 1 'holds results of the device: another, not of llvmpipe' separate
cp "$scratch/machine.txt" "$scratch/named/machine.txt"
timed 0 report.html separate
check 'JSON tells what was set and the size' jq -e \
    '.settings == ["wind.speed_mps=0"] and (.rows | length == 2) and all(.rows[]; .frame_px == [64, 48])' \
    "$scratch/named/results.json"
check 'the report tells it' grep -q 'of 64 x 48 pixels, one sample a pixel. Of every scene is set: wind.speed_mps=0' \
    "$scratch/named/report.html"
check 'names are no markup' sh -c "! grep -q '<u>' '$scratch/named/report.html'"
check 'both methods at a glance' [ "$(sed -n '/At a glance/,/<.table>/p' "$scratch/named/report.html" | grep -cE '>(octree|separate)<')" -eq 2 ]

# a camera's name that would part columns and folders; a scene that has changed since
far=$scratch/far.json
sed -e 's|"south"|"9 km, north/west"|' -e "s|\.\./\.\./species|$root/species|g" "$grove" >"$far"
expect 0 'results.csv' bench "$far" --suite quality --quick --methods octree --gpu software \
    -o "$scratch/far"
check 'one name, one column' grep -q '^far,9 km  north west,octree,' "$scratch/far/results.csv"
check 'and one file' [ -s "$scratch/far/pictures/far-9 km  north west-reference.png" ]
expect 0 '1 results are there already' bench "$far" --suite quality --quick --methods octree \
    --gpu software -o "$scratch/far"
sed -i 's|\[20, -25, 12\]|[20, -20, 12]|' "$far"
cp "$scratch/far/results.csv" "$scratch/before.csv"
expect 1 'holds results of far by other' bench "$far" --suite quality --quick --methods octree \
    --gpu software -o "$scratch/far"
check 'which stay' cmp "$scratch/before.csv" "$scratch/far/results.csv"
rm "$scratch/far/results.csv"
expect 0 'results.csv' bench "$far" --suite quality --quick --methods octree --gpu software \
    -o "$scratch/far"
check 'a moved camera has a truth of its own' [ "$(ls "$scratch/far/reference" | wc -l)" -eq 4 ]
check 'nothing half written' [ -z "$(find "$scratch/far" -name '.*.tmp')" ]

if command -v chromium >/dev/null; then
    timeout 60 chromium --headless --no-sandbox --disable-gpu --dump-dom \
        "file://$out/report.html" 2>/dev/null >"$scratch/dom" || true
    dots=$(grep -c 'class="method m' "$scratch/dom" || true)
    check "a dot a method in Chromium ($dots)" [ "$dots" -ge 2 ]
    check 'strips of pictures and error maps' \
        [ "$(grep -o '<img alt="[a-z-]*" src="data:image/jpeg' "$scratch/dom" | wc -l)" -ge 5 ]
    check 'bars of the passes' grep -q 'class="bar"' "$scratch/dom"
    grep -oE '(src|href)="[^"]{0,20}' "$scratch/dom" | grep -v 'src="data:' >"$scratch/links" || true
    check 'nothing from elsewhere' [ ! -s "$scratch/links" ]
    timeout 60 chromium --headless --no-sandbox --disable-gpu --window-size=800,600 \
        "--screenshot=$scratch/report.png" "file://$out/report.html" >"$scratch/output" 2>&1 || true
    check 'the report can be seen' [ -s "$scratch/report.png" ]
else
    echo "skip: no chromium, the report was not opened"
fi
finish
