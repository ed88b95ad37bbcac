#!/bin/sh
# synth -> encode -> info -> relight -> eval, for every projection.
. "$(dirname "$0")/lib.sh"
for p in 'box planar' 'teapot slab' 'attic cylindrical' 'chessboard spherical' 'attic cube'; do
    set -- $p
    v=
    [ "$2" = slab ] && v='--views 2x2'
    expect_ok "synth $p" - "$RELUME" synth "$1" -o "$2" --projection "$2" --size 12 --lights 10 --samples 1 $v
    expect_ok "encode $p" - "$RELUME" encode "$2" -o "$2.exr" --basis table --bits half
    "$RELUME" info "$2.exr" --json >info.json
    if grep -q "\"projection\": \"$2\"" info.json; then ok "info $p"; else not_ok "info $p" "$(cat info.json)"; fi
    expect_ok "relight $p" - "$RELUME" relight "$2.exr" -o "$2.png"
    "$RELUME" eval "$2.exr" "$2" --json >eval.json 2>err.txt
    # halves of the images come back as they are, so that 8-bit codes agree
    above "eval $p" "$(field psnr_db eval.json)" 90
done
for p in colonnade cornell; do
    expect_ok "$p" - "$RELUME" synth "$p" -o "$p" --size 12 --lights 3 --samples 1
    "$RELUME" info "$p" --json >info.json
    check "$p is seen all around" grep -q '"projection": "spherical"' info.json
done
expect_ok 'a folder called as its scene' - "$RELUME" synth box -o box --size 8 --lights 3
expect_ok 'is replaced like any other' - "$RELUME" synth box -o box --size 8 --lights 3 --force
expect_ok 'a material likewise' - "$RELUME" synth --btf knit -o knit --size 4 --directions coarse
expect_ok 'and once more' - "$RELUME" synth --btf knit -o knit --size 4 --directions coarse --force
expect_fail 'a scene beyond --max-memory' 1 'a picture of this size takes 6104 MB; expected at most 50 MB' huge "$RELUME" synth box -o huge --size 20000 --max-memory 50M
expect_fail 'one beyond --max-pixels' 2 'size: expected .* at most --max-pixels; found 200' huge "$RELUME" synth box -o huge --size 200 --max-pixels 5000
expect_fail 'a material beyond --max-pixels' 2 'size: expected .* at most --max-pixels; found 64 x 64' huge "$RELUME" synth --btf stone -o huge --max-pixels 4095
expect_fail 'a material beyond --max-memory' 1 'a view of this size under all lights takes [0-9]* MB; expected at most 100 MB' huge "$RELUME" btf fit stone -o huge --size 1024 --max-memory 100M
# A cylinder with discs shows what a sphere shows, upwards and downwards and over both rims; without
# them there is black.
"$RELUME" synth attic -o discs --discs --size 48 --lights 1 --hemisphere --samples 4 -q
"$RELUME" synth attic -o sphere --projection spherical --size 96 --lights 1 --hemisphere --samples 4 -q
"$RELUME" synth attic -o open --size 48 --lights 1 --hemisphere --samples 4 -q
for c in discs sphere open; do "$RELUME" encode $c -o $c.exr --basis table --bits half -q; done
for tilt in 85 -45 -85; do
    for c in discs sphere open; do
        "$RELUME" relight $c.exr -o $c.look.exr --tilt $tilt --pan 25 --size 64x48 --light 'dir .3 1 .4' -q
    done
    for c in discs open; do
        "$RELUME" compare $c.look.exr sphere.look.exr --json | sed -n 's/.*"rms": \([^,]*\).*/\1/p' >$c.rms
    done
    # what is left: their texels lie elsewhere at edges, and the sun falls on little of the roof
    if awk -v a="$(cat discs.rms)" -v b="$(cat open.rms)" 'BEGIN { exit !(a > 0 && 1.2 * a < b) }'; then
        ok "discs show what a sphere shows at $tilt"
    else
        not_ok "discs show what a sphere shows at $tilt" "$(cat discs.rms open.rms)"
    fi
done
"$RELUME" eval discs.exr discs --json >eval.json
above 'eval of discs' "$(field psnr_db eval.json)" 90
expect_ok 'a spot under a roof' - "$RELUME" relight discs.exr -o spot.png --tilt 60 --light 'spot 0 0 0 0 1 0 40'
expect_fail 'views of a panorama' 2 'views: expected --projection slab' s "$RELUME" synth attic -o s --views 2x2
expect_ok 'views of a planar scene' - "$RELUME" synth box -o s --views 2x1 --size 8 --lights 1 --samples 1 -q
check 'make a slab' test "$(grep -c '"uv": \[' s/capture.json)" -eq 2
rm -rf s
expect_fail 'discs of a sphere' 2 'discs: expected a cylinder; found a spherical capture' s "$RELUME" synth attic -o s --projection spherical --discs
sed 's/"discs": [0-9]*/"discs": 97/' discs/capture.json >discs/wrong.json
expect_fail 'discs wider than the cylinder' 1 'panorama.discs; expected at most half of the 192 columns' w.exr "$RELUME" encode discs/wrong.json -o w.exr
expect_ok 'look into a panorama' - "$RELUME" relight cylindrical.exr -o look.png --pan 30 --tilt 10 --zoom 2 --size 40x20
expect_fail 'pan over a slab' 2 'slab.exr: pan, tilt and zoom need a panorama' u.png "$RELUME" relight slab.exr -o u.png --pan 3
"$RELUME" synth box -o again --projection planar --size 12 --lights 10 --samples 1 --threads 1 2>/dev/null
if diff -r planar again >/dev/null; then ok 'synth is the same for any threads'; else not_ok 'synth is the same for any threads' "$(diff -rq planar again)"; fi
finish
