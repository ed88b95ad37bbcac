#!/bin/sh
# `make figures`: the figures of Wong 1998, chapter 9, remade; the text is docs/figures.md.
# figures.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
set -eu
relume=$1/relume draw=$1/samples/figures out=$2 pictures=$3
rm -rf "$out"
mkdir -p "$out" "$pictures"

encode() { # capture, name, encode's options...
    capture=$out/$1 file=$out/$2.exr
    shift 2
    "$relume" encode "$capture" -o "$file" -q "$@"
}
relight() { # name, light: NAME.exr -> NAME-lit.exr
    "$relume" relight "$out/$1.exr" -o "$out/$1-lit.exr" --light "$2" --view 0
}
figure() { # number, row's arguments...
    file=$pictures/figure-$1.jpg
    shift
    "$draw" row "$file" "$@"
    echo "  $file"
}

# 30 zenith angles x 60 azimuths of one hemisphere (9.1.1)
awk 'BEGIN {
    pi = atan2(0, -1)
    for (i = 0; i < 30; i++)
        for (j = 0; j < 60; j++) {
            theta = (i + 0.5) / 30 * pi / 2; phi = j / 60 * 2 * pi
            printf "%.9f %.9f %.9f\n", sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)
        }
}' >"$out/grid.txt"
echo "A box and a ball under 1800 lights"
"$relume" synth box -o "$out/box" --size 96 --samples 4 --lights-from "$out/grid.txt" -q
encode box table --bits 16 --basis table
for k in 16 25 49 64; do encode box "sh$k" --bits 16 --basis sh --coefficients "$k"; done
encode box dct --bits 16 --basis dct --coefficients 64
encode box resampled --bits 16 --basis dct-resampled --coefficients 64
encode box pca --bits 16 --basis pca --coefficients 27

blobs() { # name, x, y, value at the picture's border
    "$draw" blob "$out/table.exr" "$2" "$3" "$4" "$out/$1-1.png"
    "$draw" blob "$out/table.exr" "$2" "$3" "$4" "$out/$1-2.png" 25
    "$draw" blob "$out/sh25.exr" "$2" "$3" "$4" "$out/$1-3.png"
}
blobs plane 48 52 0.8 # on the plane between box and ball
blobs ball 55 43 0.6  # on the ball's left side
figure 9-2 "$out/plane-1.png" "$out/plane-2.png" "$out/plane-3.png" \
    "$out/ball-1.png" "$out/ball-2.png" "$out/ball-3.png"

# One of the 1800: zenith angle 43.5 degrees, azimuth 114
light="dir -0.279979 0.628844 0.725374" square=38,60,32,32
for f in table sh16 sh25 sh49 sh64 resampled dct pca; do relight $f "$light"; done
figure 9-4 scale=4 "$out/sh16-lit.exr" "$out/sh25-lit.exr" "$out/sh49-lit.exr" "$out/table-lit.exr"

for f in table resampled dct; do "$draw" disc "$out/$f.exr" 48 52 "$out/$f-disc.exr"; done
figure 9-7 scale=6 "$out/table-disc.exr" "$out/resampled-disc.exr" "$out/dct-disc.exr"

"$draw" resampled "$out/table.exr" "$out/disc-lit.exr" "$light"
figure 9-8 scale=2 frame=$square "$out/table-lit.exr" frame= crop=$square scale=6 \
    "$out/table-lit.exr" "$out/disc-lit.exr" "$out/sh64-lit.exr" "$out/resampled-lit.exr" \
    "$out/dct-lit.exr" "$out/pca-lit.exr"
"$draw" errors "$out/table.exr" $square "$light" \
    "$out/sh64.exr" "$out/resampled.exr" "$out/dct.exr" "$out/pca.exr"

echo "A glazed teapot under 300 lights"
"$relume" synth teapot -o "$out/pot" --views 1x1 --lights 300 --hemisphere --size 192 --samples 4 -q
encode pot pot-table --basis table
relight pot-table "dir -0.8 0.3 1"
for k in 1 4 25; do
    encode pot "pot$k" --basis sh --coefficients "$k"
    relight "pot$k" "dir -0.8 0.3 1"
done
figure 9-3 crop=0,36,192,124 scale=2 "$out/pot1-lit.exr" "$out/pot4-lit.exr" "$out/pot25-lit.exr" \
    "$out/pot-table-lit.exr"

ramp="dir -0.3 0.4 1"
encode pot smooth --basis sh --coefficients 25
relight smooth "$ramp"
for n in 64 1024; do
    encode pot "contours$n" --basis sh --coefficients 25 --codebook $n
    encode pot "dithered$n" --basis sh --coefficients 25 --codebook $n --dither 1
    for f in contours$n dithered$n; do relight "$f" "$ramp"; done
done
figure 9-11 crop=72,64,68,68 scale=4 "$out/smooth-lit.exr" \
    "$out/contours64-lit.exr" "$out/dithered64-lit.exr" \
    "$out/contours1024-lit.exr" "$out/dithered1024-lit.exr"

for n in 64 1024; do
    for f in contours$n dithered$n; do
        printf '  %s ' "$f"
        "$relume" compare "$out/$f-lit.exr" "$out/smooth-lit.exr" --ramps --json
    done
done

echo "A light slab of the teapot: 9 eyes, 60 lights"
"$relume" synth teapot -o "$out/slab" --views 3x3 --lights 60 --size 128 -q
number() { sed -n "s/.*\"$1\":[ ]*\([0-9.]*\).*/\1/p" "$out/eval.json" | head -n 1; }
ratio() { # name, options...
    name=$1
    shift
    encode slab "$name" "$@"
    "$relume" eval "$out/$name.exr" "$out/slab" --json >"$out/eval.json"
    printf '  %-26s %8.1f : 1  %6.2f dB  pooled %6.2f dB  SSIM %.3f\n' "$name" "$(number ratio)" \
        "$(number psnr_db)" "$(number psnr_pooled_db)" "$(number ssim)"
}
ratio slab-sh25 --basis sh --coefficients 25
ratio slab-sh25-no-depth --basis sh --coefficients 25 --no-depth
for n in 256 1024 4096; do
    ratio slab-sh25-book$n --basis sh --coefficients 25 --codebook $n --share --no-depth
done
ratio slab-pca27-book4096 --basis pca --coefficients 27 --codebook 4096 --share --no-depth
