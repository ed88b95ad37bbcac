#!/bin/sh
# Planes coded with loss: the quality or size that was asked for is what `eval` finds, in rooms,
# on surfaces, in slabs and behind masks; what cannot be done or read is one line.
. "$(dirname "$0")/lib.sh"

"$RELUME" synth bust -o bust --size 64 --lights 20 --samples 1 -q
"$RELUME" synth attic -o room --size 32 --lights 12 --samples 1 -q
"$RELUME" synth teapot -o slab --size 32 --views 3x3 --lights 8 --samples 1 -q

# within 0.3 dB: half a step of the quantiser, and what rows of 32 pixels leave to chance
is_near() { # name FILE CAPTURE DB
    got=$("$RELUME" eval "$2" "$3" --json | sed 's/.*"psnr_pooled_db": \([-0-9.]*\).*/\1/')
    if awk "BEGIN { exit !($got > $4 - 0.3 && $got < $4 + 0.3) }"; then ok "$1"; else not_ok "$1" "$got dB; expected $4"; fi
}

for capture in bust room slab; do
    relume encode $capture -o $capture.exr --psnr 34
    is_near "$capture: 34 dB are 34 dB" $capture.exr $capture 34
    "$RELUME" info $capture.exr >info.txt
    if grep -q '^storage       12 bits, av1$' info.txt; then ok "$capture: info names the coding"; else not_ok "$capture: info names the coding" "$(cat info.txt)"; fi
    if grep -q '0.01 % from rounding' info.txt; then not_ok "$capture: info says what coding costs" "$(cat info.txt)"; else ok "$capture: info says what coding costs"; fi
    relume check $capture.exr >/dev/null
done

# ---- bytes, asked for and kept
relume encode bust -o small.exr --bytes-per-pixel 6 --no-depth
below '--bytes-per-pixel keeps its size' "$(wc -c <small.exr)" $((64 * 64 * 6 + 1))
relume encode bust -o large.exr --bytes-per-pixel 9 --no-depth
below 'more bytes are used' "$(wc -c <small.exr)" "$(wc -c <large.exr)"

# ---- the same file whatever the threads
relume encode slab -o one.exr --psnr 34 --threads 1
relume encode slab -o two.exr --psnr 34 --threads 2
same 'threads change nothing' one.exr two.exr

# ---- wrong use, and damage
fails() { # status name COMMAND ...
    want=$1 name=$2
    shift 2
    "$RELUME" "$@" >out.txt 2>err.txt
    got=$?
    if [ $got = "$want" ] && [ "$(wc -l <err.txt)" = 1 ]; then ok "$name"; else not_ok "$name" "status $got: $(cat err.txt)"; fi
}
fails 2 'two targets' encode bust -o x.exr --psnr 34 --bytes-per-pixel 1
fails 2 'a target and bits' encode bust -o x.exr --psnr 34 --bits 8
fails 2 'a target and codebooks' encode bust -o x.exr --psnr 34 --codebook 16
size=$(wc -c <large.exr)
cp large.exr bad.exr
printf '\377\377\377\377' | dd of=bad.exr bs=1 seek=$((size - size / 8)) conv=notrunc 2>/dev/null
fails 1 'a damaged tile' relight bad.exr -o bad.png
finish
