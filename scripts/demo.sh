#!/bin/sh
# `make demo`: the main job from end to end, in pictures. demo.sh BUILD_FOLDER OUT_FOLDER
set -eu
relume=$1/relume view=$1/relume-view row="$1/samples/figures row" out=$2
rm -rf "$out"
mkdir -p "$out"

picture() { # what, file, command...
    what=$1 file=$2
    shift 2
    "$@" -o "$file"
    echo "  $file  $what"
}

echo "A marble head: 200 lights, one file"
"$relume" synth bust -o "$out/bust" --lights 200 --hemisphere --size 528 --samples 4
"$relume" encode "$out/bust" -o "$out/bust.exr"
bust() { # what, name, options...
    what=$1 name=$2
    shift 2
    picture "$what" "$out/bust-$name.png" "$relume" relight "$out/bust.exr" "$@"
}
bust "light from the left" left --light "dir -1 0.35 0.45 rgb 1.5 1.45 1.35"
bust "light from above" above --light "dir 0.25 1 0.7 rgb 1.25 1.25 1.2"
bust "a blue and an orange lamp" two --light "dir -1 0.3 0.5 rgb 0.25 0.5 1.5" \
    --light "dir 1 0.4 0.35 rgb 1.7 0.75 0.25"
bust "fire light and the sky" fire --light "dir 0.9 -0.5 0.5 rgb 1.4 1.1 0.7" \
    --light "dir -0.6 0.8 0.1 rgb 0.3 0.4 0.6"
bust "the directions of its surface" normals --pass normals
$row "$out/bust.jpg" crop=138,6,252,516 "$out/bust-left.png" "$out/bust-above.png" "$out/bust-two.png" \
    "$out/bust-fire.png" "$out/bust-normals.png"
echo "  $out/bust.jpg  all five in a row (docs/pictures/bust.jpg)"

echo "A glossy teapot: 49 eyes, 100 lights, one file"
"$relume" synth teapot -o "$out/teapot" --views 7x7 --lights 100 --size 288 --samples 4
"$relume" encode "$out/teapot" -o "$out/teapot.exr"
picture "light from the upper left" "$out/teapot-left.png" \
    "$relume" relight "$out/teapot.exr" --light "dir -1 0.7 0.8"
picture "light from the upper right" "$out/teapot-right.png" \
    "$relume" relight "$out/teapot.exr" --light "dir 1 0.7 0.8"
picture "a blue and a red light" "$out/teapot-two.png" \
    "$relume" relight "$out/teapot.exr" --light "dir -1 0.5 0.6 rgb 0.15 0.35 1" \
    --light "dir 1 0.5 0.6 rgb 1 0.3 0.1"
picture "seen from the left" "$out/teapot-eye-left.png" \
    "$relume" relight "$out/teapot.exr" --light "dir 0.3 0.8 1" --eye=-0.4,0,3
picture "seen from the upper right" "$out/teapot-eye-right.png" \
    "$relume" relight "$out/teapot.exr" --light "dir 0.3 0.8 1" --eye=0.35,0.3,3
"$view" "$out/teapot.exr" --offscreen "$out/teapot-viewer.png" --ball --size 512x512 \
    --light "dir 0.6 0.8 0.6"
echo "  $out/teapot-viewer.png  the viewer's own frame, rendered without a display"

echo "An attic from its middle: a panorama under 144 lights"
"$relume" synth attic -o "$out/attic" --lights 144 --hemisphere --size 384 --samples 6
"$relume" encode "$out/attic" -o "$out/attic.exr" --basis table

# A sun among six weak lights that imitate the sky: any number of lights costs one pass.
attic() { # what, file, sun, options...
    what=$1 file=$2 sun=$3
    shift 3
    set -- "$@" --light "dir $sun rgb 2.6 2.3 1.9"
    for sky in "1 1 0" "-1 1 0" "0 1 1" "0 1 -1" "0.3 1 0.2" "-0.7 0.4 -0.7"; do
        set -- "$@" --light "dir $sky rgb 0.16 0.2 0.28"
    done
    picture "$what" "$file" "$relume" relight "$out/attic.exr" "$@"
}
attic "unfolded, sun from the front right" "$out/attic-unfolded.png" "0.5 0.7 -0.6"
look="--zoom 0.8 --size 800x400"
attic "ahead, sun from the front right" "$out/attic-front.png" "0.5 0.7 -0.6" --pan 0 $look
attic "the same, low sun from behind" "$out/attic-behind.png" "-0.3 0.35 0.9" --pan 0 $look
attic "turned by 100 degrees" "$out/attic-panned.png" "-0.3 0.35 0.9" --pan 100 $look

photographs=../shared/data/realrti/item1/dirs.lp
if [ -f "$photographs" ]; then
    echo "Real photographs: a painted door under 60 lights"
    "$relume" encode "$photographs" -o "$out/door.exr" --basis sh --coefficients 16
    picture "light from the left" "$out/door-left.png" \
        "$relume" relight "$out/door.exr" --light "dir -1 0 0.5"
    picture "light from the right" "$out/door-right.png" \
        "$relume" relight "$out/door.exr" --light "dir 1 0 0.5"
else
    echo "skipped: no photographs beside the project"
fi
