#!/bin/sh
# The pictures of docs/scenes.md, one of them of the viewer.
# scenes.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
# Captures stay in the work folder and are used again. The cow and the shore are those of ../shared/data.
set -eu
relume=$1/relume viewer=$1/relume-view draw=$1/samples/figures out=$2 pictures=$3 data=$PWD/../shared/data
mkdir -p "$out" "$pictures"
if [ ! -e "$out/teapot.exr" ]; then
    "$relume" synth teapot -o "$out/teapot" --views 5x5 --size 256 --lights 24 --samples 9 -q
    "$relume" encode "$out/teapot" -o "$out/teapot.exr" --psnr 40 -q
fi
if [ ! -e "$out/shore.exr" ]; then
    shore=$data/pano-rgbd-kandao/kandao3
    "$relume" panorama "$shore.jpg" --depth "${shore}_depthmap.jpg" --depth-range 1,8 -o "$out/shore" -q
    "$relume" encode "$out/shore" -o "$out/shore.exr" -q
fi
cat >"$out/scene.json" <<JSON
{ "format": "relume-scene", "version": 1,
  "captures": [
    { "file": "shore.exr" },
    { "file": "teapot.exr", "name": "teapot", "pose": { "scale": 0.8, "rotate": [0, 1, 0, 20], "translate": [-0.45, -0.8, -2.2] } } ],
  "objects": [
    { "mesh": "$data/meshes/spot.obj", "name": "cow", "pose": { "scale": 0.4, "rotate": [0, 1, 0, 200], "translate": [0.95, -0.8, -2.1] },
      "parts": [ { "material": { "diffuse": [0.8, 0.7, 0.6] } } ] },
    { "mesh": "$data/meshes/spot.obj", "name": "mirror", "pose": { "scale": 0.25, "rotate": [0, 1, 0, 150], "translate": [0.25, -0.95, -1.7] },
      "parts": [ { "material": { "mirror": 0.9 } } ] } ],
  "look_at": [0, -0.5, -1.5], "fov": 70, "size": [512, 320] }
JSON
draw_frame() { # number, eye, light
    "$relume" relight "$out/scene.json" -o "$out/frame$1.exr" --eye "$2" --look-at 0,-0.5,-1.5 --light "dir $3" --transport ssdo -q 2>/dev/null
}
draw_frame 1 0,0,0 '.6 .7 .4'
draw_frame 2 -0.5,0.1,-0.1 '-.8 .5 .1'
"$draw" row "$pictures/scenes.jpg" columns=2 "$out/frame1.exr" "$out/frame2.exr"
echo "  $pictures/scenes.jpg"
cat >"$out/moves.txt" <<END
drag left 400 200 430 195
key ctrl+right
key ctrl+right
transport beside ssdo
move 300 40
wait
shot $out/viewer.exr
END
"$viewer" "$out/scene.json" --size 1100x500 --dock right --light 'dir .6 .7 .4' --script "$out/moves.txt" 2>/dev/null
"$draw" row "$pictures/viewer-scene.jpg" columns=1 "$out/viewer.exr"
echo "  $pictures/viewer-scene.jpg"
