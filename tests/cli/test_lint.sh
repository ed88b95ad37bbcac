#!/bin/sh
# cppcheck finds nothing in the library, the tool and the viewer, and would find a plain mistake.
. "$(dirname "$0")/lib.sh"
unset MAKEFLAGS

if command -v cppcheck >/dev/null; then
    check "make lint" make -s -C "$TOP" lint
    echo 'int last(void) { int two[2] = {1, 2}; return two[2]; }' >planted.c
    if make -s -C "$TOP" lint B="$PWD" LINTED="$PWD/planted.c" >lint.txt 2>&1; then
        not_ok "a read past the end is found" "status 0"
    else
        check "a read past the end is found" grep -q "planted.c:1:.*out of bounds" lint.txt
    fi
else
    skip "make lint" "no cppcheck"
fi
finish
