#!/bin/sh
# The viewer's frames against stored ones, drawn by OSMesa from stored files, so that neither the
# renderer nor the encoder has a say. `make golden` stores them anew, to be looked at. What differs
# is left in BUILD/golden: the frame, and how far it is off.
. "$(dirname "$0")/lib.sh"
golden=$TOP/tests/golden
cp -r "$golden"/*.exr "$golden"/*.script "$golden"/roof.obj "$golden"/cloth . || exit 1

view() { "$VIEWER" "$@" --gl osmesa --relight passes --no-config; }
view slab.exr --script frames.script || exit 1
view slab.exr --mesh roof.obj --material cloth --repeat 3 --size 96x96 --light 'dir -0.5 0.5 0.8' \
    --offscreen slab-object.png || exit 1
if [ "${STORE:-}" ]; then
    rm -f "$golden"/*.png
    cp ./*.png "$golden"
    finish
    exit
fi
rm -rf "$BUILD/golden"
for want in "$golden"/*.png; do
    frame=$(basename "$want")
    # Every value a code apart is 48 dB. Another Mesa may also put a few texels on the other side of
    # an edge: one in a thousand, wholly wrong, would be 30 dB, one in ten thousand 40.
    if cmp -s "$frame" "$want"; then ok "$frame"; continue; fi
    before=$failures
    above "$frame" "$("$RELUME" compare "$frame" "$want" -o difference.png | awk '$1 == "psnr_db" { print $2 }')" 38
    [ "$failures" -eq "$before" ] && continue
    mkdir -p "$BUILD/golden"
    cp "$frame" "$BUILD/golden"
    mv difference.png "$BUILD/golden/${frame%.png}-difference.png"
done
[ "$(ls ./*.png | grep -vc difference)" -eq "$(ls "$golden"/*.png | wc -l)" ] ||
    not_ok 'a stored frame for each' "$(ls ./*.png)"
finish
