#!/bin/sh
# The reference of the library: every public declaration has a comment that Doxygen finds, and one
# without would be noticed.
. "$(dirname "$0")/lib.sh"
if ! command -v doxygen >/dev/null 2>&1; then
    skip 'the reference of the library' 'no doxygen; make deps-docs installs it'
    finish
    exit
fi
mkdir -p tree/include && cp -r "$TOP/scripts" tree/ && cp -r "$TOP/include/relume" tree/include/
refer() { # the reference of the copied headers
    (cd tree && mkdir -p docs && doxygen scripts/Doxyfile) >said.txt 2>&1
}
if refer; then ok 'every public declaration is documented'; else
    not_ok 'every public declaration is documented' "$(grep warning said.txt | sed 's|.*/include/||' | head -n 5)"
fi
check 'pages are made' test -s tree/docs/api/index.html
# a comment at the end of a line belongs to what is on it, also to each of several names
page=$(ls tree/docs/api/structrelume__ball__camera.html tree/build/docs/api/*relume__ball__camera*.html 2>/dev/null | head -n 1)
check 'a comment at the end of a line is found' grep -q 'focal length in pixels' "$page"
check 'one for two names is found twice' test "$(grep -c 'of the photographs' "$page")" -ge 2

# plant NAME LINE: with LINE at the end of a header, it is named
plant() {
    cp tree/include/relume/relight/tone.h before.h
    sed -i "s|^#ifdef __cplusplus\$|&|; \$i $2" tree/include/relume/relight/tone.h
    if refer; then not_ok "$1 is noticed" "doxygen is content with: $2"; else
        check "$1 is noticed" grep -q 'tone.h.*not documented' said.txt
    fi
    cp before.h tree/include/relume/relight/tone.h
}
plant 'a function without a comment' 'RELUME_API int relume_planted(int n);'
plant 'a member without a comment' 'struct relume_planted { int secret; };'
finish
