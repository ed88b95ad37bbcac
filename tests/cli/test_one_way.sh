#!/bin/sh
# `encode LIST` makes what `capture --lights LIST` and `encode` make, byte for byte, whatever the
# camera did: held sideways, another colour space, bumped, a lamp that failed.
. "$(dirname "$0")/lib.sh"
"$sphere" dome --size 128 --lights 12 --hemisphere --shade lambert --format jpg || exit 1
mkdir plain && cp dome/view00/*.jpg plain && sed 's|view00/||' dome/dirs.lp >plain/lights.lp

insert() { # JPEG, marker as an octal number, file: a segment after the first two bytes
    size=$(($(wc -c <"$3") + 2))
    { printf '\377\330\377'
        printf "\\$2\\$(printf %o $((size / 256)))\\$(printf %o $((size % 256)))"
        cat "$3"
        tail -c +3 "$1"; } >inserted.jpg && mv inserted.jpg "$1"
}
equals() { # name, folder, pattern of what is said or -, options of encode
    case=$1 folder=$2 pattern=$3
    shift 3
    rm -rf made
    relume capture "$folder" --lights "$folder/lights.lp" -o made
    relume encode made -o folder.exr "$@"
    expect_ok "encode: $case" "$pattern" "$RELUME" encode "$folder/lights.lp" -o list.exr "$@"
    same "equals capture and encode: $case" folder.exr list.exr
}
ptm='--basis ptm'
equals 'photographs as they are' plain - $ptm
cp list.exr plain.exr
expect_ok 'the folder says what they held' - grep -q '"photographs": "display"' made/capture.json
equals 'by the default' plain -

cp -r plain sideways
printf 'Exif\000\000II*\000\010\000\000\000\001\000\022\001\003\000\001\000\000\000\006\000\000\000\000\000\000\000' >exif
for f in sideways/*.jpg; do insert "$f" 341 exif; done
equals 'held sideways' sideways 'lights are turned with the photographs' $ptm
differ 'and turned upright' plain.exr list.exr

# the profile that relume puts into pictures, with another red
cp -r plain wide
relume relight plain.exr -o lit.jpg --icc --light 'dir 0 0 1'
size=$(od -An -tu1 -j$(($(grep -abo ICC_PROFILE lit.jpg | head -1 | cut -d: -f1) - 2)) -N2 lit.jpg | awk '{ print 256 * $1 + $2 - 2 }')
tail -c +$(($(grep -abo ICC_PROFILE lit.jpg | head -1 | cut -d: -f1) + 1)) lit.jpg | head -c "$size" >icc
at=$(grep -abo rXYZ icc | head -1 | cut -d: -f1)
offset=$(od -An -tu1 -j$((at + 4)) -N4 icc | awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4 }')
printf '\000\000\234\000' | dd of=icc bs=1 seek=$((14 + offset + 8)) conv=notrunc 2>/dev/null
for f in wide/*.jpg; do insert "$f" 342 icc; done
equals 'of another colour space' wide '% of the pixels lie outside sRGB' $ptm
differ 'and in other colours' plain.exr list.exr

mkdir bumped && "$mkimage" png 8 3 bumped plain/*.jpg 2>err.txt
for f in bumped/*.jpg; do mv "$f" "${f%.jpg}.png"; done
sed 's/\.jpg/.png/' plain/lights.lp >bumped/lights.lp
for i in 08 09 10 11; do "$mkimage" shift bumped/light00$i.png moved.png 3 && mv moved.png bumped/light00$i.png; done
equals 'a camera that was bumped' bumped 'from bumped/light0008.png on the scene lies 3.0 pixels to the right' $ptm

cp -r plain failed && "$mkimage" gain failed/light0005.jpg black.exr 0 && "$mkimage" shift black.exr failed/light0005.jpg 0
equals 'a lamp that failed' failed 'light0005.jpg: left out: black' $ptm
mkdir masked && cp plain/* masked && "$mkimage" plane plain/light0000.jpg mask.exr 0.9 && mv mask.exr masked
equals 'a mask' masked - $ptm
expect_ok 'eval opens them alike' - "$RELUME" eval plain.exr plain/lights.lp
relume capture masked --lights masked/lights.lp --crop 20,30,64,40 -o part
relume encode part -o folder.exr $ptm
expect_ok 'encode: a part' 'cropped to 20,30,64,40 of 128 x 128' "$RELUME" encode masked/lights.lp --crop 20,30,64,40 -o list.exr $ptm
same 'equals capture and encode: a part' folder.exr list.exr
