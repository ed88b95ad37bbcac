#!/bin/sh
# Import and export: files that are broken and wishes that cannot be fulfilled are refused with a sentence.
. "$(dirname "$0")/lib.sh"
"$sphere" dome --size 40 --lights 40 --hemisphere --format png || exit 1
relume encode dome -o pca.exr --basis pca --coefficients 27
relume encode dome -o ptm.exr --basis ptm --coefficients 6
relume encode dome -o hsh.exr --basis hsh --coefficients 9
relume export ptm.exr --to ptm -o ptm.ptm
relume export hsh.exr --to rti -o rti.rti
relume export pca.exr --to relight -o web-bilinear
"$sphere" little --size 24 --lights 12 --hemisphere --format png
relume encode little -o little.exr --basis pca --coefficients 6
relume export little.exr --to relight -o other

bad() { # name, pattern, input
    expect_fail "$1" 1 "$2" out.exr "$RELUME" import "$3" -o out.exr
}
bad 'nothing there' 'no such file' nothing.ptm
bad 'another kind of file' 'this format cannot be imported' dome/dirs.lp
bad 'a folder without info.json' 'dome: a folder without info.json, so no web folder' dome
size=$(wc -c <ptm.ptm)
head -c $((size / 2)) ptm.ptm >cut.ptm
bad '.ptm cut in half' 'cut.ptm: truncated; expected 28800 bytes of pixels, found [0-9]+' cut.ptm
head -c 40 ptm.ptm >cut.ptm
bad '.ptm cut in its header' 'cut.ptm: .*expected' cut.ptm
: >cut.ptm
bad 'empty .ptm' 'cut.ptm: not a polynomial' cut.ptm
printf 'PTM_1.2\nPTM_FORMAT_RGB\n1000000\n1000000\n1 1 1 1 1 1\n0 0 0 0 0 0\nx' >huge.ptm
relume export ptm.exr --to ptm -o jpeg.ptm --quality 80
size=$(wc -c <jpeg.ptm)
head -c $((size / 2)) jpeg.ptm >cut.ptm
bad '.ptm of JPEG planes cut in half' 'cut.ptm: truncated in plane [0-9]+ of 18' cut.ptm
bad '.ptm that claims 1000000 x 1000000' 'huge.ptm: 1000000 x 1000000 pixels' huge.ptm
printf 'PTM_1.2\nPTM_FORMAT_LUM\n4\n4\n' >lum.ptm
bad '.ptm of another format' 'lum.ptm: format PTM_FORMAT_LUM is not supported' lum.ptm
printf 'PTM_1.2\nPTM_FORMAT_RGB\n4\n4\n1 1 nan 1 1 1\n0 0 0 0 0 0\n' >nan.ptm
bad '.ptm with nan' 'nan.ptm: scale' nan.ptm
printf 'PTM_1.2\nPTM_FORMAT_RGB\n4\n4\n1 1 1 1 1 1\n0 0 0 -9223372036854775808 0 0\n' >least.ptm
bad '.ptm with a bias that has no negative' 'least.ptm: bias' least.ptm
head -c $(($(wc -c <rti.rti) / 2)) rti.rti >cut.rti
bad '.rti cut in half' 'cut.rti: truncated; expected 43200 bytes of pixels' cut.rti
printf '#HSH1.2\n2\n4 4 3\n9 2 1\n' >sh.rti
bad '.rti of another kind' 'sh.rti: kind 2 is not supported' sh.rti
printf '#HSH1.2\n3\n4 4 3\n25 2 1\n' >many.rti
bad '.rti of 25 terms' 'many.rti: 25 terms' many.rti
folder() { fresh web-bilinear c; }
folder; rm c/plane_1.jpg
bad 'plane JPEG missing' 'c/plane_1.jpg: cannot be opened' c
folder; head -c 600 web-bilinear/plane_1.jpg >c/plane_1.jpg
bad 'plane JPEG cut' 'c/plane_1.jpg: not a whole JPEG' c
folder; cp dome/view00/light0001.png c/plane_1.jpg
bad 'plane that is no JPEG' 'c/plane_1.jpg: not a whole JPEG' c
folder; cp other/plane_0.jpg c/plane_1.jpg
bad 'plane JPEG of another size' 'c/plane_1.jpg: 24 x 24 pixels, 3 components; expected 40 x 40' c

# ---- deep zoom
relume export pca.exr --to deepzoom -o zoom
zoom() { fresh zoom c; }
zoom; rm c/plane_1_files/0/0_0.jpg
bad 'a tile that is missing' 'c/plane_1_files/0/0_0.jpg: no such tile; expected 1 x 1' c
zoom; rm c/plane_1.dzi
bad 'a plane that is missing' 'c/plane_1.jpg: ' c
describe() { zoom; sed "s/$1/$2/" zoom/plane_0.dzi >c/plane_0.dzi; }
describe 'Width="[0-9]*"' 'Width="39"'; bad 'tiles of another size' 'c/plane_0_files/0/0_0.jpg: [0-9]+ x [0-9]+ pixels, 3 components; expected 39 x' c
describe 'TileSize="[0-9]*"' 'TileSize="0"'; bad 'tiles of no size' 'c/plane_0.dzi: not a DeepZoom description' c
describe 'TileSize="[0-9]*"' 'TileSize="2"'; bad 'more tiles than there are' 'c/plane_0_files/[0-9]+/[0-9]+_[0-9]+.jpg: no such tile' c
describe 'Format="jpg"' 'Format="..\/x"'; bad 'tiles of another format' 'c/plane_0.dzi: tiles of another format; expected jpg' c
describe 'Width="[0-9]*"' 'Width="900000"'; bad 'a huge description' 'c/plane_0.dzi: 900000 x [0-9]+ pixels are over the limits' c
zoom; head -c 300 zoom/plane_0_files/0/0_0.jpg >c/plane_0_files/0/0_0.jpg
bad 'a tile cut short' 'c/plane_0_files/0/0_0.jpg: ' c
zoom; cp dome/view00/light0001.png c/plane_0.dzi
bad 'a picture in place of the description' 'c/plane_0.dzi: ' c

# ---- info.json
edit() { folder; sed "s/$1/$2/" web-bilinear/info.json >c/info.json; }
edit '"width"' '"width'; bad 'broken JSON' 'c/info.json: line 2' c
edit '"bilinear"' '"neural"'; bad 'unknown type' 'c/info.json: type; expected ptm' c
edit '"mrgb"' '"rgb"'; bad 'colour space that the type has not' 'c/info.json: colorspace' c
edit '"resolution": [0-9]*' '"resolution": 9'; bad 'basis of another resolution' 'c/info.json: basis; expected [0-9]+ numbers' c
edit '"nplanes": [0-9]*' '"nplanes": 300'; bad 'planes that are not there' 'c/(info.json|plane_[0-9]+.jpg): ' c
edit '"nplanes": [0-9]*' '"nplanes": -3'; bad 'negative planes' 'c/info.json: nplanes' c
edit '"width": 40' '"width": 1000000'; bad 'size that is not the JPEGs' 'c/plane_0.jpg: 40 x 40 pixels' c
edit '"scale"' '"scales"'; bad 'no scale' 'c/info.json: scale' c

no() { # name, status, pattern, options: export of pca.exr
    name=$1 status=$2 pattern=$3
    shift 3
    expect_fail "$name" "$status" "$pattern" out "$RELUME" export pca.exr -o out "$@"
}
no 'unknown format' 2 "did you mean 'rti'" --to rto
no 'unknown type' 2 "did you mean 'bilinear'" --type bilinaer
no 'type of a file' 2 'works only with --to relight' --to ptm --type rbf
no 'a quality of .rti' 2 'rti cannot hold JPEG' --to rti --quality 80
no 'other terms of .ptm' 2 '.ptm always has 6' --to lptm --coefficients 3
no 'a size of .rti' 2 'rti cannot hold JPEG' --to rti --bytes-per-pixel 1
no 'a size of .ptm out of reach' 1 'is too small; the smallest possible is' --to ptm --bytes-per-pixel 0.001
no 'a PSNR of .ptm out of reach' 1 'out: 99 dB cannot be reached.*the best is' --to lptm --psnr 99
no 'two targets' 2 'expected one of' --psnr 30 --quality 3
no 'a view that is not there' 2 'view 3; expected 0 to 0' --view 3
no 'mycc of a type without components' 2 'works only with --type bilinear' --type hsh --colorspace mycc
no 'mycc of two planes' 2 'expected at least 3' --colorspace mycc --coefficients 2
no 'terms that folders have not' 2 '16 coefficients; expected' --type hsh --coefficients 16
no 'terms that ptm has not' 2 '5 coefficients; expected 3 or 6' --type ptm --coefficients 5
no 'a PSNR out of reach' 1 'out: 99 dB cannot be reached.*the best is' --psnr 99
no 'a size out of reach' 1 'is too small; the smallest possible is' --bytes-per-pixel 0.001
expect_fail '.ptm of JPEG planes on a full device' 3 '/dev/full' - "$RELUME" export ptm.exr --to ptm -o /dev/full --quality 80
"$RELUME" export pca.exr -o full --quality 70 2>/dev/null
expect_fail 'a folder that is not empty' 2 'full: already exists' - "$RELUME" export pca.exr -o full
expect_ok 'a folder that is not empty, --force' - "$RELUME" export pca.exr -o full --force --quality 60
expect_fail '.ptm on a full device' 3 '/dev/full' - "$RELUME" export pca.exr --to ptm -o /dev/full
"$RELUME" synth box -o pano --projection spherical --size 16 --lights 6 -q 2>/dev/null &&
    "$RELUME" encode pano -o pano.exr --basis sh --coefficients 4 -q 2>/dev/null
if [ -s pano.exr ]; then
    expect_fail 'a panorama' 1 'panorama' out "$RELUME" export pano.exr -o out
else
    skip 'a panorama' 'none was made'
fi
finish
