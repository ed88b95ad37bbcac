#!/bin/sh
# The picture of docs/translucent.md: marble, skin and wax, lit from behind and from the side.
# translucent.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
# The cow is that of ../shared/data.
set -eu
relume=$1/relume draw=$1/samples/figures out=$2 pictures=$3 cow=$PWD/../shared/data/meshes/spot.obj
mkdir -p "$out" "$pictures"

render() { # name, material, light, how bright
    echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"$cow\",
        \"pose\":{\"rotate\":[0,1,0,215]},\"parts\":[{\"material\":$2}]}]}" >"$out/$1.json"
    "$relume" btf render "$out/$1.json" -o "$out/$1.exr" --eye 0,.6,4 --look-at 0,.05,0 --fov 26 --picture 224x240 \
        --light "$3 rgb $4 $4 $4" -q 2>/dev/null
}
list=
for side in behind beside; do
    case $side in
    behind) light='dir -.3 .5 -1' gain=2 ;;
    beside) light='dir 1 .5 .3' gain=1.2 ;;
    esac
    render "matte-$side" '{"diffuse":[0.75,0.72,0.68]}' "$light" $gain
    list="$list $out/matte-$side.exr"
    for material in marble skin wax; do
        render "$material-$side" "{\"translucent\":{\"preset\":\"$material\",\"scale_mm\":15}}" "$light" $gain
        list="$list $out/$material-$side.exr"
    done
done
"$draw" row "$pictures/translucent.jpg" columns=4 gain=1 $list
echo "  $pictures/translucent.jpg"
