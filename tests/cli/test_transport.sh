#!/bin/sh
# Light between captured scenes and objects from the command line: what the ways do to a slab, a
# panorama and a panorama without depth; options; bad input.
. "$(dirname "$0")/lib.sh"

awk -v n=24 -f "$TOP/scripts/ball.awk" >ball.obj
objects() { # translate, material
    echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"ball.obj\",
        \"parts\":[{\"material\":$2}],\"pose\":{\"scale\":0.3,\"translate\":[$1]}}]}"
}
objects '0,-0.6,-1.4' '{"diffuse":[0.8,0.4,0.2]}' >ball.json
"$RELUME" synth attic -q -o room --projection spherical --size 32 --lights 6 --samples 1
"$RELUME" encode -q room -o room.exr --shadows no
look="--tilt -20 --size 48x32"
for way in none ssao ssdo ism radiosity micro path; do
    expect_ok "$way" - "$RELUME" relight room.exr --objects ball.json $look -o $way.exr --light 'dir 0 1 0' --transport $way -q
done
expect_ok 'none is what is done without' - "$RELUME" relight room.exr --objects ball.json $look -o without.exr --light 'dir 0 1 0' -q
check 'the same' cmp none.exr without.exr
check 'light goes between' sh -c "'$RELUME' compare none.exr path.exr | awk '/max_abs/ { exit !(\$2 > 0.02) }'"
expect_ok 'twice the same' - "$RELUME" relight room.exr --objects ball.json $look -o again.exr --light 'dir 0 1 0' --transport path --threads 1 -q
check 'byte for byte' cmp path.exr again.exr
expect_ok 'samples and bounces' - "$RELUME" relight room.exr --objects ball.json $look -o few.exr --transport path --samples 100 --bounces 0 -q
expect_ok 'at every pixel' - "$RELUME" relight room.exr --objects ball.json $look -o each.exr --light 'dir 0 1 0' --transport micro --spacing 1 --samples 100 -q
check 'nearly the same as at every fourth' sh -c "'$RELUME' compare each.exr micro.exr | awk '/^rms/ { exit !(\$2 > 0 && \$2 < 0.02) }'"

check 'by virtual lights' sh -c "'$RELUME' compare none.exr ism.exr | awk '/max_abs/ { exit !(\$2 > 0.02) }'"
check 'as exact shadows have it' sh -c "'$RELUME' compare radiosity.exr ism.exr | awk '/rms/ { exit !(\$2 < 0.02) }'"
expect_ok 'one light a pixel' - "$RELUME" relight room.exr --objects ball.json $look -o few.exr --transport ism --samples 1 --bounces 0 -q
expect_fail 'a million virtual lights' 1 'at most 4096 samples' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport ism --samples 15625
# a sheet that is open, one that is turned round, and one without area
corners='v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n'
printf "${corners}vn 0 -1 0\nf 1/1/1 2/2/1 3/3/1 4/4/1\n" >up.obj
printf "${corners}vn 0 1 0\nf 4/4/1 3/3/1 2/2/1 1/1/1\n" >down.obj
for sheet in up down; do
    objects '0,-0.6,-1.4' '{"diffuse":[0.8,0.4,0.2]}' | sed "s/ball.obj/$sheet.obj/" >$sheet.json
    expect_ok "a sheet: $sheet" - "$RELUME" relight room.exr --objects $sheet.json $look -o $sheet.exr --transport ism -q
done
check 'whichever way it is turned' sh -c "'$RELUME' compare up.exr down.exr | awk '/rms/ { exit !(\$2 < 0.002) }'"

# an object before the plane of a slab: it is lit from behind by what it stands before
"$RELUME" synth teapot -q -o slab --views 2x2 --size 24 --lights 6 --samples 1
"$RELUME" encode -q slab -o slab.exr --shadows no
objects '0,0,0.6' '{"diffuse":0.7}' >front.json
expect_ok 'a slab' - "$RELUME" relight slab.exr --objects front.json -o slab-ssdo.exr --transport ssdo -q

# a panorama without depth is far away, which is said once
"$RELUME" encode -q room -o far.exr --no-depth
expect_ok 'a far panorama' - "$RELUME" relight far.exr --objects ball.json $look -o far.png --transport ssdo
check 'is told' test "$(grep -c 'the panorama has no depth' err.txt)" = 1
objects '0,-0.6,-1.4' '{"mirror":1}' >mirror.json
expect_ok 'with a mirror in it' - "$RELUME" relight far.exr --objects mirror.json $look -o far.png --transport path -q
expect_fail 'without light between it needs depth' 1 'how far the scene is' x.png "$RELUME" relight far.exr --objects ball.json -o x.png

expect_fail 'a way that is none' 2 "unknown --transport 'sddo'; did you mean 'ssdo'\?" x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport sddo
expect_fail 'without objects' 2 'work only with --objects' x.png "$RELUME" relight room.exr -o x.png --transport path
expect_fail 'many rays a pixel' 2 'expected 1 to 16 rays' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --samples 17
expect_fail 'spacing of a way that shares directions' 2 '\-\-spacing works only with --transport micro and path' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport ssdo --spacing 2
expect_fail 'far apart' 2 'spacing' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport micro --spacing 17
expect_fail 'many bounces' 2 'bounces' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport path --bounces 17
for material in '{"diffuse":1.5}' '{"diffuse":"red"}' '{"diffuse":0.5,"mirror":1}' '{"diffuse":[1,1]}'; do
    objects '0,0,0' "$material" >bad.json
    expect_fail "material $material" 1 'bad.json: object 0: (diffuse|material): expected' x.png "$RELUME" relight room.exr --objects bad.json -o x.png
done
objects '0,0,0' '{"difuse":0.5}' >bad.json
expect_fail 'a misspelt material' 1 "unknown member 'difuse'; did you mean 'diffuse'\?" x.png "$RELUME" relight room.exr --objects bad.json -o x.png
finish
