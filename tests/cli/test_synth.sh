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
expect_ok 'look into a panorama' - "$RELUME" relight cylindrical.exr -o look.png --pan 30 --tilt 10 --zoom 2 --size 40x20
expect_fail 'pan over a slab' 2 'slab.exr: pan, tilt and zoom need a panorama' u.png "$RELUME" relight slab.exr -o u.png --pan 3
"$RELUME" synth box -o again --projection planar --size 12 --lights 10 --samples 1 --threads 1 2>/dev/null
if diff -r planar again >/dev/null; then ok 'synth is the same for any threads'; else not_ok 'synth is the same for any threads' "$(diff -rq planar again)"; fi
finish
