#!/bin/sh
# Many commands in one start: each does what it would do alone.
#   batch.sh PROGRAM ROOT
set -u
. "$(dirname "$0")/lib.sh"
out=$scratch/'out of one start'
alone=$scratch/alone
mkdir "$out" "$alone"

cat >"$scratch/lines" <<EOF
# three pictures, one of them of another method, and a tree

render $tiny -o "$out/south.png" --gpu software
render $tiny -o '$out/own.png' --gpu software --method continuum --camera west # nearer
render $tiny -o "$out/again.png" --gpu software --camera south --seed 7
grow oak --height 5 -o "$out/oak.png" --size 96x96 --samples 1 --gpu software
info $tiny --json
EOF
expect 0 'lines: 5 lines, 0 failed' batch "$scratch/lines"
cp "$scratch/output" "$scratch/all"
for name in south own oak; do
    sed -n "s|\"||g; s|'||g; s|$out|$alone|; s| *#.*||; /$name.png/p" "$scratch/lines" | xargs "$weald" >"$scratch/output" 2>&1
    check "$name.png is as made alone" cmp "$out/$name.png" "$alone/$name.png"
done
check 'the same line, the same picture' cmp "$out/south.png" "$out/again.png"
check 'other lines, other pictures' sh -c "! cmp -s '$out/south.png' '$out/own.png'"
check 'one device for all lines' [ "$(grep -c 'Vulkan device:' "$scratch/all")" -eq 1 ]
sed 's/--seed 7/--threads 1/' "$scratch/lines" >"$scratch/threads"
expect 0 . batch "$scratch/threads"
cp "$scratch/output" "$scratch/all"
check 'another for another number of threads' [ "$(grep -c 'Vulkan device:' "$scratch/all")" -eq 3 ]
check 'lines of standard input' sh -c "echo info '$tiny' --json | '$weald' batch - | grep -q tree_count"

printf 'info %s --json\0 --no-such-option\n' "$tiny" >"$scratch/zero"
expect 2 'zero:1: has a zero byte' batch "$scratch/zero"

# A forest serves the lines that differ in how they draw it: its scene comes out of a pipe, which can be read once.
sed "s,\.\./\.\.,$root,g" "$tiny" >"$scratch/tiny.json"
once=$scratch/once.json
while read -r name more; do
    echo "render $scratch/tiny.json -o $alone/$name.png --size 96x54 --gpu software $more"
done >"$scratch/apart" <<EOF
drawn --method octree --camera west
more --method octree --camera west --samples 3
other --method continuum --camera west
told --camera south --time 2 --view normal
again --method octree --camera west
EOF
sed "s|$scratch/tiny.json|$once|; s|$alone\([^ ]*\)|'$out\1'|" "$scratch/apart" >"$scratch/shared"
mkfifo "$once"
timeout 60 cp "$scratch/tiny.json" "$once" &
expect 0 '5 lines, 0 failed' batch "$scratch/shared"
sed '/again.png/d' "$scratch/apart" | xargs -L 1 "$weald" >"$scratch/output" 2>&1
for name in drawn more other told; do
    check "$name.png of a shared forest is as made alone" cmp "$out/$name.png" "$alone/$name.png"
done
check 'the first again, after the others' cmp "$out/drawn.png" "$out/again.png"

# What a line grows is read anew by those after it.
for age in 5 9; do
    echo "grow oak --age $age -o $scratch/model.obj"
    echo "render $tiny -o $alone/$age.png --size 96x54 --gpu software --set species.oak=$scratch/model.obj"
done >"$scratch/grown"
expect 0 '4 lines, 0 failed' batch "$scratch/grown"
check 'another model, another picture' sh -c "test -s '$alone/9.png' && ! cmp -s '$alone/5.png' '$alone/9.png'"

printf '\357\273\277info %s --json\n' "$tiny" >"$scratch/marked"
expect 0 tree_count batch "$scratch/marked"

# A line that fails is named and stops no other; one that cannot be run stops all.
cat >"$scratch/failing" <<EOF
render $tiny -o "$out/none.png" --gpu software --camera wset
render $tiny -o "$out/after.png" --gpu software
EOF
expect 1 'failing:1: failed: render' batch "$scratch/failing"
check 'what failed left nothing' test ! -e "$out/none.png"
check 'the next line was run' cmp "$out/south.png" "$out/after.png"
wrong() { # wrong PATTERN LINE: told before the first line is run
    printf 'render %s -o "%s"\n%s\n' "$tiny" "$out/never.png" "$2" >"$scratch/wrong"
    expect 2 "$1" batch "$scratch/wrong"
}
wrong 'wrong:2: this line cannot be run' "render $tiny -o a.png --smaples 3"
wrong 'did you mean --samples' "render $tiny -o a.png --smaples 3"
wrong 'wrong:2: a quote is not closed' "render \"$tiny -o a.png"
wrong 'wrong:2: a line begins with render, grow, export, info or check, not with view' "view $tiny"
wrong 'wrong:2: --help has no place' 'render --help'
check 'nothing was begun' test ! -e "$out/never.png"
printf 'render %s --reference --samples 60000 -o %s\nrender %s -o "%s"\n' "$tiny" "$scratch/long.png" "$tiny" \
    "$out/never.png" >"$scratch/long"
"$weald" batch "$scratch/long" >"$scratch/output" 2>&1 &
for _ in $(seq 300); do # until it tells what it does, and so listens
    [ ! -s "$scratch/output" ] || break
    sleep 0.1
done
kill -INT $!
status=0
wait $! || status=$?
cp "$scratch/output" "$scratch/long.log"
check 'Ctrl-C ends the batch' [ "$status" -eq 130 ]
check 'and no later line is begun' test ! -e "$out/never.png"
check 'Ctrl-C is answered' grep -q 'ends after the running step; another Ctrl-C ends it at once' "$scratch/long.log"
check 'the next line is told' grep -q 'long: stopped; 0 of 2 lines done, the next is line 1: with --skip-existing' \
    "$scratch/long.log"
# What is there is left out, but for what can be gone on with.
printf 'render %s -o "%s" --size 32x18 --gpu software\n' "$tiny" "$out/one.png" "$tiny" "$out/two.png" \
    "$tiny" "$out/half.png" >"$scratch/rest"
echo "render $tiny -o '$out/f-%03d.png' --path fly --frames 2 --size 32x18 --gpu software" >>"$scratch/rest"
echo "info $tiny" >>"$scratch/rest"
echo kept | tee "$out/one.png" "$out/two.png" >"$out/half.png"
echo kept >"$out/f-000.png"
expect 0 'rest: 4 lines left out, their output is there' batch "$scratch/rest" --skip-existing
check 'what was there is as it was' grep -q kept "$out/one.png"
rm "$out/two.png"
echo more >"$out/half.png.partial"
expect 0 'rest: 3 lines, 0 failed' batch "$scratch/rest" --skip-existing
check 'numbered pictures are left out as well' grep -q kept "$out/f-000.png"
check 'what was missing was made, and what was half done' sh -c "! grep -q kept '$out/two.png' '$out/half.png'"
check 'and no more' grep -q kept "$out/one.png"
expect 0 'rest: 5 lines, 0 failed' batch "$scratch/rest"
check 'without the option all are run' sh -c "! grep -q kept '$out/one.png'"
expect 2 'no such file' batch "$scratch/missing"
finish
