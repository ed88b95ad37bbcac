#!/bin/sh
# The second reader of test_format.sh on every basis, interpolant, colour form and way of storing.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/format.sh"
lights="-0.3,-0.2,0.1 1,0,-0.3"  # low, and below the horizon
for basis in ptm "ptm --coefficients 3" hsh "hsh --coefficients 25 --ridge 1e-4" dct dct-resampled \
    pca eigen table; do
    both "dome --basis $basis" "9 8"
    both "photos --basis $basis --bits 10 --step common" "9 8"
done
for basis in "dct --coefficients 21" "dct-resampled --coefficients 21" "pca --coefficients 9" "eigen --coefficients 5"; do
    both "all --basis $basis --bits 12" "9 8"
    both "photos --basis $basis --bits 16 --domain linear" "9 8"
done
both "dome --basis pca --domain log" "9 8"
both "dome --basis eigen --domain log" "9 8"
both "photos --basis pca --coefficients 9 --domain log:0.02" "9 8"
for interpolant in $("$RELUME" encode --help | sed -n 's/.*table: \([a-z, ]*\).*/\1/p' | tr -d , | sed s,auto,,); do
    both "dome --basis pca --interpolant $interpolant" "9 8"
    both "dome --basis table --interpolant $interpolant --bits half" "9 8"
    [ "$interpolant" = hsh ] || both "all --basis pca --interpolant $interpolant" "9 8"
done
both "dome --basis auto --shadows no" "9 8"
both "all --basis table --interpolant auto --bits half" "9 8"
# the lights of web files: nodes of an octahedral grid
awk 'BEGIN { for (i = 0; i < 25; i++) { u = i % 5 / 2 - 1; v = int(i / 5) / 2 - 1; x = (u - v) / 2; y = (u + v) / 2
    z = 1 - (x < 0 ? -x : x) - (y < 0 ? -y : y); print x, y, z } }' >nodes.txt
"$RELUME" synth box -o nodes --size $size --lights-from nodes.txt --samples 1 -q
both "nodes --basis pca --interpolant octahedral" "9 8"
for basis in ptm hsh sh dct table; do
    both "dome --basis $basis --colour luminance" "9 8"
    both "photos --basis $basis --colour luminance --step common" "9 8"
done
both "all --basis sh --colour luminance --bits half" "9 8"

finish
