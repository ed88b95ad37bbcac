#!/bin/sh
# `make tour`: a film of everything the viewer does. tour.sh BUILD_FOLDER OUT_FOLDER
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "$1" && pwd) out=$2
relume=$build/relume view=$build/relume-view
rm -rf "$out"
mkdir -p "$out"
cd "$out"

"$relume" synth teapot -q -o teapot --views 5x5 --lights 49 --size 160 --samples 2
"$relume" encode -q teapot -o teapot.exr --basis sh --coefficients 36
"$relume" synth attic -q -o attic --projection cylindrical --lights 64 --hemisphere --size 160 --samples 2
"$relume" encode -q attic -o attic.exr --basis table
"$relume" synth bust -q -o bust --size 200 --lights 49 --hemisphere --samples 2
"$relume" encode -q bust -o bust.exr
# blue above, brown below, a low sun to the right
awk 'BEGIN {
    print "P3 64 32 255"
    for (y = 0; y < 32; y++)
        for (x = 0; x < 64; x++)
            print (y > 6 && y < 13 && x > 40 && x < 49) ? "255 240 200" : y < 16 ? "40 50 70" : "20 15 10"
}' >sky.ppm
"$relume" relight bust.exr -o slide.png --light "dir 1 1 2"
cat >lamp.ies <<'END'
IESNA:LM-63-1995
TILT=NONE
1 1000 1 7 1 1 2 0 0 0
1 1 10
0 8 16 24 32 40 90
0
100 95 40 90 20 5 0
END
# faces +x -x +y -y +z -z; the last one is ahead
printf 'P3\n6 1\n255\n255 0 0  0 0 255  0 255 0  255 255 0  0 0 0  255 230 200\n' >faces.ppm
"$relume" relight teapot.exr -o rim.png --light 'dir 1 0 0.2' --save-rig rig.json \
    --light 'dir -1 0 0.2 rgb 0.2 0.4 1' --light 'dir 0 1 0.2 rgb 1 0.5 0.2'

film=film
command -v ffmpeg >/dev/null 2>&1 && film=film.mp4
"$view" teapot.exr --script "$here/samples/tour.script" --record script -o "$film" \
    --light 'dir 0.3 0.6 1'
echo "$out/$film"
