#!/bin/sh
# The pictures of docs/glare.md. glare.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
# Those of photographs are left out where ../shared/data is not there.
set -eu
relume=$1/relume draw=$1/samples/figures out=$2 pictures=$3
data=../shared/data
candle=$data/exr-openexr-images/CandleGlass.exr night=$data/hdri-polyhaven-1k/night.hdr
mkdir -p "$out" "$pictures"
glare() { "$relume" glare "$@" -q; }
picture() { echo "  $pictures/$1"; }
subject() { # name, members
    printf '{"format": "relume-subject", "version": 1, %s}' "$2" >"$out/$1.json"
}
pattern="--size 1024 --luminance 1"

# the pattern, its aperture, the pupil in time (8.3) and the standard observer
glare --psf "$out/eye" $pattern
"$draw" row "$pictures/glare-pattern.jpg" "$out/eye/psf.png"
cp "$out/eye/pupil.png" "$pictures/glare-pupil.png"
cp "$out/eye/observer.png" "$pictures/glare-observer.png"
glare --psf "$out/wide" --width 4.2 --luminance 1 --size 640
"$draw" row "$pictures/glare-aperture.jpg" crop=34,34,572,572 "$out/wide/aperture.png"
picture 'glare-pattern.jpg, glare-aperture.jpg, glare-pupil.png, glare-observer.png'

# 8.6: without defocus, with 0.25 dioptres, with the printed distance
subject sharp '"optics": {"defocus_dpt": 0}'
glare --psf "$out/sharp.exr" --width 6 --luminance 1 --subject "$out/sharp.json"
glare --psf "$out/fresnel.exr" --width 6 --luminance 1
glare --psf "$out/literal.exr" --width 6 --luminance 1 --retina-distance
"$draw" row "$pictures/glare-8-6.jpg" crop=384,384,300,300 gain=6000 "$out/sharp.exr" \
    "$out/fresnel.exr" gain=300000 "$out/literal.exr"
picture glare-8-6.jpg

# 8.7: one plane and five
glare --psf "$out/one.exr" --size 1024 --width 6 --luminance 1
glare --psf "$out/five.exr" --size 1024 --width 6 --luminance 1 --planes 5
"$draw" row "$pictures/glare-8-7.jpg" crop=186,186,340,340 gain=50000 "$out/one.exr" "$out/five.exr"
picture glare-8-7.jpg

# 8.9: part after part, from the light to the edge of the field below it
all="cornea fibres lens vitreous lids" shown= rest=$all
n=0
for part in '' lids cornea lens fibres vitreous; do
    rest=$(for p in $rest; do [ "$p" = "$part" ] || printf '%s ' "$p"; done)
    glare --psf "$out/part$n.exr" --luminance 1 $(for p in $rest; do printf -- '--without %s ' "$p"; done)
    n=$((n + 1))
done
"$draw" row "$pictures/glare-8-9.jpg" gain=250000 crop=444,500,180,569 \
    "$out/part0.exr" "$out/part1.exr" "$out/part2.exr" "$out/part3.exr" "$out/part4.exr" "$out/part5.exr"
picture glare-8-9.jpg

# an attic with two lamps in view
"$relume" synth attic -q -o "$out/attic" --force --projection cylindrical --lights 36 --hemisphere \
    --size 448 --samples 2
"$relume" encode "$out/attic" -q -o "$out/attic.exr" --basis table
lamps() {
    "$relume" relight "$out/attic.exr" -q --pan 0 --zoom 1.2 --size 960x540 \
        --light "point 0.8 0.6 -2.2 rgb .3 .22 .12" \
        --light "spot -0.9 0.5 -1.5 0.4 -0.3 0.9 50 rgb .15 .2 .26" \
        --light "dir 0.5 0.7 -0.6 rgb .5 .5 .55" "$@"
}
lamps -o "$pictures/glare-attic.jpg" --pass glare --nits 20
picture glare-attic.jpg

[ -e "$candle" ] || exit 0
# a candle as it is and as it is seen, and 8.10: billboards against convolution
glare "$candle" -o "$out/bare.png" --fov 16 --size 64 --width 0.3 --no-veil --magnify 0.01
glare "$candle" -o "$out/seen.png" --fov 16
"$draw" row "$pictures/glare-candle.jpg" crop=140,120,620,560 "$out/bare.png" "$out/seen.png"
glare "$candle" -o "$out/billboard.png" --fov 16 --magnify 3 --mode billboard --threshold 40
glare "$candle" -o "$out/fft.png" --fov 16 --magnify 3
"$draw" row "$pictures/glare-8-10.jpg" crop=130,120,480,480 "$out/billboard.png" "$out/fft.png"
picture 'glare-candle.jpg, glare-8-10.jpg'

# one frame a second of the candle's four, as every thirtieth of --frames 120 --fps 30
rm -rf "$out/film" "$out/sparks"
glare "$candle" -o "$out/film" --fov 16 --magnify 3 --frames 4 --fps 1
glare "$candle" -o "$out/sparks" --fov 16 --magnify 3 --frames 4 --fps 1 --mode billboard --threshold 40
"$draw" row "$pictures/glare-film.jpg" columns=4 crop=247,220,240,240 "$out"/film/*.png "$out"/sparks/*.png
picture glare-film.jpg

# the night from inside its panorama, as it is and as it is seen
look="--pan -57 --tilt 6 --fov 30 --picture 620x350 --exposure -4.5 --border clamp"
glare "$night" -o "$out/night.png" $look --size 64 --width 0.3 --no-veil --magnify 0.01
glare "$night" -o "$out/night-seen.png" $look
"$draw" row "$pictures/glare-night.jpg" "$out/night.png" "$out/night-seen.png"
picture glare-night.jpg
