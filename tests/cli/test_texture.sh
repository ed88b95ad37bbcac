#!/bin/sh
# relume btf synth: pictures and materials that go on, maps between programs, what is refused.
. "$(dirname "$0")/lib.sh"

"$RELUME" synth --btf corduroy -o cord --size 24 --directions coarse --samples 1 --bounces 0 -q
"$RELUME" synth --btf wallpaper -o paper --size 8 --directions coarse --samples 1 --bounces 0 -q
"$RELUME" btf render cord -o cord.ppm --light 'dir 1 0 1' -q

# ---- pictures
expect_ok 'more of a picture' - "$RELUME" btf synth cord.ppm -o more.ppm --size 70x50 --save-map more.npy --seed 3 -q
expect_ok 'the same by the map alone' - "$RELUME" btf synth cord.ppm -o again.ppm --map more.npy --plain -q
check 'a map makes the same picture' cmp more.ppm again.ppm
expect_ok 'a map as places' - "$RELUME" btf synth cord.ppm -o more.exr --size 70x50 --save-map places.exr --seed 3 --threads 1 -q
expect_ok 'which are read' - "$RELUME" btf synth cord.ppm -o placed.npy --map places.exr --plain -q
check 'places and numbers are the same map, for any threads' cmp more.npy placed.npy
expect_ok 'pixels, tiled' - "$RELUME" btf synth cord.ppm -o tile.png --method pixel --tile --size 48x48 --save-mask mask.png -q
check 'a mask' test -s mask.png
"$RELUME" btf synth cord.ppm -o x.npy --size 60x60 --json -q >synth.json
for f in 'regular true' 'common true' 'width 60' 'sample_width 24'; do
    set -- $f
    if grep -q "\"$1\": $2," synth.json; then ok "synth: $1"; else not_ok "synth: $1" "$(cat synth.json)"; fi
done
below 'repetition is below that of tiling' "$(field repetition synth.json)" 1
"$RELUME" btf synth cord.ppm -o x.npy --size 9x9 --waves >waves.txt
if grep -q '^waves of the structure' waves.txt; then ok 'waves'; else not_ok 'waves' 'none'; fi

# ---- materials: a map of a BTF is a surface; that of its picture fits its model
expect_ok 'more of a material' - "$RELUME" btf synth paper -o wide --size 64x40 --force -q
"$RELUME" btf info wide --json >info.json
for f in 'width 64' 'height 40' 'tiles 1'; do
    set -- $f
    if [ "$(field "$1" info.json)" = "$2" ]; then ok "surface: $1"; else not_ok "surface: $1" "$(cat info.json)"; fi
done
expect_ok 'a model of it' - "$RELUME" btf fit cord --model lit -o model -q
expect_ok 'more of a model' - "$RELUME" btf synth model -o wide-model --size 40x24 -q
expect_ok 'a map of the picture on the model' - "$RELUME" btf tile model -o wide-map --map more.npy -q
expect_ok 'the surface under a light' - "$RELUME" btf render wide-map -o lit.exr --light 'dir 1 0 1' -q
"$RELUME" btf render wide-map -o lit.ppm --light 'dir 1 0 1' -q
"$RELUME" btf render model -o flat.ppm --light 'dir 1 0 1' -q
"$RELUME" btf synth flat.ppm -o mapped.ppm --map more.npy --plain -q >out.txt
check 'a surface shows what its map makes of a picture of the model' cmp lit.ppm mapped.ppm

# ---- nothing repeats
"$RELUME" btf render cord -o white.exr --picture 32x32 --light 'dir 0 0 -1' -q
"$RELUME" btf synth white.exr -o none.ppm --size 40x40 >none.txt 2>err.txt
if grep -q 'nothing repeats in this sample' err.txt && grep -q 'none that repeats' none.txt; then ok 'no structure is said'; else not_ok 'no structure is said' "$(cat err.txt none.txt)"; fi

# ---- what is refused
expect_fail 'no such sample' 1 'nothing.ppm: cannot be read; no such file or folder' x.ppm "$RELUME" btf synth nothing.ppm -o x.ppm
expect_fail 'an unknown ending' 2 'x.abc' x.abc "$RELUME" btf synth cord.ppm -o x.abc
expect_fail 'an even neighbourhood' 2 'an odd number from 3 to 9; found 4' x.ppm "$RELUME" btf synth cord.ppm -o x.ppm --method pixel --neighbourhood 4
expect_fail 'a patch larger than the sample' 2 'an even number from 4 to 24; found 26' x.ppm "$RELUME" btf synth cord.ppm -o x.ppm --patch 26
expect_fail 'a method that is none' 2 "--method" x.ppm "$RELUME" btf synth cord.ppm -o x.ppm --method tiles
expect_fail 'a map over the limits' 1 'the map takes 2 MB; expected at most 1 MB' x.ppm "$RELUME" btf synth cord.ppm -o x.ppm --size 700x700 --max-memory 1M
expect_fail 'a size that is too large' 2 'at most 65536 a side and 2.30 pixels' x.ppm "$RELUME" btf synth cord.ppm -o x.ppm --size 65536x65536
expect_fail 'a size with a map' 2 'the size is that of the map' x.ppm "$RELUME" btf synth cord.ppm -o x.ppm --map more.npy --size 8x8
expect_fail 'waves of no structure' 2 'looks for no structure' x.ppm "$RELUME" btf synth cord.ppm -o x.ppm --plain --waves
expect_fail 'a map of a larger sample' 1 'expected a texel of 8 x 8; found number' x.ppm sh -c '"$1" btf render cord -o small.ppm --picture 8x8 --light "dir 0 0 1" -q && "$1" btf synth small.ppm -o x.ppm --map more.npy' - "$RELUME"
head -c 400 more.npy >short.npy
expect_fail 'a truncated map' 1 'short.npy' x.ppm "$RELUME" btf synth cord.ppm -o x.ppm --map short.npy
head -c 100 cord.ppm >short.ppm
expect_fail 'a truncated picture' 1 'short.ppm' x.ppm "$RELUME" btf synth short.ppm -o x.ppm
"$RELUME" btf render cord -o lit.exr --light 'dir 1 0 1' -q
"$mkimage" poke lit.exr nan.exr 3 4 nan
expect_fail 'a picture with NaN' 1 'row 4, column 3: expected a number; found nan' x.ppm "$RELUME" btf synth nan.exr -o x.ppm
expect_fail 'a sample of 4 x 4' 1 'at least 8 x 8 texels; found 4 x 4' x.ppm sh -c '"$1" btf render cord -o tiny.ppm --picture 4x4 --light "dir 0 0 1" -q && "$1" btf synth tiny.ppm -o x.ppm' - "$RELUME"
expect_fail 'a map of an unknown kind' 2 'x.png: expected .npy or .exr for a map' x.png "$RELUME" btf synth cord.ppm -o y.ppm --size 9x9 --save-map x.png -q
expect_fail 'a folder that is there' 2 'cord: already exists' - "$RELUME" btf synth cord -o cord --size 9x9
finish
