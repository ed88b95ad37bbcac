#!/bin/sh
# A relume file coded again: as good as was asked for beside what the file shows, and with
# all that it has beside planes.
. "$(dirname "$0")/lib.sh"
"$RELUME" synth bust -o bust --size 48 --lights 12 --samples 1 -q
"$RELUME" synth attic -o room --size 24 --lights 12 --samples 1 -q
"$RELUME" synth teapot -o slab --size 24 --views 3x3 --lights 8 --samples 1 -q
"$sphere" masked --size 48 --lights 12 --hemisphere --mask --format png

for capture in bust room slab masked; do
    "$RELUME" encode $capture -o $capture.exr --basis pca --domain display --bits 12 -q
    expect_ok "$capture: 38 dB are 38 dB" "shows what $capture.exr shows at (37\.[5-9]|38\.[0-5]) dB PSNR .* lossy, 0\.[0-9]+ times" \
        "$RELUME" encode $capture.exr -o $capture.again.exr --psnr 38
    check "$capture: the file is sound" "$RELUME" check $capture.again.exr
    for what in views depth mask lights basis; do
        "$RELUME" info $capture.exr | grep "^$what " >first.txt
        "$RELUME" info $capture.again.exr | grep "^$what " >again.txt
        check "$capture: it keeps its $what" cmp first.txt again.txt
    done
done
"$RELUME" relight masked.again.exr -o relit.exr -q
"$RELUME" relight masked.exr -o before.exr -q
check 'pictures behind a mask agree' "$RELUME" compare before.exr relit.exr

"$RELUME" encode bust -o books.exr --basis pca --domain display --codebook 64 -q
expect_ok 'a codebook becomes planes' 'at (37\.[5-9]|38\.[0-5]) dB' "$RELUME" encode books.exr -o planes.exr --psnr 38
check 'which are sound' "$RELUME" check planes.exr
expect_ok 'bytes are kept' 'lossy' "$RELUME" encode bust.exr -o small.exr --bytes-per-pixel 5
below '--bytes-per-pixel keeps its size' "$(wc -c <small.exr)" $((48 * 48 * 5 + 1))
expect_ok 'a lossy file is coded again with a warning' 'is lossy already' "$RELUME" encode bust.again.exr -o twice.exr --effort fast
expect_ok 'a file without a wish is coded at 40 dB' 'at (39\.[5-9]|40\.[0-5]) dB' "$RELUME" encode bust.exr -o usual.exr
expect_fail 'which is no way without loss' 1 'encoded already; expected the capture.json' none.exr "$RELUME" encode bust.exr -o none.exr --lossless
expect_fail 'a model is no part of it' 2 'found --basis sh' none.exr "$RELUME" encode bust.exr -o none.exr --psnr 38 --basis sh
cp bust.exr kept.exr
expect_fail 'the file itself is not replaced' 2 'is read here and would be lost' - "$RELUME" encode kept.exr -o kept.exr --psnr 38
check 'and stays' cmp bust.exr kept.exr
finish
