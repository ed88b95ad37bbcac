#!/bin/sh
# relume mesh billboards: quads and their picture for other programs, and objects that are shown so.
. "$(dirname "$0")/lib.sh"
# a cube
cat >box.obj <<'END'
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
v 0 1 0
v 1 1 0
v 1 1 1
v 0 1 1
f 1 2 3 4
f 8 7 6 5
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
END
"$RELUME" mesh billboards box.obj --error 0.01 -o far.obj --json -q >far.json 2>err.txt || not_ok 'obj' "$(cat err.txt)"
check 'a cube has six' [ "$(field billboards far.json)" = 6 ]
check 'of no error' [ "$(field error far.json)" = 0 ]
check 'whose texels are its area' [ "$(field texels far.json)" = $((6 * 200 * 200)) ]
check 'as quads' [ "$(grep -c '^f ' far.obj)" = 12 ]
check 'with a picture of four channels' [ "$(od -An -tu1 -j25 -N1 far.png | tr -d ' ')" = 6 ]
"$RELUME" mesh billboards box.obj --billboards 6 -o far.glb 2>err.txt || not_ok 'glb' "$(cat err.txt)"
check 'what is done is said' grep -q 'far.glb: 6 billboards' err.txt
check 'glTF cuts them out' grep -q '"alphaMode":"MASK"' far.glb
check 'and holds the picture' grep -q '"mimeType":"image/png"' far.glb
"$RELUME" mesh billboards box.obj --method greedy -o votes.obj --json -q >votes.json 2>err.txt || not_ok 'greedy' "$(cat err.txt)"
check 'six by votes too' [ "$(field billboards votes.json)" = 6 ]

expect_fail 'an error and a number' 2 'expected one of them' no.obj "$RELUME" mesh billboards box.obj --error 0.1 --billboards 3 -o no.obj
expect_fail 'a number by votes' 2 'of clusters only' no.obj "$RELUME" mesh billboards box.obj --method greedy --billboards 3 -o no.obj
expect_fail 'no surface' 1 'one point' no.obj sh -c "printf 'v 0 0 0\nf 1 1 1\n' >point.obj; \"$RELUME\" mesh billboards point.obj -o no.obj"
expect_fail 'a line' 1 'no triangle has an extent' no.obj sh -c "printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >line.obj; \"$RELUME\" mesh billboards line.obj -o no.obj"
expect_fail 'too many texels' 1 'expected larger texels' no.obj "$RELUME" mesh billboards box.obj --texel 0.00001 -o no.obj
expect_fail 'a truncated mesh' 1 'bad.obj: line' no.obj sh -c "head -c 40 box.obj >bad.obj; echo 'f 1 9 9' >>bad.obj; \"$RELUME\" mesh billboards bad.obj -o no.obj"
expect_fail 'another format' 2 'expected a name that ends' no.stl "$RELUME" mesh billboards box.obj -o no.stl
check 'no picture is left' [ ! -e no.png ]

for billboards in '' '"billboards": 0.01, '; do
    printf '{"format": "relume-objects", "version": 1, "objects": [{"mesh": "box.obj", %s"parts": [{"material": {"diffuse": 0.8}}]}]}' "$billboards" >box.json
    "$RELUME" btf render box.json -o "box${billboards:+-far}.png" --eye 3,2,4 --picture 96x96 --light 'dir 1 2 3' -q 2>/dev/null
done
above 'a cube of billboards looks like a cube' "$(psnr box.png box-far.png)" 34
finish
