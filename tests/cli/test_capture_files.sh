#!/bin/sh
# Files as people have them: several after one option.
. "$(dirname "$0")/lib.sh"
"$sphere" dome --size 24 --lights 20 --hemisphere --format jpg || exit 1
mkdir photos flats && cp dome/view00/*.jpg photos
for f in photos/*.jpg; do "$mkimage" plane "$f" "flats/$(basename "$f" .jpg).exr" 0.5; done
sed 's|view00/||' dome/dirs.lp >photos/lights.lp

# ---- several files after one option
expect_ok 'flats in a folder' 'lights; see report.html' "$RELUME" capture photos --lights photos/lights.lp --flat flats -o folder
expect_ok 'flats by *' 'lights; see report.html' "$RELUME" capture photos --lights photos/lights.lp --flat flats/*.exr -o star
expect_ok 'before the photographs' 'lights; see report.html' "$RELUME" capture --flat flats/*.exr --lights photos/lights.lp photos -o before
for out in star before; do same "they are the same ($out)" folder/light0004.exr $out/light0004.exr; done
expect_ok 'a folder stands alone' 'lights; see report.html' "$RELUME" capture --flat flats photos --lights photos/lights.lp -o alone
same 'the photographs behind it are those of the object' folder/light0004.exr alone/light0004.exr
expect_ok 'the photographs alone are not taken' 'lights; see report.html' "$RELUME" capture --flat flats/light0000.exr photos -o one

# ---- 16 bits in .png and .tif
depth() { "$mkimage" maxdiff "$1" "$2"; }
expect_ok 'normals, heights' '/height.png: 0 is a height of -[0-9.]+ world units, 65535 of' "$RELUME" capture photos -o fine \
    --normals "$PWD/normals.tif" --height "$PWD/height.png"
relume capture photos -o exact --normals normals.exr --height height.exr
relume encode exact -o dome.exr
for kind in png tif; do
    relume relight dome.exr -o deep.$kind --bits 16 --exposure -1
    relume relight dome.exr -o flat.$kind --exposure -1
    differ "$kind: 16 bits are other bytes" deep.$kind flat.$kind
done
same '8 bits are the default' flat.png "$(relume relight dome.exr -o eight.png --bits 8 --exposure -1 && echo eight.png)"
relume relight dome.exr -o dome-float.exr --exposure -1
# linear light of codes of 16 bits: half a step of 1/65535 times the slope of sRGB at white, 2.3
for kind in png tif; do below "$kind: within 16 bits" "$(depth deep.$kind dome-float.exr)" 0.00002; done
expect_fail '16 bits of a JPEG' 2 '--bits 16: expected an output that ends in .png or .tif' a.jpg "$RELUME" relight dome.exr -o a.jpg --bits 16
# codes are (n + 1) / 2, from the lowest place to the highest; read as they are
code() { # file, x, y: codes of 16 bits
    "$mkimage" read "$1" "$2" "$3" | awk '{ for (i = 1; i <= NF; i++) { v = $i <= 0.0031308 ? 12.92 * $i : 1.055 * exp(log($i) / 2.4) - 0.055; printf "%.5f ", v } }'
}
below 'normals' "$(echo "$(code normals.tif 12 8) $("$mkimage" read normals.exr 12 8)" |
    awk '{ for (i = 1; i <= 3; i++) { d = 2 * $i - 1 - $(i + 3); m = d * d > m ? d * d : m } print sqrt(m) }')" 0.0001

# ---- a picture under every captured light
expect_ok 'every light' 'every: 20 pictures, one for each captured light' "$RELUME" relight dome.exr --every-light -o every
check 'as many pictures' test "$(ls every | wc -l)" -eq 20
relume relight dome.exr -o fifth.png --light "dir $(sed -n 6p dome/dirs.lp | cut -d' ' -f2-)"
above 'the fifth is that of the fifth light' "$(psnr every/light0004.png fifth.png)" 60
expect_fail 'a folder that is there' 2 'every: already exists' - "$RELUME" relight dome.exr --every-light -o every
expect_ok 'another format' - "$RELUME" relight dome.exr --every-light -o every --force --format tif --bits 16 --size 12
check 'replaces them' test "$(ls every/*.tif | wc -l)" -eq 20
expect_fail 'a light besides' 2 'every-light: leave out --light' - "$RELUME" relight dome.exr --every-light -o more --light 'dir 0 0 1'
expect_fail 'a format of one picture' 2 'format and --force work only with --every-light' - "$RELUME" relight dome.exr -o a.png --format png

# ---- the same photograph twice
fresh photos twice && cp twice/light0003.jpg twice/light0011.jpg
expect_ok 'a photograph twice' 'twice/light0003.jpg and twice/light0011.jpg are the same photograph' "$RELUME" capture twice -o twins

# ---- a TIFF of many pages
"$mkimage" pages stack.tif photos/*.jpg
expect_ok 'a photograph on each page' 'stack: 20 lights' "$RELUME" capture stack.tif --lights dome/dirs.lp -o stack
mkdir single && "$mkimage" tiff 16 3 single photos/*.jpg
relume capture single --lights dome/dirs.lp -o singles
for i in 00 07 19; do same "page $i" stack/light00$i.exr singles/light00$i.exr; done
check 'the page is named' grep -q '"file": "stack.tif#8"' stack/capture.json
"$mkimage" pages one.tif photos/light0000.jpg
expect_fail 'a TIFF of one page' 1 '1 photograph; expected at least 3' out "$RELUME" capture one.tif --lights dome/dirs.lp -o out

# ---- folders
mkdir -p above/left above/right above/notes && cp photos/*.jpg above/left && cp photos/light000*.jpg above/right && touch above/notes/a.txt
expect_fail 'photographs one folder below' 1 'above: no photographs; folders below have some: left .20., right .10.; try' out "$RELUME" capture above -o out
cp photos/* above
expect_ok 'folders beside photographs' 'above: folders below are left out, with photographs: left .20., right .10.' "$RELUME" capture above -o beside
mkdir tiles && cp photos/*.jpg tiles && echo '<MultiRes>' >tiles/info.xml
expect_fail 'tiles of WebRTI: capture' 1 'tiles: tiles of WebRTI .info.xml., .*; expected the .ptm or .rti' out "$RELUME" capture tiles -o out
not_encoded 'tiles of WebRTI: encode' 'tiles: tiles of WebRTI .info.xml., .*; expected the .ptm or .rti' tiles

# ---- raking light
mkdir board && for i in 1 2 3 4 5 6; do "$mkimage" plane dome/view00/light0000.jpg board/$i.exr 0.3$i; done
printf '%s\n' '.6 0 .8' '-.6 0 .8' '0 .6 .8' '0 -.6 .8' '.5 .5 .7' '-.5 .5 .7' >board/lights.txt
for f in board/*.exr; do "$mkimage" gain "$f" dim.exr 0.1 && mv dim.exr "$f"; done
relume capture board --lights board/lights.txt -o board_capture
relume encode board_capture -o board.exr --basis table
expect_ok 'a dark picture is named' 'low.png: nearly black, its bright parts are [0-9.]+ % of white; --exposure auto adds [0-9.]+ stops; the light stands 11 degrees above the picture, the lowest photographed one 45' \
    "$RELUME" relight board.exr -o low.png --light 'dir 1 0 0.2'
relume relight board.exr -o seen.exr --light 'dir 1 0 0.2' --exposure auto
# steps of 1/16 EV
below 'and exposed to 0.9' "$("$mkimage" read seen.exr 5 5 | awk '{ d = $1 - 0.9; print d < 0 ? -d : d }')" 0.03
relume relight dome.exr -o lit.png
check 'a bright one is not' test ! -s err.txt
finish
