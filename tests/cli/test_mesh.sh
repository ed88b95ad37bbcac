#!/bin/sh
# relume mesh: volumes, depth and models become meshes; what is refused.
. "$(dirname "$0")/lib.sh"

# a ball of radius 6 in 16^3 bytes, as octal escapes of awk
awk 'BEGIN {
    for (z = 0; z < 16; z++) for (y = 0; y < 16; y++) for (x = 0; x < 16; x++) {
        r = sqrt((x - 7.5) ^ 2 + (y - 7.5) ^ 2 + (z - 7.5) ^ 2)
        v = int(100 + 10 * (6 - r)); if (v < 1) v = 1
        printf "\\%03o", v
    }
}' >text
printf "$(cat text)" >ball.raw
gzip -k ball.raw
{ printf 'NRRD0004\ntype: uchar\ndimension: 3\nsizes: 16 16 16\nspacings: 0.5 0.5 2\nencoding: raw\n\n'; cat ball.raw; } >ball.nrrd

"$RELUME" mesh ball.raw --size 16x16x16 --threshold 100.5 -o ball.ply --json >json 2>err || not_ok 'mesh a raw volume' "$(cat err)"
check 'a closed surface: Euler number 2' test $(($(field vertices json) - $(field triangles json) / 2)) = 2
"$RELUME" mesh ball.raw.gz --size 16x16x16 --threshold 100.5 -o packed.ply -q
check 'packed samples give the same' cmp ball.ply packed.ply
"$RELUME" mesh ball.nrrd --threshold 100.5 -o nrrd.ply -q --threads 3
check 'NRRD gives the same, in samples' cmp ball.ply nrrd.ply
"$RELUME" mesh ball.nrrd --threshold 100.5 -o spaced.obj --spacing file -q
below 'its spacing, where it is asked for' "$(awk '$1 == "v" { if (!n++ || $4 < a) a = $4; if ($4 > b) b = $4 } END { d = b - a - 23.4; print d * d }' spaced.obj)" 0.04
expect_ok 'several sizes of boxes in one call' - "$RELUME" mesh ball.raw --size 16x16x16 --threshold 100.5 --block 1,2,4 -o set.glb -q
check 'one file each' test -s set.1.glb -a -s set.2.glb -a -s set.4.glb
expect_ok 'models are converted' - "$RELUME" mesh ball.ply -o again.obj -q
check 'with as many triangles' test "$(grep -c '^f' again.obj)" = "$(field triangles json)"

# ---- no surface, and no volume
"$RELUME" mesh ball.raw --size 16x16x16 --threshold 300 -o none.ply --json >json 2>err
check 'no surface is an empty mesh' test "$(field triangles json)" = 0 -a -s none.ply
check 'and is said' grep -q 'none reach it' err
expect_fail 'a wrong size' 1 '4096 bytes of samples; expected 3840' x.ply "$RELUME" mesh ball.raw --size 16x16x15 --threshold 100 -o x.ply
expect_fail 'a wrong type' 1 'expected 8192' x.ply "$RELUME" mesh ball.raw --size 16x16x16 --type u16be --threshold 100 -o x.ply
expect_fail 'no size' 2 'give --size XxYxZ' x.ply "$RELUME" mesh ball.raw --threshold 100 -o x.ply
"$RELUME" mesh ball.raw --size 16x16x16 -o own.ply 2>err && "$RELUME" mesh ball.raw --size 16x16x16 --threshold "$(sed -n 's/.* two kinds at \([0-9.]*\);.*/\1/p' err)" -o said.ply -q
check 'without a threshold: one of its own, said' cmp own.ply said.ply
expect_fail 'a size that is none' 2 'expected XxYxZ' x.ply "$RELUME" mesh ball.raw --size 16x16 --threshold 100 -o x.ply
expect_fail 'a block that is none' 2 'expected 1, 2, 4, 8 or 16' x.ply "$RELUME" mesh ball.raw --size 16x16x16 --threshold 100 --block 3 -o x.ply
expect_fail 'a format that is none' 2 'ends in .ply, .obj or .glb' x.stl "$RELUME" mesh ball.raw --size 16x16x16 --threshold 100 -o x.stl
expect_fail 'the input is not replaced' 2 'read' - "$RELUME" mesh ball.ply -o ball.ply
"$RELUME" mesh ball.raw --size 16x16x16 --threshold 90,100 --block 1,2 -o t.ply --json -q >json
check 'several thresholds' test -s t.90.1.ply -a -s t.90.2.ply -a -s t.100.2.ply
"$RELUME" mesh ball.raw --size 16x16x16 --threshold 100 -o one.ply -q && check 'each as alone' cmp one.ply t.100.1.ply
check 'in one list' test "$(grep -o '"threshold": 1*[09]0' json | wc -l)" = 4
expect_fail 'a threshold that comes twice' 2 'comes twice' x.ply "$RELUME" mesh ball.raw --size 16x16x16 --threshold 9,9 -o x.ply
expect_fail 'thresholds that are none' 2 'expected 1 to 64 numbers' x.ply "$RELUME" mesh ball.raw --size 16x16x16 --threshold 9, -o x.ply
head -c 4096 /dev/zero >zero.raw
expect_fail 'a constant volume' 1 'all samples are 0' x.ply "$RELUME" mesh zero.raw --size 16x16x16 --threshold 100 -o x.ply
head -c 300 ball.raw.gz >cut.raw.gz
expect_fail 'a truncated volume' 1 'ends too early' x.ply "$RELUME" mesh cut.raw.gz --size 16x16x16 --threshold 100 -o x.ply

# ---- depth
"$RELUME" synth box -o box --size 32 --views 2x2 --lights 4 --samples 1 -q
"$RELUME" encode box -o box.exr -q
# ... and its four photographs, as slices of a volume
mkdir floats words bytes
cp box/view00/light*.exr floats
"$mkimage" tiff 16 3 words box/view00/light*.exr
"$mkimage" png 8 3 bytes box/view00/light*.exr
for f in floats words bytes; do "$RELUME" mesh $f --threshold 0.1 -o $f.ply --json -q >$f.json 2>err || not_ok "slices: $f" "$(cat err)"; done
above 'a folder of slices' "$(field triangles floats.json)" 100
"$RELUME" mesh words --threshold 30000 -o words.ply --json -q >words.json
"$RELUME" mesh bytes --threshold 116.732 -o bytes.ply --json -q >bytes.json
below 'of 16 and of 8 bits, near to each other' "$(awk -v a="$(field triangles words.json)" -v b="$(field triangles bytes.json)" 'BEGIN { print (a / b - 1) ^ 2 }')" 0.01
cp ball.raw one.tif && printf 'II*\0' | dd of=one.tif conv=notrunc 2>/dev/null
expect_fail 'a broken TIFF' 1 'one.tif' x.ply "$RELUME" mesh one.tif --threshold 100 -o x.ply
expect_ok 'depth becomes a mesh' - "$RELUME" mesh box.exr -o box.ply -q
check 'with colours' grep -qa 'property uchar red' box.ply
"$RELUME" mesh box.exr -o plain.ply --no-colours --json --threads 2 >json
above 'of some triangles' "$(field triangles json)" 100
"$RELUME" mesh box.exr -o coarse.ply --voxel 0.2 --json -q >json2
below '--voxel makes it coarser' "$(field triangles json2)" "$(field triangles json)"
expect_ok 'which is an object' - "$RELUME" mesh box.ply -o box.obj -q
# ---- its colours as a picture, held against the relit views; and the mesh in the way of light
mkdir painted
"$RELUME" mesh box.exr -o painted/box.obj --texture 256 --json >json 2>err || not_ok 'a texture of the relit colours' "$(cat err)"
above 'it shows the views, dB' "$(field psnr_db json)" 24
above 'nearly all of them' "$(field shown json)" 0.95
check 'materials name the picture' grep -qx 'map_Kd box.png' painted/box.mtl
"$RELUME" mesh box.exr -o painted/dark.obj --texture 256 --light 'dir 0 0 1 rgb .1 .1 .1' -q
below 'in the light that is asked for' "$(psnr painted/box.png painted/dark.png)" 20
"$RELUME" mesh painted/box.obj -o painted/box.glb -q
check 'glTF holds it' grep -qa 'image/png' painted/box.glb
"$RELUME" mesh painted/box.obj -o painted/named.ply -q && "$RELUME" mesh painted/named.ply -o painted/again.glb -q
check 'PLY names it, and is read so' grep -qa 'image/png' painted/again.glb
cp painted/box.png card.png
expect_fail 'too few texels for all charts' 1 'too small for [0-9]+ charts' x.obj "$RELUME" mesh box.exr -o x.obj --texture 16
check 'and nothing beside it' test ! -e x.png -a ! -e x.mtl
expect_fail 'a texture without colours' 2 'expected one of them' x.obj "$RELUME" mesh box.exr -o x.obj --texture 64 --no-colours
printf 'v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\n' >card.obj
"$RELUME" mesh card.obj -o card.glb -q
check 'a picture that nobody names is no texture' sh -c '! grep -qa image/png card.glb'
card='{"mesh": "card.obj", "parts": [{"material": {"diffuse": 0.8}}]}'
printf '{"format": "relume-objects", "version": 1, "objects": [%s]}' "$card" >open.json
printf '{"format": "relume-objects", "version": 1, "objects": [%s, {"mesh": "painted/box.obj"}]}' "$card" >shut.json
behind='--eye 0,0,-0.1 --look-at 0,0,-1 --fov 40 --picture 16x16 -q'
for f in open shut; do "$RELUME" btf render $f.json -o $f.exr $behind --light 'dir 0 0 1'; done
"$RELUME" compare open.exr shut.exr --json >json
below 'a card behind it is in its shadow' "$(awk -v r="$(field rms json)" 'BEGIN { print (r - 0.8) ^ 2 }')" 1e-3
expect_fail 'nothing is near enough' 1 'none of the depth is finite' x.ply "$RELUME" mesh box.exr -o x.ply --farthest 0.1
"$sphere" flat --size 16 --lights 4 >/dev/null 2>&1 && "$RELUME" encode flat -o flat.exr --no-depth -q &&
    expect_fail 'a file without depth' 1 'no depth' x.ply "$RELUME" mesh flat.exr -o x.ply
finish
