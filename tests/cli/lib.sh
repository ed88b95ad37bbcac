# lib.sh - sourced by the test scripts: cases, captures, and what a good refusal looks like.
# $RELUME, $VIEWER, $TOP and $BUILD come from tests/check.sh. Each script runs in a folder of its own.
set -u
sphere="$BUILD/samples/sphere" mkimage="$BUILD/tests/tools/mkimage"
work=$(mktemp -d) || exit 1
trap 'cd /; rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
python=$(command -v python3 || true)
case $BUILD in */build) config=release ;; *) config=$(basename "$BUILD") ;; esac

ok() { echo "ok $1"; }
not_ok() { # name, why
    echo "not ok $1: $2"
    failures=$((failures + 1))
}
skip() { echo "skipped: $1: $2"; }
check() { # name, command: ok when the command succeeds
    name=$1
    shift
    if why=$("$@" 2>&1); then ok "$name"; else not_ok "$name" "'$*' failed; $why"; fi
}
finish() { [ "$failures" -eq 0 ]; }

# Unfinished outputs that nobody wants to find (src/core/base/beside.h).
leftovers() { find . -name '.relume-*'; }

# lines of `$1` that are neither warnings nor remarks on success. Sanitized builds leave standard error
# to relume-helper for their reports, and libpng inside OpenImageIO prints there.
case $BUILD in *asan* | *tsan*) aside='^relume: warning: |^libpng error: ' ;; *) aside='^relume: warning: ' ;; esac
errors_of() { grep -vE "$aside" "$1"; }

# expect_fail NAME STATUS PATTERN OUTPUT COMMAND...: the command must end with STATUS, say one
# error line "relume: ..." that matches PATTERN (grep -E), print nothing on stdout, and leave
# neither OUTPUT ("-": there is none) nor a temporary file behind.
expect_fail() {
    name=$1 want=$2 pattern=$3 output=$4
    shift 4
    timeout 60 "$@" >out.txt 2>err.txt
    status=$?
    errors_of err.txt >only.txt
    if [ "$status" -ne "$want" ]; then
        [ "$output" = - ] || rm -rf "$output"
        not_ok "$name" "status $status, expected $want; $(head -c 600 err.txt)"
    elif [ "$(wc -l <only.txt)" -ne 1 ] || ! grep -q '^relume: ' only.txt; then
        not_ok "$name" "expected one line 'relume: ...', found: $(head -c 600 err.txt)"
    elif ! grep -qE -e "$pattern" only.txt; then
        not_ok "$name" "expected /$pattern/, found: $(cat only.txt)"
    elif [ -s out.txt ]; then
        not_ok "$name" "stdout holds: $(head -c 200 out.txt)"
    elif [ "$output" != - ] && [ -e "$output" ]; then
        not_ok "$name" "$output exists"
        rm -rf "$output"
    elif [ "$(leftovers)" ]; then
        not_ok "$name" "left behind: $(leftovers)"
        rm -rf $(leftovers)
    else
        ok "$name"
    fi
}

# refuse NAME STATUS PATTERN COMMAND...: the viewer must end so, and say one line "relume-view: ..." that
# matches PATTERN.
refuse() { # name, status, pattern, command...
    name=$1 want=$2 pattern=$3
    shift 3
    timeout 60 "$@" >out.txt 2>err.txt
    status=$?
    if [ "$status" -ne "$want" ]; then
        not_ok "$name" "status $status, expected $want; $(cat err.txt)"
    elif [ "$(wc -l <err.txt)" -ne 1 ] || ! grep -qE "^relume-view: .*$pattern" err.txt; then
        not_ok "$name" "expected one line with /$pattern/, found: $(cat err.txt)"
    else
        ok "$name"
    fi
}

# expect_ok NAME PATTERN COMMAND...: status 0; PATTERN matches a line of stderr ("-": stderr has
# no warning).
expect_ok() {
    name=$1 pattern=$2
    shift 2
    timeout 60 "$@" >out.txt 2>err.txt
    status=$?
    if [ "$status" -ne 0 ]; then
        not_ok "$name" "status $status; $(head -c 600 err.txt)"
    elif [ "$pattern" = - ] && grep -q '^relume: warning' err.txt; then
        not_ok "$name" "unexpected: $(cat err.txt)"
    elif [ "$pattern" != - ] && ! grep -qE -e "$pattern" err.txt; then
        not_ok "$name" "expected /$pattern/, found: $(cat err.txt)"
    elif [ "$(leftovers)" ]; then
        not_ok "$name" "left behind: $(leftovers)"
        rm -rf $(leftovers)
    else
        ok "$name"
    fi
}

# A command that has to go well; what it says is left in err.txt.
relume() { "$RELUME" "$@" -q 2>err.txt || { not_ok "relume $1" "$(cat err.txt)"; return 1; }; }
psnr() { "$RELUME" compare "$1" "$2" | awk '$1 == "psnr_db" { print $2 }'; } # of two pictures
not_encoded() { # name, pattern, capture, options...: status 1
    name=$1 pattern=$2 capture=$3
    shift 3
    expect_fail "$name" 1 "$pattern" out.exr "$RELUME" encode "$capture" -o out.exr "$@"
}
encoded() { # name, pattern of stderr or -, capture, options...: into NAME.exr
    name=$1 pattern=$2 capture=$3
    shift 3
    expect_ok "$name" "$pattern" "$RELUME" encode "$capture" -o "$name.exr" "$@"
}
same() { # name, file, file: equal bytes
    if cmp -s "$2" "$3"; then ok "$1"; else not_ok "$1" "$2 and $3 differ"; fi
}
differ() { # name, file, file
    if cmp -s "$2" "$3"; then not_ok "$1" "$2 and $3 are equal"; else ok "$1"; fi
}
below() { # name, number, bound
    if awk -v a="$2" -v b="$3" 'BEGIN { exit !(a != "" && a + 0 == a && a <= b) }'; then
        ok "$1"
    else
        not_ok "$1" "found '$2', expected at most $3"
    fi
}
above() { # name, number, bound
    if awk -v a="$2" -v b="$3" 'BEGIN { exit !(a != "" && a + 0 == a && a >= b) }'; then
        ok "$1"
    else
        not_ok "$1" "found '$2', expected at least $3"
    fi
}
# field NAME FILE: a number at the top of a JSON object
field() { sed -n "s/.*\"$1\": \{0,1\}\([-0-9.e+]*\).*/\1/p" "$2" | head -n 1; }
eval_field() { # file capture field
    "$RELUME" eval "$1" "$2" --json 2>err.txt >eval.json
    field "$3" eval.json
}
fresh() { # folder made new as a copy of another
    rm -rf "$2"
    cp -r "$1" "$2"
}
