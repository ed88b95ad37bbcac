#!/bin/sh
# Run every test of one build: check.sh BUILD_FOLDER. Each on its own, under a time limit, one more at
# once than there are cores: some wait for what hangs. Prints what failed, what each
# test counted and took, and, last, "N passed, N failed, N skipped". Test scripts print one line a case:
# "ok NAME", "not ok NAME: why" or "skipped: why".
set -u
build=$1
here=$(cd "$(dirname "$0")" && pwd)
export RELUME="$PWD/$build/relume" VIEWER="$PWD/$build/relume-view" TOP="$PWD" BUILD="$PWD/$build"
export ASAN_OPTIONS="detect_leaks=1:allocator_may_return_null=1"
export LSAN_OPTIONS="suppressions=$here/gl/lsan.supp:print_suppressions=0"
export TSAN_OPTIONS="suppressions=$here/threads/tsan.supp"
# Drawing in software compiles each shader first, which takes longer than small frames: narrow vectors compile faster.
export LP_NATIVE_VECTOR_WIDTH=128
# Shaders that draw a few small frames gain less by LLVM's optimizer than it takes (measured in docs/measurements/building.md).
export GALLIVM_PERF=nopt
logs=$(mktemp -d) || exit 1
trap 'rm -rf "$logs"' EXIT
passed=0 failed=0 skipped=0 total=0

# Starting the tool hundreds of times is slow under sanitizers. They see the scripts with hostile
# input and the window; not what is installed, documented and shown by a browser, nor values that
# the unit tests ask the same code for.
is_run() { # script
    case $build in *asan* | *tsan*) ;; *) return 0 ;; esac
    case $(basename "$1" .sh) in test_bad_* | test_window) return 0 ;; esac
    return 1
}

# Scripts first and short ones last: a core should not wait for the last one alone. One that may not be
# executed fails.
tests() {
    [ "${ONLY_BINARIES:-}" ] || for t in "$here"/cli/test_*.sh; do
        is_run "$t" && echo "$t"
    done
    for t in "$build"/tests/gl/* "$build"/tests/threads/* "$build"/tests/props/* \
        "$build"/tests/kernels/* "$build"/tests/unit/*; do
        [ -x "$t" ] && [ -f "$t" ] && echo "$t"
    done
}

# name of the log of a test: its folder and its own name
log_of() { echo "$logs/$(basename "$(dirname "$1")").$(basename "$1")"; }

count() { grep -cE "$1" "$log" || true; }

report() { # test
    log=$(log_of "$1")
    name=$(basename "$(dirname "$1")")/$(basename "$1")
    status=$(cat "$log.status")
    p=$(count '^(ok |\[       OK \])')
    f=$(count '^(not ok |\[  FAILED  \] [a-zA-Z])')
    s=$(count '^(skipped:|\[  SKIPPED \] [a-zA-Z])')
    [ "$status" -ne 0 ] && [ "$f" -eq 0 ] && f=1
    [ "$f" -ne 0 ] && { echo "---- $name (status $status)"; cat "$log"; }
    grep -E '^skipped:' "$log" | sed "s|^|$name: |"
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    # minutes and seconds of the children, user's and system's, as the shell's `times` prints them
    spent=$(sed -n '2s/[ms]/ /gp' "$log.times" | awk '{ printf "%.1f", 60 * ($1 + $3) + $2 + $4 }')
    total=$(echo "$total $spent" | awk '{ print $1 + $2 }')
    printf '%-28s %3d passed %d failed %d skipped %4d s %6.1f s of processor time\n' "$name" "$p" "$f" "$s" "$(cat "$log.seconds")" "$spent"
}

tests >"$logs/list"
# LeakSanitizer stops all threads to look for leaks, and at times crashes at one that is ending: it says
# that its tracer caught a signal, which tells nothing of the test, and is asked once more.
while read -r t; do printf '%s\n%s\n' "$t" "$(log_of "$t")"; done <"$logs/list" |
    xargs -n 2 -P "$(($(nproc) + 1))" sh -c \
        'a=$(date +%s)
        run() { timeout "${TEST_LIMIT_S:-600}" "$0" >"$1" 2>&1; echo $? >"$1.status"; }
        run "$1"
        grep -q "^Tracer caught signal" "$1" && run "$1"
        echo $(($(date +%s) - a)) >"$1.seconds"
        times >"$1.times"'
while read -r t; do report "$t"; done <"$logs/list"
echo "tests took $total s of processor time"
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
