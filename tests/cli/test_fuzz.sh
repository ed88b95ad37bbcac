#!/bin/sh
# The seeds of every fuzz target, and the inputs that once failed (tests/fuzz/corpus), end well.
. "$(dirname "$0")/lib.sh"
unset MAKEFLAGS
make -s -C "$TOP" config=$config fuzzers >make.txt 2>&1 || not_ok "make fuzzers" "$(tail -n 5 make.txt)"
for source in "$TOP"/tests/fuzz/fuzz_*.c; do
    name=$(basename "$source" .c)
    find "$TOP/tests/fuzz/corpus/$name" -type f 2>/dev/null | LC_ALL=C sort >files.txt
    # names have no blanks
    if "$BUILD/tests/fuzz/$name" seeds $(cat files.txt) >out.txt 2>&1; then
        ok "$name: $(tail -n 1 out.txt)"
    else
        not_ok "$name" "$(tail -n 5 out.txt)"
    fi
done
for folder in "$TOP"/tests/fuzz/corpus/*; do
    name=$(basename "$folder")
    check "corpus/$name is a target's" test -f "$TOP/tests/fuzz/$name.c"
done
finish
