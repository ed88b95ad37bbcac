#!/bin/sh
# export --to bc1, bc6h and bc7: eigenimages as textures, with what a shader needs.
. "$(dirname "$0")/lib.sh"
"$RELUME" synth teapot -o stage --projection planar --size 20 --lights 30 --samples 1 -q
"$RELUME" encode stage -o eigen.exr --basis eigen --domain log --coefficients 5 -q
for to in bc1 bc7 bc6h; do
    "$RELUME" export eigen.exr --to $to -o $to 2>note.txt || not_ok "export --to $to" "$(cat note.txt)"
    check "$to: five pictures and cubes" sh -c "[ \$(ls $to/eigenimage0?.dds | wc -l) = 5 ] && [ \$(ls $to/weight0?.dds | wc -l) = 5 ]"
    check "$to: what it means" grep -q "\"blocks\": \"$to\", \"curve\": \"log:0.01\"" $to/eigenimages.json
    check "$to: its JSON is sound" "${python:-true}" -c "import json; d = json.load(open('$to/eigenimages.json')); assert len(d['terms']) == 5 and d['width'] == 20"
    check "$to: the exponential comes last" grep -q 'return 0.00999999978 \* (exp(4.6' $to/relit.glsl
done
# 5 x 5 blocks; 400 pixels as three half floats are 2400 bytes; 30 of these beside five pictures
check 'bc1: 8 bytes a block' [ "$(wc -c <bc1/eigenimage00.dds)" = $((148 + 25 * 8)) ]
check 'bc7: 16' [ "$(wc -c <bc7/eigenimage00.dds)" = $((148 + 25 * 16)) ]
check 'bc6h: 16' [ "$(wc -c <bc6h/eigenimage00.dds)" = $((148 + 25 * 16)) ]
check 'bc6h: its number' [ "$(od -An -tu1 -j128 -N4 bc6h/eigenimage00.dds | tr -d ' ')" = 95000 ]
check 'cubes of 32' [ "$(wc -c <bc7/weight00.dds)" = $((148 + 6 * 32 * 32)) ]
"$RELUME" export eigen.exr --to bc1 -o again 2>note.txt
check 'sizes are said' grep -q '(12:1); the photographs .*(72:1)' note.txt
check 'and the loss' grep -q 'differs from the original by' note.txt
for to in bc7 bc6h; do
    for n in 1 3; do "$RELUME" export eigen.exr --to $to -o threads$n --threads $n -q --force; done
    check "$to: the same for any threads" diff -r threads1 threads3
done

# Half floats keep small values of a high dynamic range, where 8 bits of a range keep the large ones: 60.9 against 58.6 dB
"$RELUME" synth bust -o bright --projection planar --size 40 --lights 40 --samples 1 -q
"$RELUME" encode bright -o bright.exr --basis eigen --domain linear --bits half --coefficients 8 -q
loss() { "$RELUME" export bright.exr --to $1 -o bright-$1 2>&1 | sed -n 's/.*differs from the original by \([0-9.]*\) dB.*/\1/p'; }
above 'bc6h loses less than bc7' "$(loss bc6h)" "$(loss bc7 | awk '{ print $1 + 1.5 }')"

"$RELUME" encode stage -o pca.exr --basis pca --coefficients 5 -q
expect_fail 'components of all colours' 1 'textures; expected coefficients in three colours: encode with --basis eigen' no \
    "$RELUME" export pca.exr --to bc1 -o no
expect_fail 'a quality' 2 '--quality: textures have the size' no "$RELUME" export eigen.exr --to bc7 -o no --quality 90
expect_fail 'a file name' 2 '' no.ptm "$RELUME" export eigen.exr --to bc7 -o no.ptm
finish
