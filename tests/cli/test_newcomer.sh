#!/bin/sh
# What photographers bring from other programs and from their cameras: projects of RTIBuilder, lists
# without a count, photographs that say they were taken sideways, names with blanks, files that grow.
. "$(dirname "$0")/lib.sh"
"$sphere" dome --size 24 --lights 9 --hemisphere --format jpg || exit 1
body() { sed "1d; s|view00/|$1|" dome/dirs.lp; }
mkdir photos && cp dome/view00/*.jpg photos && { echo 9; body ''; } >photos/lights.lp
basis='--basis ptm'
relume encode photos -o want.exr $basis

# ---- a project of RTIBuilder: the list in one folder, the photographs in the one beside it
mkdir -p project/jpeg-exports project/assembly-files && cp photos/*.jpg project/jpeg-exports
{ echo 9; body 'C:\\Users\\Anna M\\RTI\\project\\jpeg-exports\\'; } | sed 's/$/\r/' >project/assembly-files/coin.lp
expect_ok 'a project of RTIBuilder' - "$RELUME" encode project -o project.exr $basis
same 'its photographs by the folder that its list names' want.exr project.exr
expect_ok 'what it is' - "$RELUME" info project
not_encoded 'its list alone may not leave its folder' 'outside its folder.*--allow-outside' project/assembly-files/coin.lp
expect_ok 'but with --allow-outside' - "$RELUME" encode project/assembly-files/coin.lp -o outside.exr $basis --allow-outside
same 'to the same' want.exr outside.exr
cp project/assembly-files/coin.lp project/jpeg-exports/second.lp
not_encoded 'two lists in two folders' 'project: no capture.json and no single .lp file' project

# ---- a list without its count
mkdir nocount && cp photos/*.jpg nocount && body '' >nocount/lights.lp
expect_ok 'a list without its count' - "$RELUME" encode nocount -o nocount.exr $basis
same 'is the same list' want.exr nocount.exr

# ---- EXIF says how the camera was held: `turned N FILE` writes orientation N into a JPEG
turned() {
    { printf '\377\330\377\341\000\042Exif\000\000II*\000\010\000\000\000\001\000\022\001\003\000\001\000\000\000'
        printf "\\00$1\\000\\000\\000\\000\\000\\000\\000"
        tail -c +3 "$2"; } >turned.jpg && mv turned.jpg "$2"
}
fresh photos sideways && for f in sideways/*.jpg; do turned 6 "$f"; done
expect_ok 'what comes next' "next: relume encode 'S A' -o FILE.exr" "$RELUME" capture photos -o 'S A'
mv 'S A' flat
expect_ok 'photographs taken sideways' 'lights.lp: its lights are turned with the photographs' "$RELUME" capture sideways -o upright
# upright (x, y) is (y, -x) of the picture as it lies in the file
sed 1d flat/lights.lp | awk '{ printf "%.5f %.5f %.5f\n", $3, -$2, $4 }' >want.txt
sed 1d upright/lights.lp | awk '{ printf "%.5f %.5f %.5f\n", $2, $3, $4 }' | sed 's/-0\.00000/0.00000/g' >got.txt
sed -i 's/-0\.00000/0.00000/g' want.txt
same 'lights of a list turn with the pictures' want.txt got.txt
expect_ok 'once more without' - "$RELUME" encode flat -o flat.exr --basis table
expect_ok 'and sideways' - "$RELUME" encode upright -o upright.exr --basis table
relume relight flat.exr -o a.exr --light 'dir 0.2 0.7 0.6'
relume relight upright.exr -o b.exr --light 'dir 0.7 -0.2 0.6'
for at in '3 4' '12 9' '20 14'; do
    set -- $at
    one=$("$mkimage" read a.exr "$1" "$2") two=$("$mkimage" read b.exr $((23 - $2)) "$1")
    if echo "$one $two" | awk '{ d = $1 - $4 } END { exit !(NF == 6 && $1 > 0.01 && d * d < 1e-5) }'; then
        ok "turned pixel $at"
    else
        not_ok "turned pixel $at" "$one and $two"
    fi
done
# one photograph of a camera that looks down says otherwise: it did not turn
fresh photos down && turned 3 down/light0004.jpg
expect_ok 'one orientation that contradicts the others' 'light0004.jpg: its EXIF orientation is not that of the first' "$RELUME" capture down -o still
for i in 3 4; do same "photograph $i stays as it is" flat/light000$i.exr still/light000$i.exr; done

# ---- a photograph on its side among others
mkdir side
for size in 24x16 24x16 16x24; do
    n=$((${n:-0} + 1))
    relume relight want.exr -o side/$n.png --size $size
    echo "$n.png 0.$n 0 1" >>side/lights.lp
done
not_encoded 'a photograph on its side' 'side/3.png: 16 x 24 pixels; expected 24 x 16 .*on its side' side

# ---- without a wish for the surface, small photographs tell which ones do not fit their lights
"$sphere" wide --size 172 --lights 9 --hemisphere --format jpg || exit 1
mkdir swapped && cp wide/view00/*.jpg swapped && sed 's|view00/||' wide/dirs.lp >swapped/lights.lp
mv swapped/light0003.jpg three.jpg && mv swapped/light0007.jpg swapped/light0003.jpg && mv three.jpg swapped/light0007.jpg
"$RELUME" capture swapped -o quick --json 2>quick.txt >quick.json
"$RELUME" capture swapped -o slow --normals normals.exr --json 2>slow.txt >slow.json
for i in 3 7; do check "photograph $i is under another light" grep -q "light000$i.jpg does not fit its light" quick.txt; done
grep -o 'light....\.jpg does not fit' slow.txt >want.txt
grep -o 'light....\.jpg does not fit' quick.txt >got.txt
same 'the same as by full size' want.txt got.txt

# ---- commands to copy have names in quotation marks; a hyphen is no file
mkdir 'St. Anna' && cp photos/*.jpg 'St. Anna'
expect_fail 'a name with a blank' 1 "relume capture 'St. Anna' -o DIR" x.exr "$RELUME" encode 'St. Anna' -o x.exr
expect_fail 'output -' 2 '/dev/stdout' ./- "$RELUME" encode photos -o -

# ---- what is no picture says how it is shown, an option without effect where it has one
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >'my cow.obj'
expect_fail 'a 3D model' 1 "a 3D model.*relume-view 'my cow.obj', .*relume bake 'my cow.obj' -o OUT.exr" x.png "$RELUME" relight 'my cow.obj' -o x.png
expect_fail 'lightfield --json without depth' 2 'depth-from-views' grid "$RELUME" lightfield photos -o grid --json

# ---- a file that is larger than the photographs says so
"$RELUME" encode photos -o large.exr 2>said.txt
check 'larger than the photographs' grep -q '[0-9.]* times the size of your photographs: --psnr 38 makes it much smaller$' said.txt
expect_ok 'and that is so' - "$RELUME" encode photos -o small.exr --psnr 38
above 'much smaller' "$(wc -c <large.exr)" $((2 * $(wc -c <small.exr)))
finish
