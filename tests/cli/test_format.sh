#!/bin/sh
# A second reader, written from docs/format.md alone (tests/tools/decode.c), sees in a relume file
# what the library sees: storage, domain, projections, from the front, from the side, below the
# horizon. Bases and interpolants: test_format_bases.sh.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/format.sh"
both "dome --basis sh --coefficients 9" "9 8"
both "dome --basis sh --coefficients 16 --bits 16" "9 8"
both "dome --basis sh --bits half" "0 23"
both "dome --basis sh --coefficients 25 --domain display" "9 8"
both "dome --basis table" "9 8"
both "dome --basis table --bits half" "23 0"
both "dome --basis table --bits float" "9 8"
both "dome --basis sh --bits log" "9 8"
both "all --bits float --shadows no" "12 12"
both "all --basis sh --coefficients 16" "12 12"
both "all --basis table --bits 16" "9 8"
both "photos --basis sh" "9 8"
both "photos --basis table --compression zip" "9 8"
both "photos --basis sh --domain linear --compression none" "9 8"

# Halves end at 65504: brighter planes stand over a power of two.
"$mkimage" gain dome/view00/light0003.exr bright.exr 1e6 && mv bright.exr dome/view00/light0003.exr
both "dome --basis table --bits half" "9 8"
both "dome" "9 8"

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

# Its end discs, pixel (8, 9) of each: the upper one's up is +z, the lower one's -z.
"$RELUME" synth attic -o discs --discs --size $size --lights 20 --samples 1 -q
"$RELUME" encode discs -o discs.exr --basis sh -q
side=$(sed -n 's/.*"discs": \([0-9]*\).*/\1/p' discs/capture.json)
check 'discs are version 3' grep -q '"version": 3' <<INFO
$("$RELUME" info discs.exr --json)
INFO
disc_ray() { awk -v n="$side" -v h="$1" 'BEGIN {
    printf "--direction %.12f,%.12f,%.12f", 2 * 8.5 / n - 1, h, (h > 0 ? 1 : -1) * (1 - 2 * 9.5 / n) }'; }
agree "the upper disc" discs.exr 0 "--eye $x,$y,$z $(disc_ray "$v_max")" 8 $((size + 9))
agree "the lower disc" discs.exr 0 "--eye $x,$y,$z $(disc_ray "$v_min")" $((side + 8)) $((size + 9))

# The worked example says what happens. Rays and fits may differ a little between CPU types.
"$RELUME" synth box -o ex --size 16 --lights 9 --hemisphere --samples 4 -q
"$RELUME" encode ex -o ex.exr --basis sh --coefficients 4 -q
said=$(sed -n '/query ex.exr/,$s/^ *\([0-9.]* [0-9.]* [0-9.]*\)$/\1/p' "$TOP/docs/format.md")
tolerance=2e-3
check "the worked example of format.md" near \
    "$("$RELUME" query ex.exr --eye -0.0625,-0.1875,4 --direction 0,0,-1 --light "dir 0 0 1")" "$said"
agree "the worked example decoded" ex.exr 0 "--eye -0.0625,-0.1875,4 --direction 0,0,-1" 7 9
finish
