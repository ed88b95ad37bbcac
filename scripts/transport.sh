#!/bin/sh
# The pictures of docs/transport.md.
# transport.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
# Scenes stay in the work folder and are used again. The cow and the shore are those of ../shared/data.
set -eu
relume=$1/relume viewer=$1/relume-view draw=$1/samples/figures out=$2 pictures=$3 data=$PWD/../shared/data
mkdir -p "$out" "$pictures"

cow() { # angle, translate, scale
    echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"$data/meshes/spot.obj\",
        \"pose\":{\"scale\":$3,\"rotate\":[0,1,0,$1],\"translate\":[$2]},
        \"parts\":[{\"material\":{\"diffuse\":0.8}}]}]}"
}
cow 205 -0.45,-1.18,-1.75 0.42 >"$out/attic.json"
cow 30 0,-0.9,-2 0.5 >"$out/shore.json"
printf '.8 .5 0\n-.8 .6 0\n0 1 -.3\n0 .2 1\n' >"$out/suns"
if [ ! -e "$out/attic.exr" ]; then
    "$relume" synth attic -o "$out/attic" --projection spherical --size 320 --lights-from "$out/suns" --samples 36 --bounces 2 -q
    "$relume" encode "$out/attic" -o "$out/attic.exr" --shadows no -q
fi
if [ ! -e "$out/shore.exr" ]; then
    shore=$data/pano-rgbd-kandao/kandao3
    "$relume" panorama "$shore.jpg" --depth "${shore}_depthmap.jpg" --depth-range 1,8 -o "$out/shore" -q
    "$relume" encode "$out/shore" -o "$out/shore.exr" -q
fi
list= gathered=
for scene in attic shore; do
    case $scene in
    attic) look="--pan -8 --tilt -24 --zoom 2.2 --exposure 1.5" ;;
    shore) look="--pan 3 --tilt -18 --zoom 2" ;;
    esac
    for way in none ssao ssdo ism micro path; do
        "$relume" relight "$out/$scene.exr" --objects "$out/$scene.json" -o "$out/$scene-$way.exr" $look \
            --size 256x256 --light "dir .8 .5 0" --transport $way -q 2>/dev/null
        [ $way = micro ] || list="$list $out/$scene-$way.exr"
    done
    gathered="$gathered $out/$scene-ssdo.exr $out/$scene-micro.exr $out/$scene-path.exr"
done
"$draw" row "$pictures/transport.jpg" columns=5 $list
echo "  $pictures/transport.jpg"
"$draw" row "$pictures/micro.jpg" columns=3 $gathered
echo "  $pictures/micro.jpg"

# the sun goes over the attic
if [ ! -e "$out/day.exr" ]; then
    "$relume" synth attic -o "$out/day" --projection spherical --size 192 --lights 40 --hemisphere --samples 16 --bounces 3 -q
    "$relume" encode "$out/day" -o "$out/day.exr" -q
fi
list=
for sun in '1 .6 .1' '.6 .8 .1' '.1 1 .1' '-.5 .8 .1' '-1 .5 .1'; do
    file=$out/sun$(echo "$sun" | tr -d ' ').exr
    "$relume" relight "$out/day.exr" --objects "$out/attic.json" -o "$file" --tilt -20 --pan -8 --zoom 1.7 --exposure 1 \
        --size 200x160 --light "dir $sun" --transport ssdo -q 2>/dev/null
    list="$list $file"
done
"$draw" row "$pictures/transport-sun.jpg" columns=5 $list
echo "  $pictures/transport-sun.jpg"

# in the viewer: one way beside hard shadows, and the panel
printf 'size 900 520\ndock left\nclick 100 26\ntransport ssdo\ntransport beside none\nmove 600 510\nwait\nshot %s\n' "$out/ways.exr" >"$out/ways.txt"
"$viewer" "$out/attic.exr" --objects "$out/attic.json" --pan -12.5 --tilt -24 --zoom 2.2 --exposure 1.5 \
    --light "dir .8 .5 0" --script "$out/ways.txt"
"$draw" row "$pictures/viewer-ways.jpg" columns=1 "$out/ways.exr"
echo "  $pictures/viewer-ways.jpg"
