#!/bin/sh
# Import and export: what comes back, what an independent decoder sees, and what is refused.
. "$(dirname "$0")/lib.sh"
decoder="$TOP/tests/tools/relight_decode.py" python=
for p in python3 /usr/bin/python3; do
    [ "$python" ] || ! "$p" -c 'import numpy, PIL' 2>/dev/null || python=$p
done
if [ "$python" ]; then # one for all questions: most of a start is loading NumPy
    mkfifo asked answered
    "$python" "$decoder" --serve <asked >answered &
    exec 3>asked 4<answered
fi
decoder() { # arguments: what the independent decoder answers
    echo "$@" >&3
    read -r answer <&4 && echo "$answer"
}
decoded_alike() { # name, file of another format, relume file of it
    if [ -z "$python" ]; then
        skip "$1" 'no python3 with numpy and Pillow'
        return
    fi
    light="-0.6 0.2 0.5"
    relume relight "$3" -o a.png --light "dir $light"
    # both round the same sum, in single and in double precision
    below "$1, light $light" "$(decoder --apart "$2" $light a.png)" 1
}
psnr() { # relume file, relume file: under one light
    relume relight "$1" -o a.png --light 'dir 0.4 0.3 0.8'
    relume relight "$2" -o b.png --light 'dir 0.4 0.3 0.8'
    "$RELUME" compare a.png b.png --json >c.json
    field psnr_db c.json
}
promised() { sed -n 's/.*differs from the original by \([0-9.]*\) dB.*/\1/p' note.txt; }
"$sphere" dome --size 40 --lights 40 --hemisphere --format png || exit 1
relume encode dome -o pca.exr --basis pca --coefficients 27
relume encode dome -o ptm.exr --basis ptm --coefficients 6
relume encode dome -o lptm.exr --basis ptm --coefficients 6 --colour luminance
relume encode dome -o hsh.exr --basis hsh --coefficients 9
relume encode dome -o hsh16.exr --basis hsh --coefficients 16

# ---- a level of a pyramid: what relight shows at that size, by another way
"$sphere" large --size 150 --lights 9 --hemisphere --format jpg
relume encode large -o large.exr --basis ptm --pyramid yes
relume export large.exr -o half.ptm --level 1
relume import half.ptm -o half.exr
relume relight half.exr -o a.png --light 'dir 0.3 0.4 0.8'
relume relight large.exr -o b.png --size 75 --light 'dir 0.3 0.4 0.8'
"$RELUME" compare a.png b.png --json >c.json
above 'a level of a pyramid' "$(field psnr_db c.json)" 50 # .ptm has 8 bits; here 61 dB
relume export large.exr -o half.web --level 1
relume import half.web -o half.web.exr
"$RELUME" info half.web.exr >info.txt
check 'a folder of a level has its size' grep -q '75 x 75' info.txt
expect_fail 'a level that is not there' 2 'level 2; expected 0 to 1' x.ptm "$RELUME" export large.exr -o x.ptm --level 2
expect_fail 'a level of no pyramid' 2 'level 1; the file has no pyramid' x.ptm "$RELUME" export ptm.exr -o x.ptm --level 1

# ---- .ptm and .rti: a fit once, then the same codes for ever
for kind in ptm lptm rti rti16; do
    source=$kind.exr extension=ptm terms=
    case $kind in rti*) source=hsh${kind#rti}.exr extension=rti ;; esac
    [ $kind = rti16 ] && terms='--coefficients 16'
    "$RELUME" export $source --to ${kind%16} $terms -o $kind.$extension 2>note.txt || not_ok "export --to $kind" "$(cat note.txt)"
    relume import $kind.$extension -o $kind-back.exr
    above "$kind: the fit is what was promised" "$(psnr $source $kind-back.exr)" "$(awk -v p="$(promised)" 'BEGIN { print p - 4 }')"
    expect_ok "$kind: exported again" 'copied unchanged: nothing is lost' "$RELUME" export $kind-back.exr --to ${kind%16} $terms -o again.$extension
    same "$kind: import and export give the same bytes" $kind.$extension again.$extension
    decoded_alike "$kind: an independent decoder" $kind.$extension $kind-back.exr
    rm again.$extension
done
# 8 bits of a basis against 8 bits of the same functions
above 'a ptm file keeps its quality as .ptm' "$(psnr ptm.exr ptm-back.exr)" 40
expect_ok 'the basis is fitted where it differs' 'differs from the original' "$RELUME" export pca.exr --to rti -o pca.rti --coefficients 4

# ---- JPEG planes that predict each other, by an independent writer
for kind in ptm lptm; do
    if [ -z "$python" ]; then
        skip "$kind: predicted planes" 'no python3 with numpy and Pillow'
        continue
    fi
    decoder --predict $kind.ptm predicted.ptm >counts.txt
    above "$kind: planes predicted by inversion" "$(cut -d ' ' -f 1 counts.txt)" 1
    above "$kind: planes with side information" "$(cut -d ' ' -f 2 counts.txt)" 1
    relume import predicted.ptm -o predicted.exr
    decoded_alike "$kind: predicted planes" predicted.ptm predicted.exr
    above "$kind: predicted planes are close to the raw ones" "$(psnr $kind-back.exr predicted.exr)" 35
done

# ---- JPEG planes of our own
for kind in ptm lptm; do
    for quality in 70 90; do
        file=$kind-$quality.ptm
        "$RELUME" export $kind-back.exr --to $kind -o $file --quality $quality 2>note.txt || not_ok "export --to $kind --quality" "$(cat note.txt)"
        below "$file: half of the raw file at most" "$(wc -c <$file)" $(($(wc -c <$kind.ptm) / 2))
        relume import $file -o jpeg.exr
        above "$file: as good as was promised" "$(psnr $kind-back.exr jpeg.exr)" "$(awk -v p="$(promised)" 'BEGIN { print p - 5 }')"
        decoded_alike "$file: an independent decoder" $file jpeg.exr
    done
    [ -z "$python" ] && continue
    decoder --planes $file $kind.ptm >counts.txt
    read -r predicted inverted recorded wrapped progressive off <counts.txt
    above "$kind: predicted planes are written" "$predicted" 3
    below "$kind: no pixel leaves a byte without a record, all planes are baseline" $((wrapped + progressive)) 0
done
relume export ptm-back.exr --to ptm -o small.ptm --bytes-per-pixel 8
below 'a .ptm of a given size' "$(wc -c <small.ptm)" $((8 * 40 * 40))
"$RELUME" export lptm-back.exr --to lptm -o fine.ptm --psnr 36 2>note.txt
above 'a .ptm of a given PSNR' "$(promised)" 36
below 'and of no more' "$(promised)" 38
for n in 1 3; do relume export ptm-back.exr --to ptm -o threads$n.ptm --quality 80 --threads $n; done
same '.ptm of JPEG planes with 1 and 3 threads' threads1.ptm threads3.ptm
"$sphere" odd --size 37 --lights 12 --hemisphere --format png
relume encode odd -o odd.exr --basis ptm --coefficients 6
expect_ok 'a width that RTIViewer cannot read is reported' 'warning: odd.ptm: width 37 is not a multiple of 8' "$RELUME" export odd.exr --to lptm -o odd.ptm --quality 80

# ---- relight folders of every type
for kind in bilinear rbf bilinear:mycc rbf:mycc ptm lptm hsh sh ptm:ycc hsh:ycc sh:ycc; do
    type=$(echo $kind | tr -d :) space=rgb
    case $kind in *:*) space=${kind#*:} ;; esac
    "$RELUME" export pca.exr -o web-$type --type ${kind%:*} --colorspace $space --quality 95 2>note.txt || not_ok "export --type $type" "$(cat note.txt)"
    relume import web-$type -o web-$type.exr
    decoded_alike "folder $type: an independent decoder" web-$type web-$type.exr
    above "folder $type: as good as was promised" "$(psnr pca.exr web-$type.exr)" "$(awk -v p="$(promised)" 'BEGIN { print p - 5 }')"
done
# relight writes nan for a light that its list gives no direction; what else is in the folder is shown
lights=$(sed -n 's/.*"lights": \[\([^,]*, [^,]*, [^,]*\),.*/\1/p' web-rbf/info.json)
for kind in rbf ptm; do
    cp -r web-$kind nan-$kind && sed -i "s/\"lights\": \[$lights/\"lights\": [-nan, -nan, nan/; s/\"width\"/\"size\": [nan, inf], &/" nan-$kind/info.json
    expect_ok "nan in a folder, $kind" 'info.json: holds nan' "$RELUME" relight nan-$kind -o nan-$kind.png --light 'dir -0.5 -0.2 0.8'
    relume relight web-$kind.exr -o number-$kind.png --light 'dir -0.5 -0.2 0.8'
    above "nan in a folder, $kind: the picture" "$("$RELUME" compare nan-$kind.png number-$kind.png | awk '$1 == "psnr_db" { print $2 }')" 50
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
expect_ok 'linear coefficients are exported as sRGB codes' 'differs from the original' "$RELUME" export linear.exr -o web-linear --quality 95
relume import web-linear -o web-linear.exr
# between its lights the file blends linear values, the folder sRGB codes: shadows' edges differ
above 'linear coefficients: a close picture' "$(psnr linear.exr web-linear.exr)" 24
relume encode dome -o books.exr --basis pca --coefficients 9 --codebook 64
expect_ok 'codebooks are exported' 'differs from the original' "$RELUME" export books.exr -o web-books --quality 95
relume import web-books -o web-books.exr
above 'codebooks: a close picture' "$(psnr books.exr web-books.exr)" 26

# ---- without a wish the quality is so high that its error is not seen, and is said
expect_ok 'a quality is chosen' 'quality (9[5-9]|100) .chosen.' "$RELUME" export pca.exr -o chosen
q=$(sed -n 's/.* quality \([0-9]*\) .*/\1/p' err.txt)
relume export pca.exr -o by-hand --quality "$q"
check 'the same by hand' diff -r -x .relume chosen by-hand
check 'info.json says it' grep -q "\"quality\": $q" chosen/info.json
relume export pca.exr -o threads --threads 3
check 'any number of threads' diff -r -x .relume chosen threads

# ---- deep zoom, as OpenLIME 1.2.6 asks for it. With T and W x H of the .dzi it counts
#     n = ceil(log2(max(W, H) / T)) + 1
# levels and asks level l, from 0, which is one tile, to n - 1, the whole picture, for the tiles
# x < ceil((W >> n - 1 - l) / T) and y alike: plane_N_files/l/x_y.jpg.
dzi() { sed -n "s/.*$1=\"\([0-9a-z]*\)\".*/\1/p" "$2"; }
asked() { # folder
    awk -v w="$(dzi Width "$1/plane_0.dzi")" -v h="$(dzi Height "$1/plane_0.dzi")" \
        -v t="$(dzi TileSize "$1/plane_0.dzi")" 'BEGIN {
        side = (w > h ? w : h) / t
        n = log(side) / log(2); n = (n == int(n) ? n : int(n) + (n > 0)) + 1
        for (l = 0; l < n; l++) {
            cut = 2 ^ (n - 1 - l); width = int(w / cut); height = int(h / cut)
            for (x = 0; x * t < width; x++)
                for (y = 0; y * t < height; y++)
                    print "plane_0_files/" l "/" x "_" y ".jpg"
        }
        print n >"levels.txt" }'
}
for side in 300 509 60; do # two levels; a half of 254.5 pixels; a picture below half a tile
    "$sphere" big --size $side --lights 12 --hemisphere --format png
    relume encode big -o big.exr --basis pca --coefficients 6
    rm -rf zoom
    "$RELUME" export big.exr --to deepzoom -o zoom --quality 95 2>note.txt || not_ok 'export --to deepzoom' "$(cat note.txt)"
    asked zoom >asked.txt
    missing=
    while read -r f; do [ -s zoom/$f ] || missing="$missing $f"; done <asked.txt
    if [ -s asked.txt ] && [ -z "$missing" ]; then ok "deep zoom of $side: every tile that OpenLIME asks for"; else not_ok "deep zoom of $side: every tile that OpenLIME asks for" "missing:$missing"; fi
    tiles=$(find zoom/plane_0_files -type f | wc -l)
    if [ "$tiles" -eq "$(wc -l <asked.txt)" ]; then ok "deep zoom of $side: no other tile"; else not_ok "deep zoom of $side: no other tile" "$tiles of $(wc -l <asked.txt)"; fi
    if [ "$(ls zoom/plane_0_files | wc -l)" -eq "$(cat levels.txt)" ]; then ok "deep zoom of $side: no other level"; else not_ok "deep zoom of $side: no other level" "$(ls zoom/plane_0_files)"; fi
    relume import zoom -o zoom.exr
    above "deep zoom of $side is read back, as good as was promised" "$(psnr big.exr zoom.exr)" "$(awk -v p="$(promised)" 'BEGIN { print p - 4 }')"
done
if ls zoom/plane_*.jpg >/dev/null 2>&1; then not_ok 'deep zoom: no whole planes' "$(ls zoom)"; else ok 'deep zoom: no whole planes'; fi
decoded_alike 'deep zoom of one tile: an independent decoder' zoom zoom.exr
for p in zoom/plane_*_files; do mv $p/0 $p/6; done # 60 pixels are halved six times down to one
relume import zoom -o six.exr
same 'levels that begin with one pixel' zoom.exr six.exr

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

finish
