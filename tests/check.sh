#!/bin/sh
# Run every test of one build: check.sh BUILD_FOLDER. Each on its own, under a time limit. Prints
# what failed and, last, "N passed, N failed, N skipped". Test scripts print one line a case:
# "ok NAME", "not ok NAME: why" or "skipped: why".
set -u
build=$1
here=$(cd "$(dirname "$0")" && pwd)
export RELUME="$PWD/$build/relume" VIEWER="$PWD/$build/relume-view" TOP="$PWD" BUILD="$PWD/$build"
export ASAN_OPTIONS="detect_leaks=1:allocator_may_return_null=1"
export LSAN_OPTIONS="suppressions=$here/gl/lsan.supp:print_suppressions=0"
export TSAN_OPTIONS="suppressions=$here/threads/tsan.supp"
log=$(mktemp) || exit 1
trap 'rm -f "$log"' EXIT
passed=0 failed=0 skipped=0

count() { grep -cE "$1" "$log" || true; }

run() { # name, command
    timeout "${TEST_LIMIT_S:-300}" "$2" >"$log" 2>&1
    status=$?
    p=$(count '^(ok |\[       OK \])')
    f=$(count '^(not ok |\[  FAILED  \] [a-zA-Z])')
    s=$(count '^(skipped:|\[  SKIPPED \] [a-zA-Z])')
    [ "$status" -ne 0 ] && [ "$f" -eq 0 ] && f=1
    [ "$f" -ne 0 ] && { echo "---- $1 (status $status)"; cat "$log"; }
    grep -E '^skipped:' "$log" | sed "s|^|$1: |"
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    printf '%-28s %3d passed %d failed %d skipped\n' "$1" "$p" "$f" "$s"
}

for t in "$build"/tests/unit/* "$build"/tests/props/* "$build"/tests/kernels/* \
    "$build"/tests/threads/* "$build"/tests/gl/*; do
    [ -x "$t" ] && [ -f "$t" ] && run "${t#"$build"/tests/}" "$t"
done
[ "${ONLY_BINARIES:-}" ] || for t in "$here"/cli/*.sh; do
    [ -x "$t" ] && run "cli/$(basename "$t")" "$t"
done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
