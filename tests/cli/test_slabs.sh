#!/bin/sh
# Several slabs around an object: made, stored, looked at from anywhere, and refused where a command
# has nothing to do with them.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/format.sh"

pooled() { "$RELUME" eval "$1" "$2" --json -q | sed 's/.*"psnr_pooled_db": \([0-9.]*\).*/\1/'; }

# A block of twelve triangles: quick to make, with edges and a far side.
cat >block.obj <<OBJ
v -0.5 -0.9 -0.3
v 0.5 -0.9 -0.3
v 0.5 -0.9 0.3
v -0.5 -0.9 0.3
v -0.3 0.9 -0.4
v 0.4 0.9 -0.3
v 0.3 0.9 0.4
v -0.4 0.9 0.3
f 4 3 7 8
f 3 2 6 7
f 2 1 5 6
f 1 4 8 5
f 8 7 6 5
f 1 2 3 4
OBJ
synth() { out=$1; shift; relume synth bust --mesh block.obj -o $out --projection slab --size 48 --samples 2 "$@"; }

# Cameras 20 degrees apart: what a frame between them shows hangs on depth and blending.
printf '%s\n' '5 3 8' '-5 3 -8' '-8 2 4' '8 -2 -4' '0 -1 0' '1 9 1' >lights.txt
head -n 2 lights.txt >lamps.txt
light='dir 5 3 8'
synth ring --slabs 6 --views 4x2 --lights-from lights.txt || exit 1
relume encode ring -o ring.exr --basis table --bits 16 || exit 1

# ---- notes: the mouse finds places of the surface, which is within the block; by the tool they are X,Y,Z
printf '%s\n' 'size 640 480' 'key ctrl+n' 'shot none.png' 'click 163 48' 'shot none.png' 'click 350 240' 'click 390 260' 'key enter' 'shot line.png' >jot.txt
"$VIEWER" ring.exr --script jot.txt >jot.out 2>&1 || not_ok 'the viewer notes around an object' "$(cat jot.out)"
relume notes ring.exr --json >notes.json
check 'notes around an object lie on it' awk '{ gsub(/.*"places": /, ""); split($0, v, /[^-0-9.e]+/)
    for (i = 2; i <= 7; i += 3) { if (v[i] ^ 2 > 0.3 || v[i + 1] ^ 2 > 0.9 || v[i + 2] < 0.25 || v[i + 2] > 0.45) bad = 1 } print v[2], v[3], v[4]; exit bad || v[4] == "" }' notes.json
expect_ok 'the tool adds one, inside the file' - "$RELUME" notes ring.exr --add 'line 0,0,0 0.3,0.4,0' --embed
check 'both are there, in units of the object' grep -q '^n2 *line *0.5 units' out.txt
expect_ok 'the list comes out again' - "$RELUME" notes ring.exr --extract
rm ring.notes.json

# ---- eyes that were not captured, seen through the window of each slab: truth is what synth renders
for spread in 1.328 1.732; do # between the cameras of one slab, and where neighbours meet
    synth held$spread --slabs 6 --views 2x1 --spread $spread --lights-from lamps.txt
done
inside=$(pooled ring.exr held1.328)
above 'inside a slab' "$inside" 26
above 'the seam is as good as the inside' "$(pooled ring.exr held1.732)" \
    "$(echo "$inside" | awk '{ print $1 - 1 }')"

# ---- the same eye by a frame: straight before slab 1 it is that slab's window
relume relight ring.exr -o frame.exr --eye 2.5980762,1,1.5 --look-at 0,0,0 --light "$light"
relume relight ring.exr -o again.exr --eye 2.5980762,1,1.5 --light "$light"
same 'the middle is where an eye looks' frame.exr again.exr
relume relight ring.exr -o turned.exr --eye 2.5980762,1,1.5 --up 1,1,0 --fov 20 --light "$light"
differ 'another up and another field of view' turned.exr frame.exr
relume relight ring.exr -o cpu.exr --eye 2.5,1,1.4 --look-at 0.1,0.2,0 --up 0.1,1,0 --fov 25 --size 90x60 --light "$light"
"$VIEWER" ring.exr --offscreen gpu.exr --eye 2.5,1,1.4 --look-at 0.1,0.2,0 --up 0.1,1,0 --fov 25 --size 90x60 --light "$light"
above 'the viewer shows the same' "$(psnr gpu.exr cpu.exr)" 60
lens="--eye 2.5,1,1.4 --fov 25 --size 60x40 --aperture 0.6 --focus 0.4"
relume relight ring.exr -o cpu.exr $lens --light "$light"
"$VIEWER" ring.exr --offscreen gpu.exr $lens --light "$light"
above 'the viewer has the same lens' "$(psnr gpu.exr cpu.exr)" 60
"$RELUME" info ring.exr --json >info.txt
check 'info says how many, and version 2' grep -q '"version": 2.*"slabs": 6' info.txt

# ---- eyes that look past all grids: by depth they see what rendering shows, higher than any camera,
# where frames were black; what nobody sees is said
relume relight ring.exr -o cpu.exr --eye 0.4,4,1.1 --fov 30 --size 64x64 --light "$light"
"$VIEWER" ring.exr --offscreen gpu.exr --eye 0.4,4,1.1 --fov 30 --size 64x64 --light "$light" 2>said.txt
check 'the viewer says so' grep -q '^relume-view: [1-9][0-9]* % of the picture lies beyond the cameras' said.txt
above 'the viewer fills the same' "$(psnr gpu.exr cpu.exr)" 40 # hits differ by texels where cameras graze
expect_ok 'what no camera sees' '% of the picture is black: no camera sees what is there' "$RELUME" relight ring.exr -o near.exr --eye 0,3,3 --fov 50 --interpolate linear
synth higher --slabs 6 --views 1x2 --spread 2.6 --lights-from lamps.txt
above 'above the grids as rendered' "$(pooled ring.exr higher)" 27

# ---- a second reader finds the rays and the values of turned slabs in one set of codebooks, from
# cameras where no other slab has a say
relume encode ring -o sh.exr --basis sh --coefficients 4 --codebook 64 --share
tolerance=2e-5 lights="1,0.5,1 -0.3,-0.2,0.1"
for at in "9 24 20" "26 26 30"; do
    agree "view, x, y $at by another reader" sh.exr ${at%% *} "$("$decode" sh.exr $at)" ${at#* }
done

# ---- near lights and held-out lights are those of the world
expect_ok 'a near light' - "$RELUME" relight ring.exr -o near.exr --eye 0.5,0.1,-3 --light 'point 0 1 -2' -q
expect_ok 'sweep' - "$RELUME" sweep ring --basis sh --coefficients 1 --leave-out 3 -q

# ---- what does not go
expect_fail 'an eye without a view' 1 'sees nothing of the slabs' x.exr "$RELUME" relight ring.exr -o x.exr --eye 0,9,0.1 --interpolate linear -q
expect_fail 'a focus behind the eye' 2 'on or behind the eye; expected less than 3.16' y.exr "$RELUME" relight ring.exr -o y.exr --eye 1,0,3 --focus 4 -q
expect_ok 'looking without an eye' - "$RELUME" relight ring.exr -o turned.exr --look-at 0.2,0,0 -q
check 'turns the usual one' sh -c "'$RELUME' relight ring.exr -o usual.exr -q && ! cmp -s usual.exr turned.exr"
expect_fail 'looking there from a captured view' 2 'turn an eye; leave out --view' x.exr "$RELUME" relight ring.exr -o x.exr --view 0 --look-at 0,0,0 -q
expect_fail 'a ray beside all cameras' 1 'this ray is not in the file' - "$RELUME" query ring.exr --eye 9,0,0 --direction 0,0,1 -q
expect_fail 'export' 1 'slabs around an object' x.ptm "$RELUME" export ring.exr --to ptm -o x.ptm -q
synth one --views 2x1 --lights 1
expect_fail 'a capture of one slab' 1 'slabs; expected 6' - "$RELUME" eval ring.exr one -q
expect_fail 'five slabs' 2 '--slabs' x "$RELUME" synth bust -o x --slabs 5 --projection slab -q
finish
