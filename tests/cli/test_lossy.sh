#!/bin/sh
# Planes coded with loss: the quality or size that was asked for is what `eval` finds, in rooms,
# on surfaces, in slabs and behind masks; what cannot be done or read is one line.
. "$(dirname "$0")/lib.sh"

"$RELUME" synth bust -o bust --size 40 --lights 12 --samples 1 -q
"$RELUME" synth attic -o room --size 24 --lights 12 --samples 1 -q
"$RELUME" synth teapot -o slab --size 24 --views 3x3 --lights 8 --samples 1 -q

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

# ---- efforts: the same quality; more time never takes more bytes
"$RELUME" synth bust -o wide --size 160 --lights 16 --samples 1 -q
for effort in fast usual smallest; do
    relume encode wide -o $effort.exr --effort $effort --psnr 36
    is_near "effort $effort: 36 dB are 36 dB" $effort.exr wide 36
    relume check $effort.exr >/dev/null
done
below 'usual is smaller than fast' "$(wc -c <usual.exr)" "$(wc -c <fast.exr)"
below 'smallest is smaller than usual' "$(wc -c <smallest.exr)" "$(wc -c <usual.exr)"
expect_ok 'an effort alone leaves the quality open' 'coded with loss' "$RELUME" encode wide -o alone.exr --effort fast
relume encode wide -o lossless.exr --lossless
relume encode wide -o default.exr
same 'the default is lossless' lossless.exr default.exr
below 'an effort alone is smaller' "$(wc -c <alone.exr)" $(($(wc -c <lossless.exr) / 2))
expect_fail 'lossless with a quality' 2 'expected without --psnr' none.exr "$RELUME" encode wide -o none.exr --lossless --psnr 38

# ---- bytes, asked for and kept
relume encode bust -o small.exr --bytes-per-pixel 6 --no-depth
below '--bytes-per-pixel keeps its size' "$(wc -c <small.exr)" $((40 * 40 * 6 + 1))
relume encode bust -o large.exr --bytes-per-pixel 9 --no-depth
below 'more bytes are used' "$(wc -c <small.exr)" "$(wc -c <large.exr)"
# three groups of views have three heads, and what shadows move by is there once
"$RELUME" synth teapot -o groups --size 24 --views 4x4 --lights 5 --samples 1 -q
relume encode groups -o groups.exr --bytes-per-pixel 3.5 --shadows yes
below 'groups, shadows: the size is kept' "$(wc -c <groups.exr)" $((24 * 24 * 16 * 7 / 2 + 1))
below 'groups, shadows: the size is used' $((24 * 24 * 16 * 7 / 2 * 95 / 100)) "$(wc -c <groups.exr)"

# ---- what cannot be had is said
expect_ok 'too low a quality' 'dB PSNR .*; its coarsest coding is better than 10 dB' "$RELUME" encode bust -o worst.exr --psnr 10 --force
expect_ok 'too few bytes' 'it needs more than 0.001 bytes a pixel' "$RELUME" encode bust -o worst.exr --bytes-per-pixel 0.001 --force
expect_ok 'too many bytes' 'its finest coding needs less than 100 bytes a pixel' "$RELUME" encode bust -o best.exr --bytes-per-pixel 100 --force

# ---- components or pictures: as good as the better of the two, which a closer search may miss by
# a tenth of a decibel; pictures by an interpolant that uses all lights and smooths nothing
pooled() { "$RELUME" eval "$1" bust --json -q | sed 's/.*"psnr_pooled_db": \([-0-9.]*\).*/\1/'; }
for basis in pca table; do relume encode bust -o $basis.exr --basis $basis --bytes-per-pixel 6 --no-depth; done
better=$(printf '%s\n' "$(pooled pca.exr)" "$(pooled table.exr)" | sort -n | tail -1)
if awk "BEGIN { exit !($(pooled small.exr) > $better - 0.1) }"; then ok 'the better basis is chosen'; else not_ok 'the better basis is chosen' "$(pooled small.exr) dB; expected $better"; fi
if "$RELUME" info room.exr | grep -q '^interpolant   chord$'; then ok 'pictures are seen between lights as components are'; else not_ok 'pictures are seen between lights as components are' "$("$RELUME" info room.exr)"; fi

# of 64 lights the components look few, but for the shadows each is a picture
"$RELUME" synth bust -o lamps --size 24 --lights 64 --samples 1 -q
relume encode lamps -o lamps.exr --psnr 36 --no-depth
relume encode lamps -o lamps-pca.exr --psnr 36 --no-depth --basis pca
below 'hard shadows of many lights are kept as pictures' "$(wc -c <lamps.exr)" $(($(wc -c <lamps-pca.exr) * 3 / 4))
is_near 'and as good' lamps.exr lamps 36

# ---- the same file whatever the threads
relume encode slab -o one.exr --psnr 34 --threads 1
same 'threads change nothing' one.exr slab.exr

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
fails 2 'an effort and bits' encode bust -o x.exr --effort fast --bits 8
fails 2 'a target and codebooks' encode bust -o x.exr --psnr 34 --codebook 16
size=$(wc -c <large.exr)
cp large.exr bad.exr
printf '\377\377\377\377' | dd of=bad.exr bs=1 seek=$((size - size / 8)) conv=notrunc 2>/dev/null
fails 1 'a damaged tile' relight bad.exr -o bad.png

# ---- one of two tiles, pixels 512 to 527, is lost alone, with its name
for i in 0 1 2; do "$mkimage" cmyk p$i.jpg 528 8 $((40 + 60 * i)) 90 $((200 - 50 * i)) 20; done
printf '3\np0.jpg 0 0 1\np1.jpg 0.6 0 0.8\np2.jpg 0 0.6 0.8\n' >two.lp
relume encode two.lp -o two.exr --psnr 40 --basis table
relume relight two.exr -o two.png
cp two.exr bad.exr
at=$(($(wc -c <two.exr) - 40)) # the check sums take 28
printf 'spoiled!' | dd of=bad.exr bs=1 seek=$at conv=notrunc 2>/dev/null
tile="the tile in column 1, row 0 of part 'view0000'"
expect_fail 'a lost tile is named' 1 "bad.exr: damaged: $tile; expected .*--keep-going" bad.png "$RELUME" relight bad.exr -o bad.png
check 'the rest is shown' "$RELUME" relight bad.exr -o rest.png --keep-going
"$RELUME" relight bad.exr -o rest.png --keep-going 2>err.txt
if [ "$(grep -c "warning: bad.exr: damaged: $tile; shown without it" err.txt)" = 1 ]; then ok 'with one warning'; else not_ok 'with one warning' "$(cat err.txt)"; fi
for x in 0 511; do
    if [ "$("$mkimage" read rest.png $x 3)" = "$("$mkimage" read two.png $x 3)" ]; then ok "pixel $x is as it was"; else not_ok "pixel $x is as it was" "$("$mkimage" read rest.png $x 3)"; fi
done
if [ "$("$mkimage" read rest.png 520 3)" = "$("$mkimage" read two.png 520 3)" ]; then not_ok 'pixel 520 is lost' 'it is as it was'; else ok 'pixel 520 is lost'; fi
"$RELUME" check bad.exr >out.txt 2>err.txt
if [ $? = 1 ] && [ "$(head -n 1 out.txt)" = "bad.exr: part 'group0000', rows 0 to 0: missing or damaged" ] &&
    grep -qx "bad.exr: part 'view0000', tile in column 1, row 0 (pixels 512,0 to 527,7): damaged" out.txt && [ "$(wc -l <out.txt)" = 2 ]; then ok 'check names the tile'; else not_ok 'check names the tile' "$(cat out.txt err.txt)"; fi
if "$RELUME" check bad.exr --json 2>err.txt | grep -q '"column": 1, "row": 0, "x": 512, "y": 0, "width": 16, "height": 8}'; then ok 'and as JSON'; else not_ok 'and as JSON' "$(cat err.txt)"; fi
check 'info reads no tiles' "$RELUME" info bad.exr
check 'whole files have no lost tiles' "$RELUME" check two.exr

# ---- as coarse as is not seen
"$sphere" tiny --size 16 --lights 4 >/dev/null
expect_ok 'the smallest file by what is seen' 'differ by less than .* JND' "$RELUME" encode tiny -o seen.exr --basis pca --jnd 20
"$RELUME" eval seen.exr tiny --jnd --json >eval.json
below 'its worst photograph differs by no more' "$(field jnd_99_worst eval.json)" 20
above 'and hardly less' "$(field jnd_99_worst eval.json)" 12
relume encode tiny -o fine.exr --basis pca --psnr 50
check 'it is smaller than a fine one' test "$(wc -c <seen.exr)" -lt "$(wc -c <fine.exr)"
expect_fail 'a PSNR besides' 2 'expected without --psnr' none.exr "$RELUME" encode tiny -o none.exr --jnd 20 --psnr 40
finish
