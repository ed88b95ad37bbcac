#!/bin/sh
# cppcheck finds nothing in the library, the tool and the viewer, and would find a plain mistake. Findings in
# the language of the tree stay below their ceilings.
. "$(dirname "$0")/lib.sh"
unset MAKEFLAGS

if command -v cppcheck >/dev/null; then
    check "make lint-code" make -s -C "$TOP" lint-code
    echo 'int last(void) { int two[2] = {1, 2}; return two[2]; }' >planted.c
    if make -s -C "$TOP" lint-code B="$PWD" LINTED="$PWD/planted.c" >lint.txt 2>&1; then
        not_ok "a read past the end is found" "status 0"
    else
        check "a read past the end is found" grep -q "planted.c:1:.*out of bounds" lint.txt
    fi
else
    skip "make lint-code" "no cppcheck"
fi

if [ "$python" ]; then
    check "make lint-words" make -s -C "$TOP" lint-words
    mkdir -p tree/src && echo '// What nobody wants.' >tree/src/planted.c
    "$python" "$TOP/scripts/words.py" --summary tree >ceiling
    check "as many findings as the ceiling allows" "$python" "$TOP/scripts/words.py" --ceiling ceiling tree
    echo 'int a;  // Of nobody either.' >>tree/src/planted.c
    if "$python" "$TOP/scripts/words.py" --ceiling ceiling tree >words.txt; then
        not_ok "one finding more is refused" "status 0"
    else
        check "one finding more is refused" grep -q "comment-opening: 2 findings, at most 1 " words.txt
    fi
else
    skip "make lint-words" "no python3"
fi
finish
