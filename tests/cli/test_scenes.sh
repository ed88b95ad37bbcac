#!/bin/sh
# Scene files from the command line: captures and objects in one picture; what relight and info say
# of them; options that are of one file alone; bad input.
. "$(dirname "$0")/lib.sh"

awk -v n=24 -f "$TOP/scripts/ball.awk" >ball.obj
"$RELUME" synth attic -q -o room --projection spherical --size 32 --lights 6 --samples 1
"$RELUME" encode -q room -o room.exr --shadows no
"$RELUME" synth teapot -q -o pot --views 2x2 --size 24 --lights 6 --samples 1
"$RELUME" encode -q pot -o pot.exr --shadows no
scene() { # members besides format and captures
    echo '{"format":"relume-scene","version":1,"captures":[{"file":"room.exr"},
        {"file":"pot.exr","name":"the pot","pose":{"scale":0.5,"rotate":[0,1,0,30],"translate":[0,-0.7,-1.6]}}],
        "objects":[{"mesh":"ball.obj","name":"ball","pose":{"scale":0.2,"translate":[0.7,-0.8,-1.5]},
        "parts":[{"material":{"diffuse":0.7}}]}],"look_at":[0,-0.6,-1.6],"size":[48,32]'"$1}"
}
scene '' >scene.json
scene ',"eye":[0.1,0.2,0]' >eyed.json
scene ',"lights":["dir 0 1 0.3","dir 1 1 0 rgb 1 .5 .2"]' >lit.json

expect_ok 'a picture' - "$RELUME" relight scene.json -o a.exr --light 'dir 0 1 0.3' -q
check 'of its size' test "$("$RELUME" compare a.exr a.exr --json | grep -c '"max_abs": 0')" = 1
expect_ok 'by one thread' - "$RELUME" relight scene.json -o b.exr --light 'dir 0 1 0.3' --threads 1 -q
check 'byte for byte' cmp a.exr b.exr
expect_ok 'under the lights of the file' - "$RELUME" relight lit.json -o c.exr -q
expect_ok 'under the same by hand' - "$RELUME" relight scene.json -o d.exr -q --light 'dir 0 1 0.3' --light 'dir 1 1 0 rgb 1 .5 .2'
check 'is the same' cmp c.exr d.exr
expect_ok 'from another eye' - "$RELUME" relight scene.json -o e.exr -q --eye 0.3,0.2,0.1 --look-at 0,-0.6,-1.6 --fov 60 --size 40x
expect_ok 'with the eye of the file turned' - "$RELUME" relight eyed.json -o t.exr -q --look-at 0.3,-0.5,-1.6 --fov 60 --up 0.1,1,0
check 'as if it were named' sh -c "'$RELUME' relight scene.json -o n.exr -q --eye 0.1,0.2,0 --look-at 0.3,-0.5,-1.6 --fov 60 --up 0.1,1,0 && cmp t.exr n.exr"
expect_ok 'in the viewer, too' - "$VIEWER" eyed.json --offscreen t.exr --look-at 0.3,-0.5,-1.6 --fov 60 --up 0.1,1,0
check 'byte for byte' cmp t.exr n.exr
expect_fail 'a panorama, which has no eye to turn' 2 'turn the eye of slabs and scene files' x.exr "$RELUME" relight room.exr -o x.exr --look-at 0,0,-1
expect_ok 'with light between' - "$RELUME" relight scene.json -o f.exr -q --light 'dir 0 1 0.3' --transport ssdo
check 'which changes it' sh -c "'$RELUME' compare a.exr f.exr | awk '/max_abs/ { exit !(\$2 > 0.01) }'"
expect_ok 'an environment' - "$RELUME" relight scene.json -o g.png -q --light 'area 0 1 -1 0.3 0 0 0 0 0.3' --samples 1

for material in '{"translucent":{"preset":"wax","scale_mm":100}}' '{"mirror":1}'; do
    sed "s/{\"diffuse\":0.7}/$material/" scene.json >other.json
    expect_ok "$material" - "$RELUME" relight other.json -o h.exr -q --light 'dir 0 1 0.3'
    check 'is another' sh -c "! cmp -s a.exr h.exr"
    expect_ok "$material, light between" - "$RELUME" relight other.json -o h.exr -q --light 'dir 0 1 0.3' --transport ssdo
done

sed 's/{"diffuse":0.7}/{"translucent":{"preset":"wax","scale_mm":1e-6}}/' scene.json >tiny.json
expect_ok 'a body smaller than the way of light in it' 'object 0 is 4e-07 mm long, and light goes .* it will look black' "$RELUME" relight tiny.json -o h.exr --light 'dir 0 1 0.3'

expect_ok 'info' - "$RELUME" info scene.json
check 'names what is in it' grep -q 'capture       the pot: slab, 4 views of 24 x 24 pixels' out.txt
check 'and objects' grep -q 'object        ball: ' out.txt
expect_ok 'info for programs' - "$RELUME" info scene.json --json
check 'has all of it' grep -q '"name": "ball", "kind": "mesh", "triangles": ' out.txt

scene ',"lights":[]' >dark.json
expect_ok 'a scene without lights' - "$RELUME" relight dark.json -o dark.exr -q
check 'is black' sh -c "'$RELUME' relight scene.json -o black.exr --light 'dir 0 1 0 rgb 0 0 0' -q && cmp dark.exr black.exr"
expect_ok 'in the viewer, too' - "$VIEWER" dark.json --offscreen viewed.exr
check 'byte for byte' cmp dark.exr viewed.exr
expect_ok 'an eye within an object' 'the eye is within object 0' "$RELUME" relight scene.json -o in.exr --eye 0.7,-0.8,-1.5
expect_ok 'one without' - "$RELUME" relight scene.json -o in.exr --eye 0.7,-0.3,-1.5
check 'hears nothing of it' sh -c '! grep -q within err.txt'
sed 's/{"diffuse":0.7}/{}/' scene.json >nothing.json
expect_fail 'a material that is none' 1 'expected one of diffuse, mirror and translucent' x.png "$RELUME" relight nothing.json -o x.png

# the viewer: the picture of relight, an eye and lights that move, files one after the other
expect_ok 'the viewer shows it' - "$VIEWER" lit.json --offscreen viewed.exr
check 'byte for byte' cmp viewed.exr c.exr
expect_ok 'with light between, from elsewhere' - "$VIEWER" scene.json --offscreen viewed.exr --light 'dir 0 1 0.3' --transport ssdo --eye 0.3,0.2,0.1 --fov 60 --size 40x30
"$RELUME" relight scene.json -o want.exr -q --light 'dir 0 1 0.3' --transport ssdo --eye 0.3,0.2,0.1 --fov 60 --size 40x30
check 'byte for byte, too' cmp viewed.exr want.exr
cat >moves.txt <<END
drag left 10 10 16 12
wait
frame turned.exr
key ctrl+up
key ctrl+right
frame walked.exr
drag right 10 10 20 10
frame lit.exr
key ctrl+t
frame way.exr
transport difference none
frame apart.exr
key tab
shot panel.png
open room.exr
frame room.png
open scene.json
frame again.exr
open ball.json
frame ball.png
END
printf '{"format":"relume-objects","version":1,"objects":[{"mesh":"ball.obj","parts":[{"material":{"diffuse":0.7}}]}]}' >ball.json
expect_ok 'a script' - "$VIEWER" scene.json --script moves.txt
before=a.exr
for name in turned walked lit way apart again; do
    check "$name: another picture" sh -c "! cmp -s $before $name.exr"
    before=$name.exr
done
check 'which has something in it' sh -c "'$RELUME' compare walked.exr lit.exr | awk '/^rms/ { exit !(\$2 > 0.001 && \$2 < 1) }'"
sed 's/room.exr/gone.exr/' scene.json >gone.json
refuse 'the viewer looks by an eye' 2 'leave out --pan' "$VIEWER" scene.json --offscreen x.png --pan 3
refuse 'with objects of the scene' 2 'leave out --objects' "$VIEWER" scene.json --offscreen x.png --objects ball.json
refuse 'the viewer, an eye that looks nowhere' 2 'the eye stands where it looks' "$VIEWER" scene.json --offscreen x.png --eye 1,1,1 --look-at 1,1,1
refuse 'the viewer, a scene that is none' 1 'gone.exr: no such file' "$VIEWER" gone.json --offscreen x.png

expect_fail 'an option of one file' 2 'leave out --objects' x.png "$RELUME" relight scene.json -o x.png --objects scene.json
expect_fail 'a pass' 2 'leave out --pass' x.png "$RELUME" relight scene.json -o x.png --pass normals
expect_fail 'an eye that looks nowhere' 2 'stands where it looks' x.png "$RELUME" relight scene.json -o x.png --eye 1,1,1 --look-at 1,1,1
expect_fail 'an eye far off' 2 'within 1e\+15' x.png "$RELUME" relight scene.json -o x.png --eye 1e20,0,0
expect_fail 'bounces without light between' 2 'only with --transport' x.png "$RELUME" relight scene.json -o x.png --bounces 3
sed 's/room.exr/scene.json/' scene.json >itself.json
expect_fail 'a scene in a scene' 1 "'scene.json' is a scene file itself" x.png "$RELUME" relight itself.json -o x.png
expect_fail 'a file that is not there' 1 'gone.exr: no such file' x.png "$RELUME" relight gone.json -o x.png
sed 's/"captures"/"captrues"/' scene.json >wrong.json
expect_fail 'a member that is none' 1 "did you mean 'captures'" x.png "$RELUME" relight wrong.json -o x.png
sed 's/\[0,1,0,30\]/[1,0,0,30]/' scene.json >tilted.json
expect_ok 'a capture that lies on its back' - "$RELUME" relight tilted.json -o x.png -q --light 'dir 0 1 0'
rm -f x.png
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\200\200\200\201\200\200\200\201' >sky.hdr
expect_fail 'takes no sky' 1 "capture 'the pot', which is turned about another axis than y" x.png "$RELUME" relight tilted.json -o x.png -q --light 'env sky.hdr'
expect_fail 'other commands' 1 "a scene file, which 'relume relight' and 'relume info' open" x.png "$RELUME" export scene.json -o x.ptm
finish
