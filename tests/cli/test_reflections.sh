#!/bin/sh
# Mirrors and edited reflections from the command line: a constraint that is printed changes
# nothing, another one does, in the tool as in the viewer; bad input.
. "$(dirname "$0")/lib.sh"

awk -v n=24 -f "$TOP/scripts/ball.awk" >ball.obj
objects='{"format":"relume-objects","version":1,"objects":[{"mesh":"ball.obj","parts":[{"material":{"mirror":1}}],
    "pose":{"scale":0.5,"translate":[0,0,-2]}}]}'
echo "$objects" >ball.json
edit() {
    echo "{\"format\":\"relume-reflections\",\"version\":1,\"edits\":[{\"constraints\":[$1]}]}"
}
"$RELUME" synth attic -q -o room --projection spherical --size 32 --lights 6 --samples 1
"$RELUME" encode -q room -o room.exr
look="--pan 0 --zoom 2 --size 48x32"
"$RELUME" relight room.exr --objects ball.json $look -o plain.exr --light 'dir 0 1 0' -q --reflection-at 24,12 >constraint.json || not_ok 'relight --reflection-at' ''
edit "$(cat constraint.json)" >same.json
"$RELUME" relight room.exr --objects ball.json --reflections same.json $look -o same.exr --light 'dir 0 1 0' -q
check 'a printed constraint changes nothing' sh -c "'$RELUME' compare plain.exr same.exr | awk '/max_abs/ { exit !(\$2 < 2e-3) }'"
edit "$(sed 's/"direction.*/"direction": [0, -1, 0]}/' constraint.json)" >down.json
"$RELUME" relight room.exr --objects ball.json --reflections down.json $look -o down.exr --light 'dir 0 1 0' --samples 1 -q
check 'another direction changes it' sh -c "'$RELUME' compare plain.exr down.exr | awk '/max_abs/ { exit !(\$2 > 0.02) }'"
"$VIEWER" room.exr --objects ball.json --reflections down.json $look --offscreen gl.exr --light 'dir 0 1 0' || not_ok 'relume-view --reflections' ''
check 'the viewer shows the same' sh -c "'$RELUME' compare down.exr gl.exr | awk '/psnr_db/ { exit !(\$2 > 35) }'"
"$RELUME" btf render ball.json -o alone.png --picture 16x16 --light 'dir 0 0 1' 2>warned.txt
check 'a mirror without surroundings is told' grep -q 'mirrors are black' warned.txt


# ---- by hand: what a script does with handles is kept, undone and shown by the tool
cat >hands.txt <<'SCRIPT'
light dir 0 1 0
frame bare.exr
reflection on
reflection tool ball
drag left 48 32 66 32
reflection border 0.3
reflection tool move
drag left 48 12 54 44
frame hands.exr
reflection save
reflection undo
reflection undo
reflection undo
frame undone.exr
reflection redo
reflection redo
reflection redo
frame redone.exr
SCRIPT
expect_ok 'a script edits reflections' - "$VIEWER" room.exr --objects ball.json --pan 0 --zoom 4 --size 96x64 --script hands.txt --offscreen shot.png
check 'they are kept beside the objects' grep -q '"ball"' ball.reflections.json
check 'edits by hand are seen' sh -c '! cmp -s bare.exr hands.exr'
check 'and undone to the bit' cmp -s bare.exr undone.exr
check 'and redone' cmp -s hands.exr redone.exr
"$RELUME" relight room.exr --objects ball.json --reflections ball.reflections.json --pan 0 --zoom 4 --size 96x64 -o tool.exr --light 'dir 0 1 0' --samples 1 -q
"$RELUME" relight room.exr --objects ball.json --pan 0 --zoom 4 --size 96x64 -o unedited.exr --light 'dir 0 1 0' --samples 1 -q
check 'the tool shows the same' sh -c "'$RELUME' compare tool.exr hands.exr | awk '/psnr_db/ { exit !(\$2 > 35) }'"
check 'which is not the unedited one' sh -c "'$RELUME' compare unedited.exr hands.exr | awk '/psnr_db/ { exit !(\$2 < 30) }'"
"$VIEWER" room.exr --objects ball.json --reflections ball.reflections.json --pan 0 --zoom 4 --size 96x64 --light 'dir 0 1 0' --offscreen again.exr
check 'the viewer shows what it saved' sh -c "'$RELUME' compare again.exr hands.exr | awk '/max_abs/ { exit !(\$2 < 1e-3) }'"
script_fails() { # name, pattern
    "$VIEWER" room.exr --objects "$3" --size 96x64 --script hands.txt --offscreen x.png 2>err.txt
    status=$?
    errors_of err.txt >only.txt
    if [ "$status" -eq 1 ] && [ "$(wc -l <only.txt)" -eq 1 ] && grep -q "^relume-view: hands.txt: line 1, .*$2" only.txt && [ ! -e x.png ]; then
        ok "$1"
    else
        not_ok "$1" "status $status; $(cat err.txt)"
    fi
}
echo "reflection save ball.json" >hands.txt
script_fails 'a file of something else is kept' 'ball.json: is no list of reflections, and is kept' ball.json
check 'and is whole' test "$objects" = "$(cat ball.json)"
echo "reflection save nowhere/edit.json" >hands.txt
"$VIEWER" room.exr --objects ball.json --size 96x64 --script hands.txt --offscreen x.png 2>err.txt
check 'a folder that is not there' test $? -eq 3
check 'is told with its place in the script' grep -q '^relume-view: hands.txt: line 1, .*nowhere/edit.json: cannot be written' err.txt
echo 'reflection save "a name.json"' >hands.txt
"$VIEWER" room.exr --objects ball.json --size 96x64 --script hands.txt --offscreen x.png
check 'a name with blanks' test -s 'a name.json'
rm -f x.png
echo "reflection tool hammer" >hands.txt
script_fails 'wrong words' 'tool move, ball, along or brush' ball.json
echo "reflection" >hands.txt
script_fails 'no words' 'expected reflection on' ball.json
"$RELUME" btf plant -o planted -q --size 8 --directions coarse
echo "reflection on" >hands.txt
"$RELUME" btf expand planted -o values -q && "$RELUME" btf fit values --model lit -o lit -q
echo "$objects" | sed 's/{"mirror":1}/"lit"/' >matte.json
script_fails 'objects without a mirror' 'one is a mirror' matte.json

expect_fail 'edits without objects' 2 'add --objects FILE' x.exr "$RELUME" relight room.exr --reflections down.json -o x.exr
expect_fail 'edits that are not there' 1 'none.json' x.exr "$RELUME" relight room.exr --objects ball.json --reflections none.json -o x.exr
expect_fail 'a pixel without an object' 2 'expected a pixel that shows an object' x.exr "$RELUME" relight room.exr --objects ball.json $look --reflection-at 0,0 -o x.exr
expect_fail 'edits for what is no description' 2 'expected a description of objects' x.png "$RELUME" btf render lit --reflections down.json -o x.png
echo "{\"format\":\"relume-reflections\",\"version\":1,\"edits\":[{\"constraints\":[]},{\"object\":0,\"constraints\":[]}]}" >twice.json
expect_fail 'two edits of an object' 1 'twice.json: edit 1: object 0 has an edit already' x.exr "$RELUME" relight room.exr --objects ball.json --reflections twice.json $look -o x.exr
"$VIEWER" room.exr --reflections down.json --offscreen x.png 2>err.txt
check 'edits without objects, in the viewer' grep -q 'add --objects FILE' err.txt
finish
