#!/bin/sh
# A second reader, written from docs/format.md alone (tests/tools/decode.c), sees in a relume file
# what the library sees: every basis, storage and domain, from the front, from the side, below the
# horizon.
. "$(dirname "$0")/lib.sh"
decode="$BUILD/tests/tools/decode"
size=24

# Weights are single precision in the library and double here; the table's codes span [0, 1], the
# coefficients of sh a few units: 2e-6 is 2^-19.
tolerance=2e-6
near() { # numbers, numbers
    awk -v a="$1" -v b="$2" -v tolerance=$tolerance 'BEGIN {
        n = split(a, x, " "); m = split(b, y, " ")
        for (i = 1; i <= n; i++) {
            d = x[i] - y[i]; size = y[i] < 0 ? -y[i] : y[i]
            if (d < 0) d = -d
            if (!(d <= tolerance * (1 + size))) bad = 1
        }
        exit !(n == 3 && m == 3 && !bad) }'
}

agree() { # name, file, view, query's eye and direction, x, y
    for light in "1 0.5 1" "-0.3 -0.2 0.1" "0.2 1 0.05" "1 0 -0.3"; do
        ours=$("$decode" "$2" "$3" $5 $6 $light 2>&1)
        theirs=$("$RELUME" query "$2" $4 --light "dir $light" -q 2>/dev/null)
        if ! near "$ours" "$theirs"; then
            not_ok "$1" "dir $light: decoded '$ours', the library says '$theirs'"
            return
        fi
    done
    ok "$1"
}

# The ray of a planar file's pixel: the window is [-1, 1] for square images.
planar() { awk -v x="$1" -v y="$2" -v n=$size 'BEGIN {
    printf "--eye %.9f,%.9f,4 --direction 0,0,-1", -1 + 2 * (x + .5) / n, 1 - 2 * (y + .5) / n }'; }

"$sphere" dome --size $size --lights 30 --hemisphere
"$sphere" all --size $size --lights 40 --intensities --mask
"$sphere" photos --size $size --lights 30 --hemisphere --format png
both() { # encode's words; x y
    if "$RELUME" encode $1 -o one.exr -q 2>err.txt; then
        agree "$1" one.exr 0 "$(planar $2)" $2
    else
        not_ok "$1" "$(cat err.txt)"
    fi
}
both "dome --basis sh --coefficients 9" "9 8"
both "dome --basis sh --coefficients 16 --bits 16" "9 8"
both "dome --basis sh --bits half" "0 23"
both "dome --basis sh --coefficients 25 --domain display" "9 8"
both "dome --basis table" "9 8"
both "dome --basis table --bits half" "23 0"
both "all --basis sh --coefficients 16" "12 12"
both "all --basis table --bits 16" "9 8"
both "photos --basis sh" "9 8"
both "photos --basis table --compression zip" "9 8"
both "photos --basis sh --domain linear --compression none" "9 8"

"$RELUME" encode photos -o gamma.exr --basis sh --transfer gamma:2.2 -q
agree "a gamma of 2.2" gamma.exr 0 "$(planar 12 5)" 12 5

# A grid of lights has four of them on every circle: the shifts decide.
"$RELUME" lights --pattern grid -n 36 --hemisphere >grid.txt
"$RELUME" synth box -o grid --size $size --lights-from grid.txt --samples 1 -q
"$RELUME" encode grid -o grid.exr --basis table -q
agree "lights on common circles" grid.exr 0 "$(planar 10 11)" 10 11

# A slab: the ray from a camera through the middle of a pixel of its window [-1, 1].
"$RELUME" synth teapot -o slab --size $size --views 2x2 --lights 20 --samples 1 -q
"$RELUME" encode slab -o slab.exr --basis sh -q
slab_ray() { awk -v u="$1" -v v="$2" -v x="$3" -v y="$4" -v n=$size 'BEGIN {
    s = -1 + 2 * (x + .5) / n; t = 1 - 2 * (y + .5) / n
    printf "--eye %g,%g,3 --direction %.9f,%.9f,-3", u, v, s - u, t - v }'; }
uv=$(sed -n 's/.*"uv": \[\([^]]*\)\].*/\1/p' slab/capture.json | sed -n 3p | tr -d ,)
agree "view 2 of a slab" slab.exr 2 "$(slab_ray $uv 14 13)" 14 13

# A panorama: pole +y.
"$RELUME" synth attic -o attic --size $size --lights 20 --samples 1 -q
"$RELUME" encode attic -o attic.exr --basis sh -q
width=$("$RELUME" info attic.exr --json | sed 's/.*"width": \([0-9]*\).*/\1/')
read -r v_min v_max x y z <<CENTER
$(sed -n 's/.*"v_min": \([^,]*\), "v_max": \([^,]*\), "center": \[\([^]]*\)\].*/\1 \2 \3/p' \
    attic/capture.json | tr -d ,)
CENTER
attic_ray() { awk -v x="$1" -v y="$2" -v w="$width" -v n=$size -v lo="$v_min" -v hi="$v_max" 'BEGIN {
    phi = ((x + .5) / w * 2 - 1) * 3.14159265358979
    printf "--direction %.12f,%.12f,%.12f", sin(phi), hi - (y + .5) / n * (hi - lo), -cos(phi) }'; }
agree "a panorama" attic.exr 0 "--eye $x,$y,$z $(attic_ray 31 12)" 31 12

# The worked example says what happens. Rays and fits may differ a little between CPU types.
"$RELUME" synth box -o ex --size 16 --lights 9 --hemisphere --samples 4 -q
"$RELUME" encode ex -o ex.exr --basis sh --coefficients 4 -q
said=$(sed -n '/query ex.exr/,$s/^ *\([0-9.]* [0-9.]* [0-9.]*\)$/\1/p' "$TOP/docs/format.md")
tolerance=2e-3
check "the worked example of format.md" near \
    "$("$RELUME" query ex.exr --eye -0.0625,-0.1875,4 --direction 0,0,-1 --light "dir 0 0 1")" "$said"
agree "the worked example decoded" ex.exr 0 "--eye -0.0625,-0.1875,4 --direction 0,0,-1" 7 9
finish
