#!/bin/sh
# What encode chooses by itself: domain, coefficients and storage by error, and one light as it is.
. "$(dirname "$0")/lib.sh"
data=$TOP/../shared/data
told() { sed -n "s/.*\"$1\": \"*\([^\",]*\).*/\1/p" told.json; }
encode() { # capture, options: into e.exr, its facts into told.json, its sentence into said.txt
    "$RELUME" encode "$@" -o e.exr 2>said.txt && "$RELUME" info e.exr --json >told.json
}
psnr() { "$RELUME" eval "$1" "$2" -q | sed -n 's/^PSNR *\([0-9.]*\) dB (mean.*/\1/p'; }

# A ball in few lights is reproduced by what was always chosen.
"$sphere" ball --size 32 --lights 12 --hemisphere
encode ball --shadows no
check 'a smooth thing: 27 coefficients' [ "$(told coefficients)" = 27 ]
check 'in 8 bits' [ "$(told bits)" = 8 ]
check 'one sentence reports it' grep -q '^relume: e.exr: reproduces your photographs at [0-9.]* dB PSNR (differences [a-z ]*) with 27 coefficients, 8 bits, lossless, [0-9.]* bytes a pixel; unseen light directions: about [0-9]* dB; with --psnr 38 it is several times smaller$' said.txt
"$RELUME" synth box -o matte --size 32 --lights 60 --hemisphere -q
"$RELUME" encode matte -o e.exr --coefficients 4 --bits 8 2>said.txt
seen=$(sed -n 's/.*photographs at \([0-9.]*\) dB.*/\1/p' said.txt)
below 'few coefficients: lights never seen are not said to be shown better than those that were' \
    "$(sed -n 's/.*directions: about \([0-9]*\) dB.*/\1/p' said.txt)" "$(echo "$seen" | awk '{ print $1 + 0.5 }')"

# Sun through slats: 22 dB in linear light with 27 coefficients.
scene="attic --projection cylindrical --size 32 --samples 4"
"$RELUME" synth $scene -o hard --lights 40 -q
"$RELUME" synth $scene -o unseen --lights 10 --pattern random --seed 7 -q
"$RELUME" encode hard -o usual.exr --basis pca --interpolant auto --domain linear --bits 8 -q
encode hard --threads 1
cp e.exr one.exr
above 'hard shadows are met to 38 dB' "$(psnr e.exr hard)" 38
below 'which the usual choice does not' "$(psnr usual.exr hard)" 30
above 'unseen lights gain too' "$(psnr e.exr unseen)" "$(psnr usual.exr unseen)"
encode hard --coefficients 90 --lossless
said=$(sed -n 's/.*photographs at \([0-9.]*\) dB.*/\1/p' said.txt)
above 'what is said is what eval says' "$said" "$(psnr e.exr hard | awk '{ print $1 - 1 }')"  # a row in 8
below 'to a decibel' "$said" "$(psnr e.exr hard | awk '{ print $1 + 1 }')"
check 'components: in the display domain' [ "$(told domain)" = display ]
components=$(wc -c <e.exr)
# Components as many as shadows ask for took more bytes than the pictures, and between the lamps 0.7 of the light, grey.
encode hard --threads 3
check 'equal bytes for any threads' cmp one.exr e.exr
check 'the pictures, where they are smaller' [ "$(told basis) $(told domain)" = 'table linear' ]
below 'in fewer bytes' "$(wc -c <e.exr)" "$components"
under_unseen() { # the mean under all lights of `unseen`, 1 = the first file's
    set -- "$1" $(sed -n '/directions/,/]$/s/^ *\[\(.*\), \(.*\), \(.*\)\].*/--light dir_\1_\2_\3/p' unseen/capture.json)
    file=$1 && shift
    for word; do shift && set -- "$@" "$(echo "$word" | tr _ ' ')"; done
    "$RELUME" relight "$file" -o sum.pfm "$@" -q 2>/dev/null
    tail -n +4 sum.pfm | od -An -v -tf4 | awk '{ for (i = 1; i <= NF; i++) s += $i } END { print s }'
}
"$RELUME" encode unseen -o truth.exr --basis table --bits half -q
light=$(awk "BEGIN { print $(under_unseen e.exr) / $(under_unseen truth.exr) }")
above 'light between the lamps is kept' "$light" 0.9  # 0.7 by components of the display domain
below 'and none is added' "$light" 1.1
encode hard --domain linear --coefficients 40 --bits 16
check 'what is asked for stays' [ "$(told domain) $(told coefficients) $(told bits)" = 'linear 40 16' ]
encode hard --quality 24
check 'fewer coefficients for less' [ "$(told coefficients)" -lt 27 ]
above 'as good as was asked' "$(psnr e.exr hard)" 23.5  # judged on samples
expect_fail 'quality of another basis' 2 'quality' no.exr "$RELUME" encode hard -o no.exr --quality 30 --basis sh
expect_fail 'quality and coefficients' 2 'quality' no.exr "$RELUME" encode hard -o no.exr --quality 30 --coefficients 9

# One picture of high dynamic range: as half floats, of which 2^-11 is the step.
"$sphere" light --size 32 --lights 1 --hemisphere
"$mkimage" gain light/view00/light0000.exr bright.exr 1e6 && mv bright.exr light/view00/light0000.exr
encode light
check 'one light: its picture' [ "$(told basis) $(told bits)" = 'table half' ]
above 'beyond 65504, without loss' "$(psnr e.exr light)" 80

# One lamp pixel, a thousand times brighter than the rest: codebooks had even steps of 8 bits.
"$sphere" lamp --size 32 --lights 1 --hemisphere
"$mkimage" poke lamp/view00/light0000.exr lit.exr 16 16 1000 && mv lit.exr lamp/view00/light0000.exr
encode lamp --codebook 512
check 'a codebook of such a picture: half floats' [ "$(told bits)" = half ]
encode ball --codebook 64
check 'of a usual one: 8 bits' [ "$(told bits)" = 8 ]

# A photograph for the screen: 8 bits.
"$sphere" photo --size 32 --lights 1 --hemisphere --format png
encode photo
check 'a photograph: 8 bits' [ "$(told basis) $(told bits) $(told domain)" = 'table 8 display' ]

# ---- lossy by default, where nobody sees it and coding is quick
"$sphere" seen --size 96 --lights 24 --hemisphere --format jpg
encode seen --lossless
whole=$(wc -c <e.exr) unseen=$(sed -n 's/.*directions: about \([0-9]*\) dB.*/\1/p' said.txt)
check 'lossless is said' grep -q ' bits, lossless, ' said.txt
encode seen
check 'by default with loss' grep -q 'coded with loss' said.txt
check 'in AV1 pictures' [ "$(told compression)" = av1 ]
below 'in a third of the bytes' "$(wc -c <e.exr)" $((whole / 3))
above 'at 38 dB' "$(psnr e.exr seen)" 38
above 'unseen lights are shown as well' "$(sed -n 's/.*directions: about \([0-9]*\) dB.*/\1/p' said.txt)" $((unseen - 1))
cp e.exr default.exr
encode seen --effort usual
check 'which is the usual effort' cmp default.exr e.exr
for option in '--bits 8' '--step common' '--compression zip' '--quality 38' '--domain linear' '--basis pca'; do
    encode seen $option --threads 1
    check "lossless by $option" [ "$(told compression)" != av1 ]
done
"$sphere" bright --size 96 --lights 24 --hemisphere
for i in 3 4 5; do "$mkimage" gain bright/view00/light000$i.exr lit.exr 40 && mv lit.exr bright/view00/light000$i.exr; done
encode bright --highlights no
check 'high dynamic range: lossless' [ "$(told compression)" != av1 ]

# Real maps, at several exposures: peaks of thousands, and shadows.
for map in hdri-polyhaven-1k/studio.hdr exr-openexr-images/StageEnvLatLong.exr; do
    if [ ! -f "$data/$map" ]; then skip "$map" 'no shared data'; continue; fi
    "$RELUME" panorama "$data/$map" -o map --force -q 2>/dev/null
    "$mkimage" gain "$data/$map" truth.exr 1
    "$RELUME" encode map -o e.exr -q
    "$RELUME" relight e.exr -o e.relit.exr -q
    for ev in -8 0 4; do
        factor=$(awk -v e=$ev 'BEGIN { print 2^e }')
        "$mkimage" gain e.relit.exr a.exr "$factor" && "$mkimage" gain truth.exr b.exr "$factor"
        above "$map at $ev EV" "$("$RELUME" compare a.exr b.exr | awk '$1 == "psnr_db" { print $2 }')" 55
    done
done
finish
