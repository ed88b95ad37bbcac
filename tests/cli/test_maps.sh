#!/bin/sh
# relume maps: what the folder holds, what is said, what is refused.
. "$(dirname "$0")/lib.sh"
json() { # file, python expression of j
    "$python" -c "import json,sys; j = json.load(open(sys.argv[1])); sys.exit(not ($2))" "$1"
}
"$sphere" photos --size 32 --lights 24 --hemisphere --shade lambert --mask --format exr || exit 1

expect_ok 'maps of a capture' 'under 3 lights that were not used for the fit: .* dB PSNR' "$RELUME" maps photos -o made
same_files='basecolor.exr basecolor.png confidence.exr height.exr maps.json metallic.exr model.bin model.gltf model.mtlx
normal.exr normal.png occlusion.exr orm.png roughness.exr specular.exr specular.png'
check 'all files are there, and no other' test "$(ls made | tr '\n' ' ')" = "$(echo $same_files) "
check 'an unknown scale is said' grep -q 'the scale is not known: .* --width' err.txt
check 'a matte sphere has no gloss' grep -q 'material 1 of 1: matte, 100 %' err.txt
check 'the structure at the edge of a mask is that of the photograph' grep -q 'SSIM 0.9[5-9]\|SSIM 1.000' err.txt
check 'what cannot be shown is said' grep -q 'of the pixels cannot be described by such maps' err.txt

# ---- an existing folder, bytes, JSON
expect_fail 'a folder that is there' 2 'made: .*--force' - "$RELUME" maps photos -o made
"$RELUME" maps photos -o again --threads 1 -q && "$RELUME" maps photos -o again --force --threads 3 -q
check 'bytes do not depend on the threads' diff -r made again
"$RELUME" maps photos -o made --force --json --width 50 --mesh 8 -q >out.json
check 'JSON: the quality of lights held out' json out.json \
    "j['held_out']['lights'] == 3 and j['held_out']['psnr_db'] > 20 and j['fitted_lights'] == 21 and j['width_mm'] == 50"
check 'the description says the same' json made/maps.json "j['held_out']['lights'] == 3 and j['height_unit'] == 'mm'"
check 'the model is 50 mm wide, and a mesh of 9 x 9 vertices' json made/model.gltf \
    "abs(j['accessors'][0]['max'][0] - 0.025) < 1e-7 and j['accessors'][0]['count'] == 81 and j['accessors'][0]['max'][2] > 0.001"
check 'its buffer is as long as it says' json made/model.gltf \
    "__import__('os').path.getsize('made/model.bin') == j['buffers'][0]['byteLength']"
"$RELUME" maps photos -o all --held-out 0 --json -q >out.json
check 'none held out: null, and the fitted lights' json out.json "j['held_out']['psnr_db'] is None and j['fitted_lights'] == 24"

"$RELUME" maps photos -o slash/ -q
check 'a new folder may end in a slash' test -e slash/maps.json
expect_ok 'a gain that is asked for is not explained' 'material 1' "$RELUME" maps photos -o louder --gain 1.5
check 'its reason is not ours' sh -c '! grep -q "not known; --gain" err.txt'
expect_fail 'more memory than allowed' 1 'takes [0-9]* bytes; expected at most [0-9]* bytes \(--max-memory\)' none \
    "$RELUME" maps photos -o none --max-memory 20K
cp -r photos broken && "$mkimage" poke photos/view00/light0005.exr broken/view00/light0005.exr 9 9 nan
expect_fail 'a pixel that is NaN' 1 "light0005.exr: 1 pixel is NaN.*'relume encode --repair'" none "$RELUME" maps broken -o none
head -c 700 photos/view00/light0005.exr >broken/view00/light0005.exr
expect_fail 'a photograph that is cut' 1 'light0005.exr: truncated or damaged' none "$RELUME" maps broken -o none
"$sphere" dot --size 1 --lights 12 --hemisphere --shade lambert --format exr
expect_ok 'one pixel' 'PSNR' "$RELUME" maps dot -o dot-maps
check 'has no structure to compare' sh -c '! grep -qi nan err.txt'

# ---- what is the user's stays; nothing is left of what could not be written
mkdir mine && echo notes >mine/notes.txt
expect_fail "a folder of the user's, even with --force" 2 'mine: ' - "$RELUME" maps photos -o mine --force
check 'it is as it was' grep -q notes mine/notes.txt
expect_fail 'a disk that is full' 3 'none' none sh -c "ulimit -f 8; '$RELUME' maps photos -o none"
"$RELUME" maps photos -o stopped -q & sleep 0.1; kill -INT $!; wait $! 2>/dev/null
check 'stopped: nothing, or all' sh -c 'test ! -e stopped || test -e stopped/maps.json'
check 'stopped: nothing beside it' test -z "$(leftovers)"

# ---- which way green points: the sphere's upper half faces up
"$RELUME" maps photos -o dx --directx -q
up=$("$mkimage" read dx/normal-gl.png 16 9 | cut -d' ' -f2) down=$("$mkimage" read dx/normal.png 16 9 | cut -d' ' -f2)
above 'green is up for OpenGL' "$up" "$down"
check 'glTF takes the upward one' grep -q normal-gl.png dx/model.gltf

# ---- from files
"$RELUME" encode photos -o file.exr -q
expect_ok 'maps of a relume file' 'lights that were not used' "$RELUME" maps file.exr -o of-file
"$RELUME" export file.exr -o file.ptm --to ptm -q
expect_ok 'maps of a .ptm' 'lights that were not used' "$RELUME" maps file.ptm -o of-ptm
"$RELUME" export file.exr -o file.rti --to rti -q
expect_ok 'maps of a .rti' 'lights that were not used' "$RELUME" maps file.rti -o of-rti
"$RELUME" export file.exr -o web --to relight -q
expect_ok 'maps of a web folder' 'lights that were not used' "$RELUME" maps web -o of-web
"$RELUME" synth box --projection slab -o slab --size 16 --lights 12 --hemisphere --samples 1 -q
"$RELUME" encode slab -o slab.exr --basis pca --shadows no -q
for from in slab slab.exr; do
    "$RELUME" maps $from -o first --force -q && "$RELUME" maps $from -o third --force --view 2 -q
    check "$from: its views differ" sh -c '! cmp -s first/basecolor.exr third/basecolor.exr'
    expect_fail "$from: a view that is not there" 2 "$from: view 99 does not exist; expected 0 to 24" none \
        "$RELUME" maps $from -o none --view 99
done

# ---- what can be had
"$sphere" five --size 24 --lights 5 --hemisphere --shade lambert --format exr
expect_ok 'five lights: no gloss, said' 'warning: .*5 lights are too few for gloss.*roughness is 1' "$RELUME" maps five -o five-maps
"$sphere" two --size 16 --lights 2 --hemisphere --shade lambert --format exr
expect_fail 'two lights' 1 'at least 3 lights, and 6 for roughness' none "$RELUME" maps two -o none
"$RELUME" synth attic -o attic --size 16 --lights 8 --samples 1 -q
expect_fail 'a panorama' 1 'maps lie on a plane' none "$RELUME" maps attic -o none
expect_fail 'too many held out' 2 'cannot be held out; expected at most 20' none "$RELUME" maps photos -o none --held-out 21
rm photos/view00/light0003.exr
expect_fail 'a missing photograph' 1 'no such file' none "$RELUME" maps photos -o none
finish
