#!/bin/sh
# What a mask leaves out is black: in every picture and pass, in the preview, for the viewer and for the second reader
# (tests/tools/decode.c), however the file was encoded. The mean of pca used to shine through, and
# codebooks have no vector of 0.
. "$(dirname "$0")/lib.sh"
decode="$BUILD/tests/tools/decode"
size=32
"$sphere" linear --size $size --lights 12 --hemisphere --mask
"$sphere" photos --size $size --lights 12 --hemisphere --mask --format png
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n' >sky.hdr
for _ in 1 2 3 4 5 6 7 8; do printf '\200\200\200\200'; done >>sky.hdr  # 0.5 everywhere

# The first pixel, which the mask leaves out, of a picture; up to 2e-7: codes of 0 and their offset round.
nothing() {
    "$mkimage" read "$1" 0 0 |
        awk '{ for (i = 1; i <= 3; i++) bad = bad || $i > 2e-7 || $i < -2e-7 } END { exit bad || NF != 3 }'
}
black() { # name, options of relight
    name=$1
    shift
    if "$RELUME" relight m.exr -o black.exr -q "$@" 2>err.txt && nothing black.exr; then
        ok "$name"
    else
        not_ok "$name" "$("$mkimage" read black.exr 0 0) $(cat err.txt)"
    fi
}

cmp_pixels() { "$mkimage" maxdiff "$1" "$2" | awk '$1 > 0 { bad = 1 } END { exit bad }'; }
has_alpha() { exrheader "$1" | grep -q '^ *A, '; }
lacks_alpha() { ! has_alpha "$1"; }

for capture in linear photos; do
    for how in "" "--basis pca --coefficients 36" "--basis pca --bits half" "--basis pca --bits 16" \
        "--basis sh" "--codebook 16" "--basis sh --codebook 16" "--codebook 16 --stages 2"; do
        "$RELUME" encode $capture -o m.exr $how -q
        black "$capture $how: a light" --light "dir 0.3 0.2 1"
        black "$capture $how: two lights" --light "dir 1 0 1" --light "dir 0 -1 1 rgb 5 5 5"
        found=$("$decode" m.exr 0 0 0 0.3 0.2 1 2>&1)
        inside=$("$decode" m.exr 0 16 16 0.3 0.2 1 2>&1)
        if [ "$found" = "0 0 0" ] && [ "$inside" != "0 0 0" ]; then
            ok "$capture $how: the second reader"
        else
            not_ok "$capture $how: the second reader" "outside $found, inside $inside"
        fi
    done
    "$RELUME" encode $capture -o m.exr -q
    black "$capture: environment" --light "env sky.hdr"
    for pass in normals unsharp luminance diffuse-gain specular false-colour; do
        black "$capture: $pass" --pass $pass
    done
    black "$capture: difference" --pass difference --capture $capture
    "$VIEWER" m.exr --offscreen v.png --pass false-colour >/dev/null 2>err.txt
    check "$capture: false colour in the viewer" nothing v.png
    "$VIEWER" m.exr --offscreen v.png --pass difference --capture $capture >/dev/null 2>err.txt
    check "$capture: difference in the viewer" nothing v.png
    check "$capture: info tells the coefficients that are stored" \
        grep -q '"coefficients": 27, "planes": 27' <<INFO
$("$RELUME" info m.exr --json)
INFO
    "$RELUME" relight m.exr -o n.png --pass normals -q
    "$RELUME" relight m.exr -o l.png -q
    check "$capture: normals are black where there are none" nothing n.png
    check "$capture: pictures too" nothing l.png
    "$VIEWER" m.exr --offscreen v.png >/dev/null 2>err.txt
    check "$capture: the viewer" nothing v.png
done

# Alpha is the mask, on request: pictures stay what programs without alpha expect.
for kind in exr png; do
    "$RELUME" relight m.exr -o "a.$kind" --alpha -q
    "$RELUME" relight m.exr -o "b.$kind" -q
    check "the same colours with alpha, $kind" cmp_pixels "a.$kind" "b.$kind"
done
check 'PNG of four channels' [ "$(od -An -tu1 -j25 -N1 a.png | tr -d ' ')" = 6 ]
if command -v exrheader >/dev/null; then
    check 'EXR with alpha' has_alpha a.exr
    check 'and without' lacks_alpha b.exr
fi
expect_fail 'alpha of JPEG' 2 'alpha' no.jpg "$RELUME" relight m.exr -o no.jpg --alpha
expect_fail 'alpha of another size' 2 'alpha' no.png "$RELUME" relight m.exr -o no.png --alpha --size 16x16
finish
