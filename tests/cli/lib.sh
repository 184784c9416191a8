# shellcheck shell=sh disable=SC2034
# Sourced by the tests of the program: runs it and compares what comes out.
#   $1 the program, $2 the root of the sources
weald=$(realpath "$1")
root=$2
tiny=$root/tests/viewer/tiny.json
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
[ -x "$weald" ] || {
    echo "there is no program $weald"
    exit 1
}
cases=0
failures=0

fail() {
    echo "FAIL $*"
    [ ! -s "$scratch/output" ] || sed 's/^/     | /' "$scratch/output" | head -12
    failures=$((failures + 1))
}

# check WHAT TEST...: one condition
check() {
    cases=$((cases + 1))
    what=$1
    shift
    if "$@" >"$scratch/output" 2>&1; then echo "ok   $what"; else fail "$what"; fi
}

# expect STATUS PATTERN ARGUMENT...: the program with these arguments exits with STATUS and prints a
# line that matches the extended regular expression
expect() {
    cases=$((cases + 1))
    expected=$1
    pattern=$2
    shift 2
    status=0
    timeout 120 "$weald" "$@" >"$scratch/output" 2>&1 </dev/null || status=$?
    if [ "$status" -ne "$expected" ]; then
        fail "weald $*: exit status $status instead of $expected"
    elif ! grep -qE -- "$pattern" "$scratch/output"; then
        fail "weald $*: no line matches $pattern"
    else
        echo "ok   weald $*"
    fi
}

# draw PATTERN ARGUMENT...: as expect 0, but with all others of its kind in one start, at drawn; PATTERN names the file
draw() {
    printf '%s\n' "$1" >>"$scratch/patterns"
    shift
    printf '%s\n' "$*" >>"$scratch/lines"
}

drawn() {
    expect 0 'lines, 0 failed' batch "$scratch/lines"
    cp "$scratch/output" "$scratch/told"
    while read -r pattern; do
        check "told: $pattern" grep -qE -- "$pattern" "$scratch/told"
    done <"$scratch/patterns"
    rm "$scratch/patterns" "$scratch/lines"
}

finish() {
    echo "$cases checks, $failures failed"
    [ "$failures" -eq 0 ] && [ "$cases" -gt 0 ]
}
