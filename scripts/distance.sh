#!/bin/sh
# The picture of docs/distance.md: a cow of triangles, and of billboards for several errors, near and as far as they are for.
# distance.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
# The cow is that of ../shared/data.
set -eu
relume=$1/relume draw=$1/samples/figures out=$2 pictures=$3 cow=${COW:-$PWD/../shared/data/meshes/spot.obj}
mkdir -p "$out" "$pictures"
list=
for error in 0 0.04 0.02 0.01 0.005; do
    billboards=
    [ $error = 0 ] || billboards="\"billboards\":$error,"
    echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"$cow\",$billboards
        \"pose\":{\"rotate\":[0,1,0,215]},\"parts\":[{\"material\":{\"diffuse\":[0.8,0.5,0.3]}}]}]}" >"$out/$error.json"
    "$relume" btf render "$out/$error.json" -o "$out/$error.exr" --eye 0,.6,4 --look-at 0,.05,0 --fov 26 --picture 224x240 \
        --light 'dir -1 1.2 1.2' -q 2>/dev/null
    list="$list $out/$error.exr"
done
"$draw" row "$pictures/distance.jpg" columns=5 gain=1 $list
echo "  $pictures/distance.jpg"
