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
finish
