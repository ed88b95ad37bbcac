#!/bin/sh
# Light on objects computed beforehand, from the command line: any light, fixed light, in a scene;
# options and files that are refused.
. "$(dirname "$0")/lib.sh"

awk -v n=12 -f "$TOP/scripts/ball.awk" >ball.obj
objects() { # the members of one object
    echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{$1}]}"
}
objects '"mesh":"ball.obj","parts":[{"material":{"diffuse":[0.8,0.4,0.2]}}]' >ball.json
objects '"baked":"any.exr","pose":{"scale":0.3,"translate":[0,-0.6,-1.4]}' >baked.json
objects '"baked":"any.exr"' >alone.json
small="--size 32x32 --rays 8"

expect_ok 'bake' - "$RELUME" bake ball.json -o any.exr $small --lights 128 -q
expect_ok 'the same again' - "$RELUME" bake ball.json -o again.exr $small --lights 128 -q --threads 1
check 'byte for byte' cmp any.exr again.exr
expect_ok '--coefficients' - "$RELUME" bake ball.json -o few.exr $small --coefficients 9 --lights 32 -q
expect_ok 'its old spelling' - "$RELUME" bake ball.json -o old.exr $small -k 9 --lights 32 -q
check 'says the same' cmp few.exr old.exr
check 'and help shows one of them' sh -c '"$0" bake --help | grep -q "^  --coefficients K" && ! "$0" bake --help | grep -q "^  -k"' "$RELUME"
expect_ok 'draw it' - "$RELUME" btf render alone.json -o any.pfm --picture 32x32 --light 'dir 0 1 1'
"$RELUME" btf render any.exr -o direct.pfm --picture 32x32 --light 'dir 0 1 1' -q
check 'the file itself, too' cmp any.pfm direct.pfm
"$RELUME" btf render alone.json -o a.exr --picture 32x32 --light 'dir 0 1 1' -q
"$RELUME" btf render ball.json -o b.exr --picture 32x32 --light 'dir 0 1 1' -q
check 'as the ball itself' sh -c "'$RELUME' compare a.exr b.exr | awk '/^rms/ { exit !(\$2 < 0.04) }'"
"$RELUME" bake ball.json -o fixed.exr $small --light fixed --light 'dir 1 0 0' --json -q >made.json
check 'fixed light' grep -q '"fixed": true.*"coefficients": 1,.*"views": 1,' made.json
objects '"baked":"fixed.exr"' >fixed.json
"$RELUME" btf render fixed.json -o a.exr --picture 32x32 --light 'dir 0 1 1' -q
"$RELUME" btf render fixed.json -o b.exr --picture 32x32 --light 'dir 0 0 1' -q
check 'stays' cmp a.exr b.exr
"$RELUME" info fixed.exr --json >info.json
sed -i 's/, "error".*//' info.json made.json # kept as a float
check 'info says what bake said' cmp info.json made.json
check 'and in lines' sh -c "'$RELUME' info any.exr | grep -q '^light *any; sh, 36 coefficients'"
for f in any.exr alone.json; do "$VIEWER" $f --size 16x16 --offscreen $f.png; done
check 'relume-view opens it, too' cmp any.exr.png alone.json.png
expect_fail 'it is not relit by itself' 1 'this is a baked object' x.png "$RELUME" relight any.exr -o x.png

"$RELUME" synth attic -q -o room --projection spherical --size 32 --lights 6 --samples 1
"$RELUME" encode -q room -o room.exr --shadows no
for way in none path; do
    expect_ok "in a scene, $way" - "$RELUME" relight room.exr --objects baked.json --tilt -20 --size 48x32 -o $way.exr --light 'dir 0 1 0' --transport $way --samples 16 -q
done
check 'light comes from the scene' sh -c "'$RELUME' compare none.exr path.exr | awk '/max_abs/ { exit !(\$2 > 0.02) }'"
expect_ok 'without a description' - "$RELUME" relight room.exr --objects any.exr -o x.png --size 32x32 -q
rm -f x.png

objects '"mesh":"ball.obj","parts":[{"material":{"mirror":1}}]' >mirror.json
expect_fail 'mirrors' 1 "part .* is a mirror" x.exr "$RELUME" bake mirror.json -o x.exr
expect_fail 'baked twice' 1 'is baked already' x.exr "$RELUME" bake alone.json -o x.exr
sed '/^vt/d; s|/[0-9]*/|//|g' ball.obj >plain.obj
objects '"mesh":"plain.obj","parts":[{"material":{"diffuse":1}}]' >plain.json
expect_fail 'an atlas of few texels' 1 'too small for .* charts' x.exr "$RELUME" bake plain.json -o x.exr --size 4x4
expect_fail 'any and fixed' 2 'takes no lights' x.exr "$RELUME" bake ball.json -o x.exr --light any --light 'dir 0 0 1'
expect_fail 'fixed has no basis' 2 'has no basis' x.exr "$RELUME" bake ball.json -o x.exr --light fixed --basis sh
expect_fail 'a cube of 5' 2 'expected 2, 4, 8, 16 or 32' x.exr "$RELUME" bake ball.json -o x.exr --haar 5
expect_fail 'learned bases' 2 'basis pca cannot hold light from all sides' x.exr "$RELUME" bake ball.json -o x.exr --basis pca
expect_fail 'no such light' 2 'expected' x.exr "$RELUME" bake ball.json -o x.exr --light 'lamp 1'
head -c 900 any.exr >cut.exr
objects '"baked":"cut.exr"' >cut.json
expect_fail 'a file cut short' 1 'cut.exr' x.png "$RELUME" btf render cut.json -o x.png
objects '"baked":"any.exr","parts":[]' >parts.json
expect_fail 'parts of a baked object' 1 "parts" x.png "$RELUME" btf render parts.json -o x.png
