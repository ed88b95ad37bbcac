#!/bin/sh
# Every EXR file that relume writes is one that any OpenEXR program opens: by the strict reading of
# the second reader, which wants equal shared attributes in all parts, and by OpenImageIO's and
# OpenEXR's own tools where they are installed.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/format.sh"
small='--lights 8 --size 16 --samples 1'

# ---- relume files: every projection, storage, kind of codebook
"$sphere" masked --size 16 --lights 12 --hemisphere --mask
relume synth box -o box $small --hemisphere
relume synth teapot -o slab $small --views 2x2
relume synth bust --mesh "$TOP/tests/golden/roof.obj" -o slabs --slabs 4 --views 2x1 $small
relume synth attic -o cylinder $small
relume synth attic -o discs --discs $small
relume synth attic -o sphere --projection spherical $small
relume synth attic -o cube --projection cube $small
for c in masked box slab slabs cylinder discs sphere cube; do
    relume encode $c -o $c-planes.exr --basis sh
    relume encode $c -o $c-books.exr --basis sh --codebook 40
done
relume encode slab -o shared.exr --basis sh --codebook 40 --share
for way in '--stages 2' '--split luma' '--split product:2' '--bits 12' '--bits half' \
    '--no-depth' '--colour luminance' '--compression none'; do
    relume encode masked -o "masked$(echo "$way" | tr ' :' __).exr" --basis sh --codebook 40 $way
done
relume encode masked -o pca.exr --basis pca --coefficients 9
relume encode masked -o table.exr --basis table --bits 16 --compression rle

# ---- pictures: captures' own are there already
relume relight slab-books.exr -o relit.exr
relume relight masked-planes.exr -o normals.exr --pass normals
relume glare relit.exr -o seen.exr --size 64 --wavelengths 4 --width 9
relume glare --psf pattern --size 64 --wavelengths 4 --width 9
relume synth --btf wallpaper -o paper --size 8 --directions coarse --samples 1 --bounces 0
relume btf fit paper --model rfnl --levels 2 -o model
relume btf render model -o material.exr
relume capture masked/view00/light*.exr --lights masked/capture.json -o again --normals n.exr --albedo a.exr --height h.exr
relume export masked-planes.exr -o m.ptm --to ptm
relume import m.ptm -o imported.exr

# of a capture's pictures the first ones
find . -name '*.exr' ! -name 'light*[1-9].exr' | sort >files.txt
above "files of all kinds" "$(grep -c . files.txt)" 50

# ---- the second reader
while read -r file; do
    why=$("$decode" "$file" 2>&1) || not_ok "strict: $file" "$why"
done <files.txt
ok 'strict headers and equal shared attributes'

# ---- other programs. They warn of no file and fail on none.
opens() { # tool, its words: all files at once, since some of these programs take long to start
    tool=$1
    command -v "$tool" >which.txt 2>&1 || { skip "$tool" 'not installed'; return; }
    if "$@" $(cat files.txt) >out.txt 2>err.txt && ! grep -iE 'error|cannot|warning' err.txt &&
        [ "$(grep -cE 'preview|"image"|dataWindow' out.txt)" -ge "$(grep -c . files.txt)" ]; then
        ok "$tool opens them all"
    else
        not_ok "$tool opens them all" "$(head -c 600 err.txt)"
    fi
}
opens oiiotool --info -v -a
opens exrheader
opens exrinfo -s

# ---- files of before, whose codebooks had display windows of their own
old=$TOP/tests/golden/old-books.exr
expect_fail_old() { "$decode" "$old" 2>&1 | grep -q 'another displayWindow than part 0'; }
check 'an old file has what newer ones must not have' expect_fail_old
tolerance=2e-6
size=8 light='1 .5 1'
check 'an old file is read as before' near \
    "$("$RELUME" query "$old" $(planar 3 2) --light 'dir 1 .5 1' -q)" '0.316988617 0.314963907 0.316028208'
agree 'an old file: the second reader' "$old" 0 "$(planar 3 2)" 3 2
finish
