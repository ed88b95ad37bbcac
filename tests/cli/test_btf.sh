#!/bin/sh
# Materials measured, described, fitted, compared; what is refused.
. "$(dirname "$0")/lib.sh"
expect_ok 'measure a material' - "$RELUME" synth --btf wallpaper -o paper --size 8 --directions coarse --samples 1 --bounces 0 -q
"$RELUME" info paper 2>/dev/null && not_ok 'info is for files' 'a folder was taken'
"$RELUME" btf info paper --json >info.json
for f in 'width 8' 'views 19' 'raw_bytes 138624'; do
    set -- $f
    if [ "$(field "$1" info.json)" = "$2" ]; then ok "btf info $1"; else not_ok "btf info $1" "$(cat info.json)"; fi
done
if grep -q '"includes_cosine": true' paper/btf.json; then ok 'values include n.l'; else not_ok 'values include n.l' "$(head -4 paper/btf.json)"; fi

# ---- every model: fitted, opened again, judged; compare says the same
"$RELUME" btf compare paper --pictures 2 --json -q >compare.json 2>err.txt || not_ok 'btf compare' "$(cat err.txt)"
for m in lit bump laf slaf rfp rfnl rfnlc cmf vpca lpca fmf qmf; do
    row=$(grep -o "{\"model\": \"$m\"[^}]*}" compare.json)
    for f in mae_avg mae_min mae_max rms delta_e bytes bytes_per_texel fit_seconds ops fetches light_ops light_fetches evaluations_per_second frames_per_second; do
        case $row in *"\"$f\": "[0-9]*) ;; *) not_ok "compare $m has $f" "$row" ;; esac
    done
done
ok 'btf compare has every model'
for m in rfnl lpca qmf; do
    expect_ok "btf fit $m" - "$RELUME" btf fit paper --model $m -o $m -q
    "$RELUME" btf eval $m paper --pictures 2 --json >eval.json 2>err.txt
    grep -o "{\"model\": \"$m\"[^}]*}" compare.json >row.json
    below "btf eval $m is compare's" "$(awk -v a="$(field rms eval.json)" -v b="$(field rms row.json)" 'BEGIN { print (a - b) ^ 2 }')" 1e-12
    "$RELUME" btf info $m --json >info.json
    if [ "$(field bytes info.json)" = "$(field bytes row.json)" ]; then ok "btf info $m"; else not_ok "btf info $m" "$(cat info.json)"; fi
done
"$RELUME" btf compare paper --models vpca --leave-out 4 --pictures 0 --json -q >out.json 2>err.txt
above 'left out is worse' "$(field left_out_rms out.json)" "$(field rms out.json)"
expect_ok 'btf fit without every fourth direction' - "$RELUME" btf fit paper --model vpca --leave-out 4 -o part -q
"$RELUME" btf eval part paper --unseen --pictures 0 --json >unseen.json 2>err.txt
below 'btf eval --unseen is what compare leaves out' "$(awk -v a="$(field rms unseen.json)" -v b="$(field left_out_rms out.json)" 'BEGIN { print (a - b) ^ 2 }')" 1e-12
expect_fail 'nothing unseen' 1 'the model was fitted to all directions.*--leave-out' - "$RELUME" btf eval rfnl paper --unseen
"$RELUME" btf eval rfnl paper --pictures 0 >eval.txt
check 'what was not measured is a dash' sh -c '! grep -q nan eval.txt && grep -q "  -  " eval.txt'
expect_ok 'btf fit --ratio' - "$RELUME" btf fit paper --model qmf --ratio 20 -o small -q
"$RELUME" btf info small --json >info.json
below 'a wanted ratio is kept' "$(field bytes info.json)" $((138624 / 20 + 1))
"$RELUME" synth --btf wallpaper -o again --size 8 --directions coarse --samples 1 --bounces 0 --threads 3 -q
if diff -r paper again >/dev/null; then ok 'the same for any threads'; else not_ok 'the same for any threads' "$(diff -rq paper again)"; fi

# ---- a measured pair, shown, is the measured picture
expect_ok 'btf render' - "$RELUME" btf render paper -o shown.exr --light 'dir 0 0 1' -q
at=$("$mkimage" read shown.exr 2 3)
expect_ok 'btf render a model' - "$RELUME" btf render lpca -o model.exr --eye 0.3,0,1 --light 'dir 1 0 1' --light 'dir 0 1 1 rgb 1 0 0' -q
expect_ok 'a light that is near' - "$RELUME" btf render paper -o near.exr --light 'point 0.5 0 1' -q
expect_fail 'an area light' 2 'area lights are not drawn' x.exr "$RELUME" btf render paper -o x.exr --light 'area 0 0 1 1 0 0 0 1 0'

# ---- levels, surfaces, environments
expect_ok 'levels of detail' - "$RELUME" btf fit paper --model rfp --levels 3 -o levels -q
"$RELUME" btf info levels --json >info.json
if [ "$(field levels info.json)" = 3 ] && [ -f levels/level2/model.json ]; then ok 'three levels'; else not_ok 'three levels' "$(cat info.json)"; fi
expect_ok 'all levels of detail' - "$RELUME" btf fit paper --model lit --levels -1 -o levels-all -q
check 'down to one texel' test -f levels-all/level3/model.json -a ! -e levels-all/level4
expect_ok 'measure with the faults of an apparatus' - "$RELUME" synth --btf wallpaper -o worn --size 8 --directions coarse --samples 1 --bounces 0 --blur 1 --noise 0.02 --shift 0.5 --flicker 0.03 -q
check 'faults change the values' sh -c '! cmp -s paper/values.npy worn/values.npy'
"$RELUME" synth --btf leather -o hide --size 16 --extent 2 --directions coarse --samples 1 --bounces 0 -q
expect_ok 'btf tile' - "$RELUME" btf tile hide -o wide --model rfp --tile 16 --tiles 3 --matrix 5x4 --force -q
"$RELUME" btf info wide --json >info.json
for f in 'width 80' 'height 64' 'tiles 3' 'levels 5'; do
    set -- $f
    if [ "$(field "$1" info.json)" = "$2" ]; then ok "surface: $1"; else not_ok "surface: $1" "$(cat info.json)"; fi
done
"$RELUME" btf tile hide -o wide1 --model rfp --tile 16 --tiles 3 --matrix 5x4 --threads 1 --json -q >tile.json
below 'cuts show less than unrelated texels' "$(field step_across tile.json)" "$(field step_unrelated tile.json)"
if diff -r wide wide1 >/dev/null; then ok 'tiles for any threads'; else not_ok 'tiles for any threads' "$(diff -rq wide wide1)"; fi
"$RELUME" btf render hide -o sky.exr --picture 64x32 -q
"$mkimage" poke sky.exr odd.exr 3 4 nan
expect_ok 'an environment' - "$RELUME" btf render wide -o lit.exr --light 'env sky.exr 30' --light 'dir 0 0 1' -q
"$RELUME" btf render wide -o odd-lit.exr --light 'env odd.exr' -q 2>err.txt
if grep -q '3 pixels are negative, not finite' err.txt; then ok 'NaN in an environment is reported'; else not_ok 'NaN in an environment is reported' "$(cat err.txt)"; fi
expect_fail 'no environment' 1 'nothing.hdr: no such file' x.exr "$RELUME" btf render wide -o x.exr --light 'env nothing.hdr'
{ printf '\223NUMPY\001\000v\000'; printf '%-117s\n' "{'descr': '<u2', 'fortran_order': False, 'shape': (1, 2), }"; printf '\001\000\100\000'; } >large.npy
expect_ok 'a surface from a camera' - "$RELUME" btf render wide -o view.png --camera 0,-1.5,0.7 --picture 64x40 --light 'dir -1 0 1' --light 'spot 0 1 1 0 -1 -1 30' -q
expect_ok 'an index map' - "$RELUME" btf tile levels -o same --map wide/matrix.npy -q
expect_fail 'an index map of a larger sample' 1 'expected a texel of 8 x 8; found number' x "$RELUME" btf tile levels -o x --map large.npy
expect_fail 'a sample smaller than a patch' 1 'expected a sample of at least 16 x 16 texels; found 8 x 8' x "$RELUME" btf tile levels -o x
expect_fail 'tiles of an odd side' 2 'multiple of 8 from 16 to 4096; found 20' x "$RELUME" btf tile hide -o x --tile 20
expect_fail 'eye and camera' 2 'expected --eye or --camera; found both' x.exr "$RELUME" btf render wide -o x.exr --eye 0,0,1 --camera 0,0,1
fresh wide other
truncate -s -1 other/texel.npy
expect_fail 'a truncated surface' 1 'other/texel.npy: expected 1536 bytes of values; found 1535' - "$RELUME" btf info other
fresh wide other
sed -i 's/"tiles": 3/"tiles": 2/' other/surface.json
expect_fail 'fewer tiles than in the array' 1 'other/texel.npy: not the array that surface.json implies' - "$RELUME" btf info other
fresh wide other
rm -r other/model
expect_fail 'a surface without its model' 1 'other/model/model.json' - "$RELUME" btf info other
fresh wide other
rm other/surface.json
expect_fail 'a surface without its head' 1 'expected btf.json' - "$RELUME" btf info other

# ---- objects: alone, and in a relit scene; the viewer shows what the reference does
cat >quad.obj <<'OBJ'
v -0.3 -0.3 0.3
v 0.3 -0.3 0.3
v 0.3 0.3 0.3
v -0.3 0.3 0.3
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 0 0 1
f 1/1/1 2/2/1 3/3/1 4/4/1
OBJ
echo '{"format":"relume-objects","version":1,"objects":[{"mesh":"quad.obj","parts":[{"material":["rfnl","lpca"],"repeat":2}]}]}' >quad.json
expect_ok 'btf render --mesh' - "$RELUME" btf render rfnl --mesh quad.obj --repeat 2 -o quad.exr --eye 0,0,2 --light 'dir 0.3 0.2 1' --picture 40x40 -q
expect_ok 'btf render a description' - "$RELUME" btf render quad.json -o again.exr --eye 0,0,2 --light 'dir 0.3 0.2 1' --picture 40x40 -q
check 'a mesh and its description are the same' cmp quad.exr again.exr
"$VIEWER" quad.json --eye 0,0,2 --light 'dir 0.3 0.2 1' --size 40x40 --offscreen stage.png 2>err.txt || not_ok 'relume-view of objects' "$(cat err.txt)"
"$VIEWER" rfnl --mesh quad.obj --repeat 2 --eye 0,0,2 --light 'dir 0.3 0.2 1' --size 40x40 --offscreen mesh.png 2>err.txt || not_ok 'relume-view --mesh' "$(cat err.txt)"
check 'relume-view of a mesh and its description' cmp stage.png mesh.png
expect_ok 'btf render of the same' - "$RELUME" btf render quad.json -o cpu.png --eye 0.5,0,2 --light 'dir 0.3 0.2 1' --picture 60x40 --samples 1 -q
"$VIEWER" quad.json --eye 0.5,0,2 --light 'dir 0.3 0.2 1' --size 60x40 --offscreen gl.png
above 'relume-view of objects from an eye is the reference' "$("$RELUME" compare cpu.png gl.png | sed -n 's/^psnr_db *//p')" 45
printf 'open lpca\nlight dir 0.3 0.2 1\nframe lpca.png\nopen quad.json\nlight dir 0.3 0.2 1\nframe first.png\n' >open.txt
"$VIEWER" rfnl --mesh quad.obj --repeat 2 --size 40x40 --script open.txt 2>err.txt || not_ok 'a script opens objects' "$(cat err.txt)"
printf 'light dir 0.3 0.2 1\nframe second.png\n' >stay.txt
"$VIEWER" quad.json --size 40x40 --script stay.txt
check 'objects that are opened later are the same' cmp first.png second.png
if cmp -s lpca.png first.png; then not_ok 'a script opens a material' 'nothing changed'; else ok 'a script opens a material'; fi
expect_ok 'a material by itself' - "$VIEWER" rfnl --light 'dir 0.3 0.2 1' --size 40x40 --offscreen cushion.png
printf 'light dir 0.3 0.2 1\nframe later.png\n' >stay.txt
"$VIEWER" --material rfnl --material lpca --size 40x40 --script stay.txt
check 'is on the cushion of --material' cmp cushion.png later.png
"$VIEWER" quad.obj --material rfnl --offscreen x.png 2>err.txt
check 'a scene and a material' grep -qx 'relume-view: --material: expected --mesh, for an object in a scene' err.txt
"$VIEWER" --repeat 2 --offscreen x.png 2>err.txt
check 'nothing to repeat' grep -q 'repeat: expected a material' err.txt
expect_fail 'a material is no scene' 1 "rfnl: this is a measured material; .*see it: relume-view rfnl" x.png "$RELUME" relight rfnl -o x.png
"$RELUME" synth box -o box --size 40 --views 2x2 --lights 12 --samples 1 -q && "$RELUME" encode box -o box.exr -q
for light in 'dir 0.4 0.3 1' 'point 0.4 0.3 1.5'; do
    "$RELUME" relight box.exr --objects quad.json -o cpu.png --light "$light" -q 2>err.txt || not_ok 'relight --objects' "$(cat err.txt)"
    "$VIEWER" box.exr --objects quad.json --light "$light" --size 40x40 --offscreen gl.png 2>err.txt || not_ok 'relume-view --objects' "$(cat err.txt)"
    "$RELUME" relight box.exr -o bare.png --light "$light" -q
    above "the viewer's is the reference's, $light" "$("$RELUME" compare cpu.png gl.png | sed -n 's/^psnr_db *//p')" 32
    below "the object is seen, $light" "$("$RELUME" compare cpu.png bare.png | sed -n 's/^psnr_db *//p')" 30
done
sed 's/"material"/"part":"lid","material"/' quad.json >bad.json
head -c 100 paper/values.npy >broken.glb
expect_fail 'a part without material' 1 "part 'all' has no material" x.exr "$RELUME" relight box.exr --objects bad.json -o x.exr
expect_fail 'objects in a pass' 2 'can be shown in colour only; leave out --pass' x.exr "$RELUME" relight box.exr --objects quad.json --pass normals -o x.exr
expect_fail 'no such mesh' 1 'nothing.obj: cannot be opened' x.exr "$RELUME" btf render rfnl --mesh nothing.obj -o x.exr
expect_fail 'no model at all' 1 'broken.glb: cannot be read as a 3D model' x.exr "$RELUME" btf render rfnl --mesh broken.glb -o x.exr

# ---- files of Bonn
mkubo="$BUILD/tests/tools/mkubo"
"$mkubo" bump.btf dfmf 12 coarse && "$mkubo" together.btf fmf 12 coarse
expect_ok 'btf info of a file of Bonn' - env TMPDIR=/nowhere "$RELUME" btf info bump.btf --json
for f in 'width 12' 'height 12' 'lights 19' 'raw_bytes 311904'; do
    set -- $f
    if [ "$(field "$1" out.txt)" = "$2" ]; then ok "file of Bonn: $1"; else not_ok "file of Bonn: $1" "$(cat out.txt)"; fi
done
expect_ok 'the other kind is read' - "$RELUME" btf render together.btf -o together.exr --light 'dir 0 1 0.5' -q
expect_ok 'a file of Bonn is shown' - "$RELUME" btf render bump.btf -o bump.exr --light 'dir 0 1 0.5' -q
above 'y is up: the upper edge faces the light' "$("$mkimage" read bump.exr 6 2 | cut -d' ' -f1)" 0.5
below 'and the lower one does not' "$("$mkimage" read bump.exr 6 9 | cut -d' ' -f1)" 0.1
expect_ok 'a part of it' - "$RELUME" btf render bump.btf -o part.exr --light 'dir 0 1 0.5' --crop 4,1,5,3 -q
if [ "$("$mkimage" read bump.exr 6 2)" = "$("$mkimage" read part.exr 2 1)" ]; then ok 'a part is that part'; else not_ok 'a part is that part' "$("$mkimage" read part.exr 2 1)"; fi
expect_ok 'fitted' - "$RELUME" btf fit bump.btf -o bump --model lpca -q
expect_ok 'judged' - "$RELUME" btf eval bump bump.btf --pictures 0 --json
below 'fitted well' "$(field rms out.txt)" 0.001
expect_ok 'compared' - "$RELUME" btf compare bump.btf --models rfnl,vpca --pictures 0 --json -q
expect_fail 'no room' 3 'bump.btf: no room for 0.00029 GiB of temporary data in /nowhere' x.exr env TMPDIR=/nowhere "$RELUME" btf render bump.btf -o x.exr
expect_fail 'a part outside' 2 'bump.btf: a part of 5 x 3 texels at 8, 1; expected one of 12 x 12' - "$RELUME" btf info bump.btf --crop 8,1,5,3
expect_fail 'a part of nothing' 2 "crop: expected four numbers x,y,w,h; found '1,2,3'" - "$RELUME" btf info bump.btf --crop 1,2,3
expect_fail 'a part of a folder' 2 'paper: expected a .btf file to take a part of' - "$RELUME" btf info paper --crop 0,0,1,1
expect_fail 'a part of a material' 2 "crop: expected a .btf file; found 'stone'" - "$RELUME" btf info stone --crop 0,0,1,1
head -c 9000 bump.btf >short.btf
expect_fail 'cut off' 1 'short.btf: ends within its values; expected [0-9]* bytes more; found' - "$RELUME" btf info short.btf
sed 's/^!DFMF08FCR/!PVF06FCR /' bump.btf >view.btf
expect_fail 'another kind of Bonn' 1 'view.btf: views factored each by itself \(PVF\) are not read' - "$RELUME" btf info view.btf
cp bump.exr bump.pic
expect_fail 'no file of Bonn' 1 'bump.pic: not a BTF of Bonn; expected a folder, or a file that begins with' - "$RELUME" btf info bump.pic

# ---- from outside: NumPy reads the values in place
if /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    check 'NumPy reads the values' /usr/bin/python3 -c '
import numpy, sys
v = numpy.load("paper/values.npy", mmap_mode="r")
assert v.shape == (19, 19, 8, 8, 3) and v.dtype == numpy.float16 and 0 < v.astype("f4").mean() < 1
assert abs(float(sys.argv[1]) - v[0, 0, 3, 2, 0]) < 1e-6' "$(echo "$at" | cut -d' ' -f1)"
else
    skip 'NumPy reads the values' 'no NumPy here'
fi

# ---- refused
expect_fail 'unknown material' 2 "unknown material 'ston'; did you mean 'stone'" x "$RELUME" synth --btf ston -o x
printf '0 0 1\n0.6 0 -0.8\n0 0.6 0.8\n-0.6 0 0.8\n' >below.txt
expect_fail 'a direction from below' 1 'below.txt: direction 1: expected a unit vector with z > 0' x "$RELUME" synth --btf stone --directions below.txt -o x
expect_fail 'two directions' 1 'two.txt: directions: expected 3 or more' x sh -c 'head -1 below.txt >two.txt; sed -n 3p below.txt >>two.txt; exec "$0" synth --btf stone --directions two.txt -o x' "$RELUME"
expect_fail 'a scene without a lens' 2 'of --btf MATERIAL; found a scene' x "$RELUME" synth box --blur 1 -o x
expect_fail 'a lamp that is dark' 2 'flicker' x "$RELUME" synth --btf stone --flicker 2 -o x
expect_fail 'scene and material' 2 'found both' x "$RELUME" synth box --btf stone -o x
expect_fail 'unknown model' 2 "unknown --models 'rfnk'" - "$RELUME" btf compare paper --models rfnk
expect_fail 'no model' 2 '--models: expected a value .*found an empty one' - "$RELUME" btf compare paper --models ''
expect_fail 'unknown task' 2 "unknown task 'fitt'; did you mean 'fit'" - "$RELUME" btf fitt paper
expect_fail 'too many clusters' 2 'expected 1 to 64 clusters; found 65' x "$RELUME" btf fit paper --model rfnlc --clusters 65 -o x
expect_fail 'a ratio below 1' 2 'ratio' x "$RELUME" btf fit paper --model qmf --ratio 0 -o x
expect_fail 'no BTF' 1 'expected btf.json, or pictures named like' - "$RELUME" btf info .
expect_fail 'not a folder' 1 'nothing: cannot be read' - "$RELUME" btf info nothing
fresh paper other
printf '\000\176' | dd of=other/values.npy bs=1 seek=1000 conv=notrunc 2>/dev/null
expect_fail 'NaN among the values' 1 'other: view 0, light 2: NaN or infinity' x "$RELUME" btf fit other --model lit -o x
expect_fail 'NaN among values that are shown' 1 'other: view 0, light 2: NaN or infinity' x.exr "$RELUME" btf render other -o x.exr
"$RELUME" btf compare other --json >out.json 2>err.txt
check 'no half of a JSON object' test ! -s out.json
fresh lpca other
sed -i 's/"version": 1/"version": 2/' other/model.json
expect_fail 'another version' 1 'other/model.json: expected version 1; found 2' - "$RELUME" btf info other
fresh lpca other
truncate -s -1 other/weight.npy
expect_fail 'a truncated model' 1 'other/weight.npy: expected 1024 bytes of values; found 1023' - "$RELUME" btf info other
fresh paper other
truncate -s 5000 other/values.npy
expect_fail 'a truncated BTF' 1 'other/values.npy: expected 138624 bytes' - "$RELUME" btf info other
sed -i 's/"width": 8/"width": 9/' other/btf.json
cp paper/values.npy other/
expect_fail 'another size' 1 'expected halfs \[19\]\[19\]\[8\]\[9\]\[3\]|8 x 8 pixels; expected 9 x 8' - "$RELUME" btf info other
# g-BRDFs: one EXR file, made, shown, expanded, fitted
expect_ok 'plant' - "$RELUME" btf plant -o planted.exr --size 12 --directions coarse
"$RELUME" btf info planted.exr >out.txt
check 'info knows the file' grep -q 'gbrdf' out.txt
expect_ok 'expand' - "$RELUME" btf expand planted.exr -o expanded
expect_ok 'render' - "$RELUME" btf render planted.exr -o planted.png --light 'dir 0.4 0.2 0.8'
expect_ok 'eval' - "$RELUME" btf eval planted.exr expanded --json
below 'the file is what it shows' "$(field relative_rms out.txt)" 0.001
expect_ok 'render on a mesh' - "$RELUME" btf render planted.exr --mesh quad.obj -o cpu.exr --eye 1,-1,1.2 --light 'dir -0.8 0.2 0.3' --picture 60x60 --samples 1 -q
"$VIEWER" planted.exr --mesh quad.obj --eye 1,-1,1.2 --light 'dir -0.8 0.2 0.3' --size 60x60 --offscreen gl.exr 2>err.txt || not_ok 'relume-view of a g-BRDF' "$(cat err.txt)"
above 'relume-view shows a g-BRDF as the reference' "$("$RELUME" compare cpu.exr gl.exr | sed -n 's/^psnr_db *//p')" 60
expect_ok 'a g-BRDF by itself' - "$VIEWER" planted.exr --size 60x60 --offscreen cushion.png
expect_fail 'a g-BRDF is no scene' 1 "planted.exr: this is a measured material; .*see it: relume-view planted.exr" x.png "$RELUME" relight planted.exr -o x.png
expect_ok 'fit' - "$RELUME" btf fit expanded --model gbrdf -o found.exr
"$RELUME" btf fit expanded --model gbrdf -o again.exr --threads 1
check 'the same bytes for any number of threads' cmp found.exr again.exr
# said before anything is read: a fit may take long
expect_fail 'another model as one file' 2 'x.exr: an .exr file holds a g-BRDF of one level' x.exr "$RELUME" btf fit nothing --model lit -o x.exr
expect_fail 'no model as one file' 2 'x.exr: an .exr file holds a g-BRDF of one level' x.exr "$RELUME" btf fit nothing -o x.exr
expect_fail 'levels in one file' 2 'expected --model gbrdf without --levels, or a folder' x.exr "$RELUME" btf fit nothing --model gbrdf --levels 2 -o x.exr
"$RELUME" btf render paper -o plain.exr
expect_fail 'a picture is no g-BRDF' 1 "plain.exr: no g-BRDF; expected a part named 'depth'" - "$RELUME" btf info plain.exr
head -c 3000 planted.exr >cut.exr
expect_fail 'a cut g-BRDF' 1 'cut.exr' - "$RELUME" btf info cut.exr
# an object that names no material shows what its mesh does: here colours of vertices
printf 'v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 1 1 0 0 0 1\nv -1 1 0 1 1 1\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n' >colours.obj
echo '{"format":"relume-objects","version":1,"objects":[{"mesh":"colours.obj"}]}' >colours.json
expect_ok 'a mesh in its own colours' - "$RELUME" btf render colours.json -o cpu.exr --eye 0,0,4 --picture 48x48 -q
expect_ok 'in relume-view' - "$VIEWER" colours.json --eye 0,0,4 --size 48x48 --offscreen gl.exr
above 'as the reference' "$("$RELUME" compare cpu.exr gl.exr | sed -n 's/^psnr_db *//p')" 40
sed '/^v /s/ [01] [01] [01]$/ 1 1 1/' colours.obj >white.obj
sed 's/colours/white/' colours.json >white.json
expect_ok 'a white one' - "$RELUME" btf render white.json -o white.exr --eye 0,0,4 --picture 48x48 -q
check 'is another' sh -c "'$RELUME' compare cpu.exr white.exr | awk '/max_abs/ { exit !(\$2 > 0.5) }'"
sed '/^v /s/ [01] [01] [01]$//' colours.obj >bare.obj
sed 's/colours/bare/' colours.json >bare.json
expect_fail 'a mesh of no colour' 1 "bare.obj: part 'all' has no material, here or in the description" x.png "$RELUME" btf render bare.json -o x.png
# ---- a model alone is an object; what its file says nothing of is grey
"$RELUME" btf render colours.obj -o alone.exr --eye 0,0,4 --picture 48x48 2>err
check 'a model alone shows its own colours' cmp alone.exr cpu.exr
"$RELUME" btf render bare.obj -o grey.exr --eye 0,0,4 --picture 48x48 --light 'dir 0 0 1' 2>err
check 'without colours it is grey, said' grep -q 'bare.obj: names no material; shown in matte grey' err
"$RELUME" btf render white.json -o white.exr --eye 0,0,4 --picture 48x48 --light 'dir 0 0 1 rgb .6 .6 .6' -q
below 'that is 0.6 of white' "$("$RELUME" compare white.exr grey.exr | sed -n 's/^max_abs *//p')" 1e-3
expect_ok 'in relume-view' - "$VIEWER" bare.obj --eye 0,0,4 --size 16x16 --offscreen gl.exr
expect_fail 'what a page shows of it is said' 1 'relume bake bare.obj -o OUT.exr' site "$RELUME" publish bare.obj -o site
finish
