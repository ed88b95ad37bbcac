#!/bin/sh
# Import and export: what comes back, what an independent decoder sees, and what is refused.
. "$(dirname "$0")/lib.sh"
relume() { "$RELUME" "$@" -q 2>err.txt || not_ok "relume $1 $2" "$(cat err.txt)"; }
decoder="$TOP/tests/tools/relight_decode.py" python=
for p in python3 /usr/bin/python3; do
    [ "$python" ] || ! "$p" -c 'import numpy, PIL' 2>/dev/null || python=$p
done
codes_apart() { # picture, picture: largest difference in 8-bit codes
    "$python" -c "
import sys, numpy as np
from PIL import Image
a, b = (np.asarray(Image.open(f).convert('RGB'), int) for f in sys.argv[1:])
print(abs(a - b).max())" "$1" "$2"
}
decoded_alike() { # name, file of another format, relume file of it
    if [ -z "$python" ]; then
        skip "$1" 'no python3 with numpy and Pillow'
        return
    fi
    for light in '0.5 0.3 0.7' '-0.8 0.1 0.3'; do
        relume relight "$3" -o a.png --light "dir $light"
        "$python" "$decoder" "$2" $light b.png
        # both round the same sum, in single and in double precision
        below "$1, light $light" "$(codes_apart a.png b.png)" 1
    done
}
psnr() { # relume file, relume file: under one light
    relume relight "$1" -o a.png --light 'dir 0.4 0.3 0.8'
    relume relight "$2" -o b.png --light 'dir 0.4 0.3 0.8'
    "$RELUME" compare a.png b.png --json >c.json
    field psnr_db c.json
}
promised() { sed -n 's/.*; \([0-9.]*\) dB from.*/\1/p' note.txt; }
"$sphere" dome --size 40 --lights 40 --hemisphere --format png || exit 1
relume encode dome -o pca.exr --basis pca --coefficients 27
relume encode dome -o ptm.exr --basis ptm --coefficients 6
relume encode dome -o lptm.exr --basis ptm --coefficients 6 --colour luminance
relume encode dome -o hsh.exr --basis hsh --coefficients 9
relume encode dome -o hsh16.exr --basis hsh --coefficients 16

# ---- .ptm and .rti: a fit once, then the same codes for ever
for kind in ptm lptm rti rti16; do
    source=$kind.exr extension=ptm terms=
    case $kind in rti*) source=hsh${kind#rti}.exr extension=rti ;; esac
    [ $kind = rti16 ] && terms='--coefficients 16'
    "$RELUME" export $source --to ${kind%16} $terms -o $kind.$extension 2>note.txt || not_ok "export --to $kind" "$(cat note.txt)"
    relume import $kind.$extension -o $kind-back.exr
    above "$kind: the fit is what was promised" "$(psnr $source $kind-back.exr)" "$(awk -v p="$(promised)" 'BEGIN { print p - 4 }')"
    expect_ok "$kind: exported again" 'codes as they are' "$RELUME" export $kind-back.exr --to ${kind%16} $terms -o again.$extension
    same "$kind: import and export give the same bytes" $kind.$extension again.$extension
    decoded_alike "$kind: an independent decoder" $kind.$extension $kind-back.exr
    rm again.$extension
done
# 8 bits of a basis against 8 bits of the same functions
above 'a ptm file keeps its quality as .ptm' "$(psnr ptm.exr ptm-back.exr)" 40
expect_ok 'the basis is fitted where it differs' 'dB from the file' "$RELUME" export pca.exr --to rti -o pca.rti --coefficients 4

# ---- JPEG planes that predict each other, by an independent writer
for kind in ptm lptm; do
    if [ -z "$python" ]; then
        skip "$kind: predicted planes" 'no python3 with numpy and Pillow'
        continue
    fi
    "$python" "$decoder" --predict $kind.ptm predicted.ptm >counts.txt
    above "$kind: planes predicted by inversion" "$(cut -d ' ' -f 1 counts.txt)" 1
    above "$kind: planes with side information" "$(cut -d ' ' -f 2 counts.txt)" 1
    relume import predicted.ptm -o predicted.exr
    decoded_alike "$kind: predicted planes" predicted.ptm predicted.exr
    above "$kind: predicted planes are close to the raw ones" "$(psnr $kind-back.exr predicted.exr)" 35
done

# ---- relight folders of every type
for kind in bilinear rbf bilinear:mycc rbf:mycc ptm lptm hsh sh ptm:ycc hsh:ycc sh:ycc; do
    type=$(echo $kind | tr -d :) space=rgb
    case $kind in *:*) space=${kind#*:} ;; esac
    "$RELUME" export pca.exr -o web-$type --type ${kind%:*} --colorspace $space --quality 95 2>note.txt || not_ok "export --type $type" "$(cat note.txt)"
    relume import web-$type -o web-$type.exr
    decoded_alike "folder $type: an independent decoder" web-$type web-$type.exr
    above "folder $type: as good as was promised" "$(psnr pca.exr web-$type.exr)" "$(awk -v p="$(promised)" 'BEGIN { print p - 5 }')"
done
# the chroma b of this sphere is below zero on average, which the bytes of a folder's mean cannot be
for space in rgb mycc; do
    "$RELUME" export pca.exr -o same --colorspace $space --bytes-per-pixel 4 --force 2>note.txt
    promised >$space.txt
done
# (1.4 dB below here: its hard shadow and small size ask for more planes)
above 'signed means of chroma: mycc is nearly as good as rgb' "$(cat mycc.txt)" "$(awk '{ print $1 - 2 }' rgb.txt)"
if grep -q ICC_PROFILE web-*/plane_*.jpg; then not_ok 'no profile in coefficient planes' "$(grep -l ICC_PROFILE web-*/plane_*.jpg)"; else ok 'no profile in coefficient planes'; fi
for target in 0.5 1.5; do
    "$RELUME" export pca.exr -o size --bytes-per-pixel $target --force 2>note.txt
    below "--bytes-per-pixel $target is not exceeded" "$(cat size/plane_*.jpg | wc -c | awk '{ print $1 / 1600 }')" $target
done
"$RELUME" export pca.exr -o size --psnr 28 --force 2>note.txt
above '--psnr is reached' "$(promised)" 28
for n in 1 2 7; do relume export pca.exr -o threads$n --quality 80 --threads $n; done
for f in info.json plane_0.jpg plane_3.jpg; do
    same "$f with 1 and 2 threads" threads1/$f threads2/$f
    same "$f with 1 and 7 threads" threads1/$f threads7/$f
done
relume encode dome -o linear.exr --basis table --domain linear --bits half
expect_ok 'linear coefficients are exported as sRGB codes' 'dB from the file' "$RELUME" export linear.exr -o web-linear --quality 95
relume import web-linear -o web-linear.exr
# between its lights the file blends linear values, the folder sRGB codes: shadows' edges differ
above 'linear coefficients: a close picture' "$(psnr linear.exr web-linear.exr)" 24
relume encode dome -o books.exr --basis pca --coefficients 9 --codebook 64
expect_ok 'codebooks are exported' 'dB from the file' "$RELUME" export books.exr -o web-books --quality 95
relume import web-books -o web-books.exr
above 'codebooks: a close picture' "$(psnr books.exr web-books.exr)" 26

# ---- deep zoom
"$sphere" big --size 300 --lights 12 --hemisphere --format png
relume encode big -o big.exr --basis pca --coefficients 6
relume export big.exr --to deepzoom -o zoom
for f in info.json plane_0.dzi plane_0_files/0/0_0.jpg plane_0_files/9/0_0.jpg plane_0_files/9/1_1.jpg; do
    if [ -s zoom/$f ]; then ok "deep zoom: $f"; else not_ok "deep zoom: $f" "$(find zoom | head -n 20)"; fi
done
if ls zoom/plane_*.jpg >/dev/null 2>&1; then not_ok 'deep zoom: no whole planes' "$(ls zoom)"; else ok 'deep zoom: no whole planes'; fi

# ---- relight's own files, where they are at hand
samples=${RELUME_DATA:-$TOP/../shared/data}/relight-outputs/test
if [ -d "$samples" ]; then
    for type in ptm lptm hsh rbf27 bilinear18 ycc1044; do
        relume import "$samples/$type" -o sample.exr
        decoded_alike "relight's $type" "$samples/$type" sample.exr
    done
else
    skip "relight's own files" "no $samples"
fi

# ---- refused, with a sentence
bad() { # name, pattern, input
    expect_fail "$1" 1 "$2" out.exr "$RELUME" import "$3" -o out.exr
}
bad 'nothing there' 'no such file' nothing.ptm
bad 'another kind of file' 'not a format to import' dome/dirs.lp
bad 'a folder without info.json' 'info.json: cannot be opened' dome
size=$(wc -c <ptm.ptm)
head -c $((size / 2)) ptm.ptm >cut.ptm
bad '.ptm cut in half' 'cut.ptm: truncated; expected 28800 bytes of pixels, found [0-9]+' cut.ptm
head -c 40 ptm.ptm >cut.ptm
bad '.ptm cut in its header' 'cut.ptm: .*expected' cut.ptm
: >cut.ptm
bad 'empty .ptm' 'cut.ptm: not a polynomial' cut.ptm
printf 'PTM_1.2\nPTM_FORMAT_RGB\n1000000\n1000000\n1 1 1 1 1 1\n0 0 0 0 0 0\nx' >huge.ptm
bad '.ptm that claims 1000000 x 1000000' 'huge.ptm: claims 1000000 x 1000000' huge.ptm
printf 'PTM_1.2\nPTM_FORMAT_LUM\n4\n4\n' >lum.ptm
bad '.ptm of another format' 'lum.ptm: format PTM_FORMAT_LUM is not supported' lum.ptm
printf 'PTM_1.2\nPTM_FORMAT_RGB\n4\n4\n1 1 nan 1 1 1\n0 0 0 0 0 0\n' >nan.ptm
bad '.ptm with nan' 'nan.ptm: scale' nan.ptm
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
folder; cp zoom/plane_0_files/9/0_0.jpg c/plane_1.jpg
bad 'plane JPEG of another size' 'c/plane_1.jpg: 255 x 255 pixels, 3 components; expected 40 x 40' c
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
no 'type of a file' 2 'only for --to relight' --to ptm --type rbf
no 'two targets' 2 'expected one of' --psnr 30 --quality 3
no 'a view that is not there' 2 'view 3; expected 0 to 0' --view 3
no 'mycc of a type without components' 2 'only for --type bilinear' --type hsh --colorspace mycc
no 'mycc of two planes' 2 'expected at least 3' --colorspace mycc --coefficients 2
no 'terms that folders have not' 2 '16 coefficients; expected' --type hsh --coefficients 16
no 'terms that ptm has not' 2 '5 coefficients; expected 3 or 6' --type ptm --coefficients 5
no 'a PSNR out of reach' 1 'out: 99 dB cannot be reached.*found at most' --psnr 99
no 'a size out of reach' 1 'cannot be reached; found at least' --bytes-per-pixel 0.001
mkdir full; : >full/file
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
