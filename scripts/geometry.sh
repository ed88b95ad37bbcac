#!/bin/sh
# The picture of docs/geometry.md: a scanned teapot with boxes of 1, 4 and 8 samples, and the mesh of a
# slab's depth.
# geometry.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
# The scan is that of ../shared/data.
set -eu
relume=$1/relume draw=$1/samples/figures out=$2 pictures=$3
scan=$PWD/../shared/data/volumes/teapot_ct_256x256x178_u8.raw.gz
mkdir -p "$out" "$pictures"

render() { # name, turn, eye, look-at
    echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"$1.obj\",
        \"pose\":{\"rotate\":$2},\"parts\":[{\"material\":{\"diffuse\":[0.75,0.72,0.68]}}]}]}" >"$out/$1.json"
    "$relume" btf render "$out/$1.json" -o "$out/$1.exr" $3 --picture 320x240 \
        --light "dir .5 .8 .6 rgb 1.1 1.1 1.1" --light "dir -1 .2 .3 rgb .25 .25 .3" -q 2>/dev/null
}
# normals of corners are left out, so that triangles show
facets() { awk '$1 == "v" { print $1, $2, $3, $4; p[++n] = $2 " " $3 " " $4; next }
    $1 == "f" { split($2, a, "/"); split($3, b, "/"); split($4, c, "/")
        split(p[a[1]], u, " "); split(p[b[1]], v, " "); split(p[c[1]], w, " ")
        for (i = 1; i <= 3; i++) { d[i] = v[i] - u[i]; e[i] = w[i] - u[i] }
        print "vn", d[2] * e[3] - d[3] * e[2], d[3] * e[1] - d[1] * e[3], d[1] * e[2] - d[2] * e[1]
        print "f", a[1] "//-1", b[1] "//-1", c[1] "//-1" }' "$out/$1" >"$out/$2"; }

"$relume" mesh "$scan" --size 256x256x178 --threshold 50.5 --block 1,4,8 -o "$out/scan.obj" -q
for n in 1 4 8; do
    facets scan.$n.obj scan$n.obj
    render scan$n '[1,0,0,-90]' '--eye 128,330,500 --look-at 128,85,-128 --fov 28'
done
"$relume" synth teapot -o "$out/teapot" --size 256 --lights 12 --samples 4 -q --force
"$relume" encode "$out/teapot" -o "$out/teapot-depth.exr" -q
"$relume" mesh "$out/teapot-depth.exr" -o "$out/depth-smooth.obj" -q
facets depth-smooth.obj depth.obj
render depth '[0,1,0,0]' '--eye .8,1,3.2 --look-at 0,-.3,0 --fov 36'
"$draw" row "$pictures/geometry.jpg" columns=2 gain=1 "$out/scan1.exr" "$out/scan4.exr" "$out/scan8.exr" "$out/depth.exr"
echo "  $pictures/geometry.jpg"
