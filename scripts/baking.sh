#!/bin/sh
# The pictures of docs/baking.md.
# baking.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
# What is baked stays in the work folder and is used again. The cow and the skies are those of
# ../shared/data.
set -eu
relume=$1/relume draw=$1/samples/figures out=$2 pictures=$3 data=$PWD/../shared/data
mkdir -p "$out" "$pictures"
sky=$data/hdri-polyhaven-1k

description() { # the members of objects
    echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[$1]}"
}
printf 'v -1.2 -0.74 -1.2\nv 1.2 -0.74 -1.2\nv 1.2 -0.74 1.2\nv -1.2 -0.74 1.2\nvn 0 1 0\nf 1//1 4//1 3//1 2//1\n' >"$out/floor.obj"
description "{\"mesh\":\"$data/meshes/spot.obj\",\"pose\":{\"rotate\":[0,1,0,150]},\"parts\":[{\"material\":{\"diffuse\":[0.8,0.7,0.6]}}]},
    {\"mesh\":\"floor.obj\",\"parts\":[{\"material\":{\"diffuse\":[0.8,0.3,0.2]}}]}" >"$out/cow.json"
for way in sh table; do
    [ -e "$out/cow-$way.exr" ] ||
        "$relume" bake "$out/cow.json" -o "$out/cow-$way.exr" --basis $way $([ $way = sh ] && echo '--coefficients 100' || echo '--coefficients 400') --bounces 3 --components 24 -q
    description "{\"baked\":\"cow-$way.exr\"}" >"$out/cow-$way.json"
done
lamp='dir -0.6 0.9 0.9'
[ -e "$out/cow-fixed.exr" ] || "$relume" bake "$out/cow.json" -o "$out/cow-fixed.exr" --bounces 3 --light "$lamp" -q
description '{"baked":"cow-fixed.exr"}' >"$out/cow-fixed.json"
list=
shot() { # description, name, light
    "$relume" btf render "$out/$1.json" -o "$out/$2.exr" --picture 288x288 --eye 1.3,0.9,2.6 --look-at 0,-0.2,0 --fov 38 --light "$3" -q 2>/dev/null
    list="$list $out/$2.exr"
}
shot cow lamp "$lamp"
shot cow-fixed fixed "$lamp"
shot cow-table table "$lamp"
shot cow-sh sh "$lamp"
shot cow-sh sunset "env $sky/sunset.hdr"
shot cow-sh studio "env $sky/studio.hdr rgb .35 .35 .35"
"$draw" row "$pictures/baking.jpg" columns=6 $list
echo "  $pictures/baking.jpg"

# a leather cushion in light that stays, and its components
[ -d "$out/leather" ] || "$relume" synth --btf leather -o "$out/leather" --size 32 -q
awk 'BEGIN { n = 64; for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) { x = 2 * i / n - 1; y = 2 * j / n - 1; c = 0.42
        printf "v %.6f %.6f %.6f\nvt %.6f %.6f\nvn %.6f %.6f 1\n", x, y, c * (1 - x * x) * (1 - y * y), i / n, j / n,
            2 * c * x * (1 - y * y), 2 * c * y * (1 - x * x) }
    for (j = 0; j < n; j++) for (i = 0; i < n; i++) { a = j * (n + 1) + i + 1; b = a + n + 1
        printf "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, a + 1, a + 1, a + 1, b + 1, b + 1, b + 1, b, b, b } }' >"$out/cushion.obj"
description '{"mesh":"cushion.obj","parts":[{"material":"leather","repeat":4}]}' >"$out/cushion.json"
list=
for c in 2 4 8 16; do
    [ -e "$out/cushion-$c.exr" ] ||
        "$relume" bake "$out/cushion.json" -o "$out/cushion-$c.exr" --components $c --bounces 0 --light "env $sky/studio.hdr" \
            --light 'area 2.5 0.5 1.5 0 .4 0 -.2 0 .3 rgb 20 18 12' -q
    description "{\"baked\":\"cushion-$c.exr\"}" >"$out/cushion-$c.json"
    "$relume" btf render "$out/cushion-$c.json" -o "$out/cushion-$c-shown.exr" --picture 288x200 --eye -0.8,-2.2,2.2 --fov 36 -q
    list="$list $out/cushion-$c-shown.exr"
done
"$draw" row "$pictures/baking-cushion.jpg" columns=4 $list
echo "  $pictures/baking-cushion.jpg"
