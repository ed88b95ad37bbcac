#!/bin/sh
# The picture of mirrors in docs/reflections.md: what a mirror ball in the attic shows of a cow.
# mirror.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
# The attic is that of scripts/transport.sh, in whose work folder it is found again; the cow that of ../shared/data.
set -eu
relume=$1/relume draw=$1/samples/figures out=$2 pictures=$3 data=$PWD/../shared/data
mkdir -p "$out" "$pictures"

awk -v n=48 -f scripts/ball.awk >"$out/ball.obj"
cat >"$out/mirror.json" <<END
{ "format": "relume-objects", "version": 1, "objects": [
  { "mesh": "ball.obj", "pose": { "scale": 0.35, "translate": [0.25, -0.8, -1.9] }, "parts": [ { "material": { "mirror": 0.95 } } ] },
  { "mesh": "$data/meshes/spot.obj", "pose": { "scale": 0.42, "rotate": [0, 1, 0, 205], "translate": [-0.4, -1.18, -1.55] },
    "parts": [ { "material": { "diffuse": [0.8, 0.5, 0.3] } } ] } ] }
END
if [ ! -e "$out/attic.exr" ]; then
    printf '.8 .5 0\n-.8 .6 0\n0 1 -.3\n0 .2 1\n' >"$out/suns"
    "$relume" synth attic -o "$out/attic" --projection spherical --size 320 --lights-from "$out/suns" --samples 36 --bounces 2 -q
    "$relume" encode "$out/attic" -o "$out/attic.exr" --shadows no -q
fi
list=
for way in none ssdo path; do
    "$relume" relight "$out/attic.exr" --objects "$out/mirror.json" -o "$out/mirror-$way.exr" --pan -4 --tilt -25 --zoom 3 --exposure 0.8 \
        --size 280x280 --light "dir .8 .5 0" --transport $way -q 2>/dev/null
    list="$list $out/mirror-$way.exr"
done
"$draw" row "$pictures/mirror.jpg" $list
echo "  $pictures/mirror.jpg"
