#!/bin/sh
# contours.sh BUILD [SIDE] - what --dither takes of the contours of a smooth ball and what it costs
# (docs/measurements/compression.md): ramp error and PSNR against the file without codebooks, mean of three lights,
# and bytes against the same codebook without dither.
set -eu
build=$(cd "$1" && pwd) side=${2:-256}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$build/samples/sphere" ball --size "$side" --lights 40 --hemisphere --shade lambert --format exr
relume() { "$build/relume" "$@" -q; }
encode() { relume encode ball --basis sh --coefficients 16 --domain display "$@"; }
encode -o plain.exr
i=0
for light in '0.5 0.3 0.8' '-0.4 0.5 0.7' '0.1 -0.6 0.6'; do
    i=$((i + 1))
    relume relight plain.exr -o plain$i.png --light "dir $light"
done
number() { sed -n "s/.*\"$1\": \{0,1\}\([-0-9.e+]*\).*/\1/p" compared.json | head -n 1; }
printf '%6s %7s %7s %7s %9s %7s\n' codes dither ramps PSNR bytes more
for codes in 64 128 256; do
    for dither in 0 0.1 0.3 1; do
        encode --codebook $codes --dither $dither -o books.exr
        ramps=0 psnr=0 i=0
        for light in '0.5 0.3 0.8' '-0.4 0.5 0.7' '0.1 -0.6 0.6'; do
            i=$((i + 1))
            relume relight books.exr -o books.png --light "dir $light"
            "$build/relume" compare books.png plain$i.png --ramps --json >compared.json
            ramps=$(echo "$ramps $(number ramp_error)" | awk '{ print $1 + $2 / 3 }')
            psnr=$(echo "$psnr $(number psnr_db)" | awk '{ print $1 + $2 / 3 }')
        done
        bytes=$(wc -c <books.exr)
        [ $dither = 0 ] && first=$bytes
        echo "$codes $dither $ramps $psnr $bytes $first" |
            awk '{ printf "%6d %7s %7.2f %7.1f %9d %+6.1f%%\n", $1, $2, $3, $4, $5, 100 * ($5 / $6 - 1) }'
    done
done
