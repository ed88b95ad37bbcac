#!/bin/sh
# Broken captures: one clear line that names the file, status 1, nothing written.
. "$(dirname "$0")/lib.sh"
L="--basis sh --coefficients 4"
"$sphere" good --size 24 --lights 10 --format png || exit 1
"$sphere" float --size 24 --lights 10 --half || exit 1
encoded good - good $L
encoded good-lp - good/dirs.lp $L

# ---- images
image=view00/light0003.png
fresh good c; rm c/$image
not_encoded 'missing image' "c/$image.*no such file" c
not_encoded 'missing image, .lp' "dirs.lp: image '$image' does not exist" c/dirs.lp
encoded missing-skipped "warning.*light0003.png' does not exist; its light is left out" c $L --skip-missing
encoded missing-skipped-lp "warning.*light0003.png' does not exist; its light is left out" c/dirs.lp $L --skip-missing
"$RELUME" info missing-skipped.exr --json >info.json
below 'nine lights are left' "$(field lights info.json)" 9
rm c/view00/light0004.png c/view00/light0007.png
encoded missing-three "warning.*light0003.png' and those of 2 other lights do not exist; these 3 of 10 lights are left out" c $L --skip-missing
rm -f c/view00/*.png
not_encoded 'nothing left to skip to' "c/capture.json: no image exists" c --skip-missing
fresh good c; : >c/$image
not_encoded 'empty image' "c/$image: empty file" c
fresh good c; echo 'this is no picture' >c/$image
not_encoded 'text named .png' "c/$image: not a readable image" c
fresh good c; rm c/$image; mkdir c/$image
not_encoded 'folder named .png' "c/$image: empty file or folder" c
"$sphere" small --size 20 --lights 10 --format png
fresh good c; cp small/$image c/$image
not_encoded 'one image of another size' "c/$image: 20 x 20 pixels; expected 24 x 24" c
"$sphere" photo --size 24 --lights 10 --format jpg
photo=view00/light0003.jpg
size=$(wc -c <photo/$photo)
encoded photo - photo $L
fresh photo c; head -c $((size / 2)) photo/$photo >c/$photo
not_encoded 'JPEG cut in half' "c/$photo: (truncated|not a readable)" c
head -c $((size - 40)) photo/$photo >c/$photo
not_encoded 'JPEG without its last bytes' "c/$photo: truncated" c
fresh photo c; head -c 300 photo/$photo >c/$photo
not_encoded 'JPEG cut to 300 bytes' "c/$photo: .*(truncated|not a readable)" c
# a thumbnail's end marker is not the picture's: APP1 holding "FF D8 FF D9" comes first
fresh photo c; { printf '\377\330\377\341\000\006\377\330\377\331'; tail -c +3 photo/$photo | head -c $((size - 40)); } >c/$photo
not_encoded 'cut JPEG with a whole thumbnail' "c/$photo.*truncated" c
fresh photo c; { cat photo/$photo; printf 'trailing bytes of a camera'; } >c/$photo
encoded jpeg-with-trailer - c $L
same 'bytes after the JPEG change nothing' photo.exr jpeg-with-trailer.exr
# coded data may end in FF 00 and one byte more: the search for the end marker stands before that byte
fresh photo c; { head -c -2 photo/$photo; printf '\377\000\211\377\331'; } >c/$photo
encoded jpeg-with-coded-ff-at-its-end - c $L
same 'a coded FF before the end marker is not a cut' photo.exr jpeg-with-coded-ff-at-its-end.exr
for f in png tif exr; do
    "$sphere" f --size 24 --lights 10 --format $f
    one=f/view00/light0003.$f
    n=$(wc -c <$one)
    for part in 2 20; do
        cp $one whole; head -c $((n - n / part)) whole >$one
        not_encoded "$f cut by 1/$part" "$one: .*(truncated|not a readable|damaged|broken)" f
        cp whole $one
    done
    head -c 30 whole >$one
    not_encoded "$f cut to 30 bytes" "$one" f
    rm -rf f
done
for v in nan inf; do
    fresh float c; "$mkimage" poke float/view00/light0003.exr c/view00/light0003.exr 5 6 $v
    not_encoded "$v in an image" "c/view00/light0003.exr: .*finite" c
done
fresh float c; "$mkimage" poke float/view00/light0003.exr c/view00/light0003.exr 5 6 3.4e38
not_encoded 'values that overflow the codes' 'c/view00/.*too bright to be stored' c --basis table
not_encoded 'values whose logarithms overflow' 'light0003.exr: values are too bright to be converted; .*lower the exposure' c --basis eigen --domain log
fresh float c; "$mkimage" poke float/view00/light0003.exr c/view00/light0003.exr 5 6 1e6
expect_ok 'values that no half holds' - "$RELUME" encode c -o out.exr --basis table --bits half
"$RELUME" eval out.exr c -q >eval.txt  # 2^-11 of 1e6, over all pixels
check 'are kept over a power of two' awk '$1 == "rms" { exit !($2 < 500) }' eval.txt
fresh float c; "$mkimage" poke float/view00/light0003.exr c/view00/light0003.exr 5 6 1e4
expect_ok 'a value far above the others' 'warning: out.exr: very bright highlights: 8 bits' \
    "$RELUME" encode c -o out.exr --basis table --bits 8
expect_ok 'and where nobody asks for 8 bits' - "$RELUME" encode c -o out.exr --basis table
check 'halves' grep -q 'storage *half' <<INFO
$("$RELUME" info out.exr)
INFO
expect_ok 'halfs hold both' - "$RELUME" encode c -o out.exr --basis table --bits half
expect_ok 'the others alone fit 8 bits' - "$RELUME" encode float -o out.exr --basis table
rm -f out.exr
for kind in bigpng bigexr; do
    extension=${kind#big}
    fresh good c; "$mkimage" $kind c/big.$extension 1000000 1000000
    sed "s|$image|big.$extension|" good/capture.json >c/capture.json
    not_encoded "$extension that claims 1000000 x 1000000" "c/big.$extension" c
done
"$mkimage" bigpng huge.png 30000 30000
expect_fail 'PNG that claims 30000 x 30000' 1 huge.png - "$RELUME" compare huge.png huge.png
"$mkimage" bigexr huge.exr 30000 30000
expect_fail 'EXR that claims 30000 x 30000' 1 huge.exr - "$RELUME" compare huge.exr huge.exr

# ---- kinds of images: the same picture in every dress gives the same file, bit for bit
"$sphere" png --size 24 --lights 10 --format png --grey
fresh png base
"$mkimage" png 8 3 base/view00 png/view00/light*.png
encoded rgb8 - base $L
for kind in 'png 8 4' 'png 16 3' 'png 16 4' 'tiff 8 4' 'tiff 16 3'; do
    set -- $kind
    fresh base c
    "$mkimage" $1 $2 $3 c/view00 base/view00/light*.png
    encoded "kind-$1-$2-$3" - c $L
    if [ "$2" = 8 ]; then
        same "$kind is read as RGB" rgb8.exr "kind-$1-$2-$3.exr"
    else # 16-bit codes are decoded by formula, 8-bit ones by table: a rounding apart
        "$RELUME" relight rgb8.exr -o a.exr; "$RELUME" relight "kind-$1-$2-$3.exr" -o b.exr
        below "$kind is read as RGB" "$("$mkimage" maxdiff a.exr b.exr)" 0.01
    fi
done
# grey: the sphere is made grey (green channel) first, so that all three channels agree
"$sphere" wrap --size 24 --lights 10 --format png --grey --shade wrap
fresh wrap rgb; fresh wrap grey; fresh wrap alpha; fresh wrap tiff
"$mkimage" png 8 3 rgb/view00 wrap/view00/light*.png
"$mkimage" png 8 1 grey/view00 wrap/view00/light*.png
"$mkimage" png 8 2 alpha/view00 wrap/view00/light*.png
"$mkimage" tiff 8 1 tiff/view00 wrap/view00/light*.png
encoded grey-rgb - rgb $L
encoded grey-png - grey $L
encoded grey-alpha - alpha $L
encoded grey-tiff - tiff $L
same 'grey PNG is read as RGB' grey-rgb.exr grey-png.exr
same 'grey PNG with alpha is read as RGB' grey-rgb.exr grey-alpha.exr
same 'grey TIFF is read as RGB' grey-rgb.exr grey-tiff.exr
# PNG data under a .jpg name
fresh wrap c; for i in c/view00/*.png; do mv $i ${i%png}jpg; done
sed 's/\(light[0-9]*\)\.png/\1.jpg/g' wrap/capture.json >c/capture.json
encoded png-named-jpg - c $L
encoded png-named-png - wrap $L
same 'PNG data in .jpg files' png-named-jpg.exr png-named-png.exr
# CMYK: no black, half cyan, no magenta, full yellow is rgb codes 128 255 0, linear .216 1 0
fresh photo c; "$mkimage" cmyk c/view00/light0003.jpg 24 24 127 0 255 0
encoded cmyk - c $L
"$mkimage" read c/view00/light0003.jpg 5 5 >cmyk.txt
above 'CMYK: half of red' "$(cut -d' ' -f1 cmyk.txt)" 0.20
below 'CMYK: not more' "$(cut -d' ' -f1 cmyk.txt)" 0.23
above 'CMYK: all green' "$(cut -d' ' -f2 cmyk.txt)" 0.98
below 'CMYK: no blue' "$(cut -d' ' -f3 cmyk.txt)" 0.001

# ---- .lp files
lp() { fresh good c; cat >c/dirs.lp; }
body() { tail -n +2 good/dirs.lp; }
lp <<E
$(echo 10; body | sort -r)
E
encoded lp-order - c/dirs.lp $L
"$RELUME" eval lp-order.exr good --json >a.json; "$RELUME" eval good.exr good --json >b.json
above 'names decide: other order, same quality' "$(field psnr_db a.json)" "$(field psnr_db b.json | awk '{ print $1 - 0.01 }')"
# ... and with the manifest's order restored the file is the same, bit for bit
fresh good c; i=0; mkdir c/shuffled
while [ $i -lt 10 ]; do mv c/view00/light000$i.png c/shuffled/light000$i.png; i=$((i + 1)); done
rm -r c/view00; mv c/shuffled/* c/; rmdir c/shuffled
encoded lp-base-names - c/dirs.lp $L
same 'base names are found in the folder' good-lp.exr lp-base-names.exr
sed 's|view00/light|C:\\Users\\a b\\photos\\LIGHT|' good/dirs.lp >c/dirs.lp
encoded lp-windows - c/dirs.lp $L
same 'absolute Windows paths in another case' good-lp.exr lp-windows.exr
sed 's|view00/light|no/such/name|' good/dirs.lp >c/dirs.lp
encoded lp-unknown 'warning.*order of their names' c/dirs.lp $L
same 'all names unknown, counts agree: order of names' good-lp.exr lp-unknown.exr
rm c/light0009.png
not_encoded 'all names unknown, counts differ' "dirs.lp: image 'no/such/name0000.png' does not exist" c/dirs.lp
lp <<E
$(echo 12; body)
E
encoded lp-count-big 'warning.*promises 12 lights; found 10' c/dirs.lp $L
same 'count too big: all listed lights' good-lp.exr lp-count-big.exr
lp <<E
$(echo 7; body)
E
encoded lp-count-small 'warning.*promises 7 lights; found 10' c/dirs.lp $L
same 'count too small: all listed lights' good-lp.exr lp-count-small.exr
fresh good c; sed 's/$/  	/' good/dirs.lp >c/dirs.lp
encoded lp-blank - c/dirs.lp $L
same 'trailing blanks' good-lp.exr lp-blank.exr
sed 's/$/\r/' good/dirs.lp >c/dirs.lp
encoded lp-crlf - c/dirs.lp $L
same 'CRLF' good-lp.exr lp-crlf.exr
{ printf '\357\273\277'; cat good/dirs.lp; } >c/dirs.lp
encoded lp-bom - c/dirs.lp $L
same 'byte order mark' good-lp.exr lp-bom.exr
{ echo; sed 's/$/\n/; s/^/   /' good/dirs.lp; echo; } >c/dirs.lp
encoded lp-empty-lines - c/dirs.lp $L
same 'blank lines and leading blanks' good-lp.exr lp-empty-lines.exr
printf '%s' "$(cat good/dirs.lp)" >c/dirs.lp
encoded lp-no-newline - c/dirs.lp $L
same 'no newline at the end' good-lp.exr lp-no-newline.exr
awk 'NR > 1 { $2 *= 3; $3 *= 3; $4 *= 3 } 1' OFMT=%.9g CONVFMT=%.9g good/dirs.lp >c/dirs.lp
encoded lp-long-vectors - c/dirs.lp $L
"$RELUME" relight good-lp.exr -o a.exr; "$RELUME" relight lp-long-vectors.exr -o b.exr
below 'vectors are normalised' "$("$mkimage" maxdiff a.exr b.exr)" 0.005 # a code of 8 bits
awk 'NR > 1 { for (i = 2; i < 5; i++) sub(/\./, ",", $i) } 1' good/dirs.lp >c/dirs.lp
encoded lp-commas - c/dirs.lp $L
same 'decimal commas' good-lp.exr lp-commas.exr
fresh good c; mkdir 'with space'; cp -r good/. 'with space/'
mv 'with space/view00' 'with space/view 00'
sed 's|view00/light|view 00/light|' good/dirs.lp >'with space/dirs.lp'
sed 's|view00|view 00|g' good/capture.json >'with space/capture.json'
encoded lp-spaces - 'with space/dirs.lp' $L
same 'file names with spaces' good-lp.exr lp-spaces.exr
encoded json-spaces - 'with space' $L
same 'file names with spaces in capture.json' good.exr json-spaces.exr
# every kind of broken line is in unit/test_lp.c; one of each outcome goes through the tool
{ cat good/dirs.lp; echo 'x nan 0 1'; } >c/dirs.lp
not_encoded '.lp line with NaN' 'c/dirs.lp: line 12' c/dirs.lp
{ echo 0; body; } >c/dirs.lp
not_encoded '.lp count 0' 'c/dirs.lp: line 1; expected the number of lights' c/dirs.lp
cp good/$image c/dirs.lp
not_encoded 'a picture as .lp' 'c/dirs.lp: ' c/dirs.lp
not_encoded 'no such .lp' 'nowhere.lp: cannot be opened' nowhere.lp
not_encoded 'no such capture' 'nowhere: ' nowhere
mkdir empty
not_encoded 'folder without capture.json' 'empty: no capture.json and no single .lp file in this folder; .*: relume capture empty -o DIR' empty

# ---- capture.json
json() { # name, pattern, sed program
    fresh good c
    sed "$3" good/capture.json >c/capture.json
    cmp -s good/capture.json c/capture.json && not_ok "$1" 'the test changes nothing'
    not_encoded "$1" "c/capture.json: .*$2" c
}
json 'zero direction' 'directions\[3\].*zero' '11s/\[.*\]/[0, 0, 0]/'
json 'NaN direction' 'JSON' '11s/\[.*\]/[NaN, 0, 0]/'
json 'a light too many' 'images.*11 lights, found 10' '11s/$/\n[0, 0, 1],/'
json 'a light too few' 'images.*9 lights, found 10' 11d
json 'newer version' 'newer' 's/"version": 1/"version": 2/'
json 'half a file' 'JSON' '20,$d'
ones=$(awk 'BEGIN { for (i = 0; i < 10; i++) printf "%s[1e-60,1,1]", i ? "," : "" }')
json 'intensity that no float holds' 'intensities' "s/\"lights\": {/\"lights\": { \"intensities\": [$ones],/"
printf 'a\001\nb\033[31m' >c/capture.json
not_encoded 'control characters' 'c/capture.json: ' c

# ---- depth and mask
fresh good c; "$mkimage" plane good/$image c/view00/depth.exr -1
not_encoded 'negative depth' 'c/view00/depth.exr: depth -1 at pixel \(0, 0\); expected' c
"$mkimage" plane good/$image c/view00/depth.exr nan
not_encoded 'NaN depth' 'c/view00/depth.exr: depth' c
"$mkimage" plane good/$image c/view00/depth.exr inf
encoded depth-inf - c $L
"$mkimage" plane small/$image c/view00/depth.exr 1
not_encoded 'depth of another size' 'c/view00/depth.exr: 20 x 20' c
rm c/view00/depth.exr
not_encoded 'missing depth' 'c/view00/depth.exr: no such file' c
fresh good c; sed 's/"depth"/"mask"/' good/capture.json >c/capture.json; cp small/view00/depth.exr c/view00/
not_encoded 'mask of another size' 'c/view00/depth.exr: 20 x 20' c

# ---- lights that do not determine the fit
"$sphere" few --size 8 --lights 3
not_encoded 'fewer lights than coefficients' 'few: 9 coefficients of basis sh need at least 9 lights; found 3' few --basis sh --coefficients 9
encoded three-lights - few
encoded one-coefficient - few --basis sh --coefficients 1
"$sphere" one --size 8 --lights 1
encoded one-light 'warning: one: 64 of 64 pixels are black under every light' one
encoded one-light-table 'warning: one: 64 of 64 pixels are black under every light' one --basis table
not_encoded 'one light for nine coefficients' 'one: .*need at least 9 lights; found 1' one --basis sh --coefficients 9
"$sphere" ring --size 8 --lights 12
awk 'NR == 1 { print; next } { a = 0.5235988 * NR; print $1, cos(a), sin(a), 0.5 }' ring/dirs.lp >ring/ring.lp
not_encoded 'one ring only' 'ring.lp: .*determine only [0-9] of 9 coefficients' ring/ring.lp --basis sh --coefficients 9
encoded ring-table 'warning: ring/ring.lp: all 12 lamps stand on one ring' ring/ring.lp --basis table
awk 'NR == 1 { print; next } { print $1, 0.6, 0, 0.8 }' ring/dirs.lp >ring/same.lp
not_encoded 'twelve times one direction' 'same.lp: .*determine only 1 of 4' ring/same.lp --basis sh --coefficients 4
encoded same-table 'warning: ring/same.lp: all 12 lights come from one direction' ring/same.lp --basis table
finish
