#!/bin/sh
# Codebooks on the command line: what is written is what is read, by the library and by the second
# reader; what goes wrong says so in one line.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/format.sh"

both "dome --basis sh --coefficients 9 --codebook 40" "9 8"
both "dome --basis sh --coefficients 16 --bits 16 --codebook 30 --stages 3" "9 8"
both "dome --basis sh --coefficients 16 --codebook 30 --split luma --bits half" "9 8"
both "dome --basis sh --coefficients 9 --codebook 20 --split luma --stages 2 --bits 10" "9 8"
both "dome --basis sh --coefficients 9 --codebook 20 --split product:3 --bits 12" "9 8"
both "dome --basis pca --coefficients 9 --codebook 50 --domain display" "9 8"
both "dome --basis pca --coefficients 9 --codebook 50 --split product:2 --domain display" "9 8"
both "photos --basis ptm --colour luminance --codebook 50" "9 8"

# ---- a slab: one set for all views, or one for each
"$RELUME" synth teapot -o slab --size $size --views 2x2 --lights 20 --samples 1 -q
uv=$(sed -n 's/.*"uv": \[\([^]]*\)\].*/\1/p' slab/capture.json | sed -n 3p | tr -d ,)
for share in '' --share; do
    relume encode slab -o slab.exr --basis sh --codebook 60 --stages 2 $share
    agree "a slab ${share:-without --share}" slab.exr 2 "$(slab_ray $uv 14 13)" 14 13
    "$RELUME" info slab.exr --json >info.json
    want='"books": 2, "codes": 60, "shared": false'
    [ "$share" ] && want='"books": 2, "codes": 60, "shared": true'
    if grep -q "$want" info.json; then ok "info: $want"; else not_ok "info: $want" "$(cat info.json)"; fi
done
"$RELUME" info slab.exr >info.txt
if grep -q '^codebooks     2 of 60 vectors, for all views$' info.txt; then ok 'info in words'; else not_ok 'info in words' "$(cat info.txt)"; fi

# ---- without depth
relume encode slab -o flat.exr --basis sh --codebook 60 --no-depth
"$RELUME" info flat.exr --json >info.json
if grep -q '"depth": false' info.json; then ok '--no-depth'; else not_ok '--no-depth' "$(cat info.json)"; fi
below '--no-depth is smaller' "$(wc -c <flat.exr)" "$(($(wc -c <slab.exr) - 1000))"

# ---- more codes, more stages: better; as many codes as pixels: as good as planes
relume encode dome -o planes.exr --basis sh --coefficients 9 --bits 16
relume encode dome -o few.exr --basis sh --coefficients 9 --bits 16 --codebook 8
relume encode dome -o more.exr --basis sh --coefficients 9 --bits 16 --codebook 64
relume encode dome -o stages.exr --basis sh --coefficients 9 --bits 16 --codebook 8 --stages 3
relume encode dome -o all.exr --basis sh --coefficients 9 --bits 16 --codebook $((size * size))
planes=$(eval_field planes.exr dome rms)
few=$(eval_field few.exr dome rms)
below 'more codes are better' "$(eval_field more.exr dome rms)" "$(awk -v r="$few" 'BEGIN { print .7 * r }')"
below 'more stages are better' "$(eval_field stages.exr dome rms)" "$(awk -v r="$few" 'BEGIN { print .9 * r }')"
below 'a code for every pixel loses nothing' "$(eval_field all.exr dome rms)" "$(awk -v r="$planes" 'BEGIN { print r + 1e-4 }')"

# ---- what encode says is what the file does: measured on two rows of 16, hence half a decibel
as_said() { # name, capture, option...
    name=$1 from=$2
    shift 2
    "$RELUME" encode "$from" -o said.exr "$@" 2>err.txt || not_ok "$name" "$(cat err.txt)"
    said=$(sed -n 's/.*reproduces your photographs at \([-0-9.]*\) dB.*/\1/p' err.txt)
    found=$("$RELUME" eval said.exr "$from" | awk '$1 == "PSNR" { print $2 }')
    below "$name: $said dB" "$(awk -v a="${said:-99}" -v b="$found" 'BEGIN { print (a > b ? a - b : b - a) }')" 0.5
}
"$sphere" round --size 96 --lights 16 --hemisphere
as_said 'eight vectors' round --basis pca --coefficients 12 --codebook 8
as_said 'two stages in linear light' round --basis pca --coefficients 12 --codebook 32 --stages 2 --domain linear
"$RELUME" synth box -o wide --size 96 --views 2x1 --lights-from round/dirs.lp --samples 1 -q
as_said 'vectors for all views' wide --basis pca --coefficients 9 --codebook 12 --share

# ---- the same bytes for any number of threads; another seed, other bytes
for n in 1 2 7; do
    relume encode dome -o "e$n.exr" --codebook 20 --codebook-start random --seed 3 --dither 1 --threads $n
done
same '1 and 2 threads' e1.exr e2.exr
same '1 and 7 threads' e1.exr e7.exr
relume encode dome -o seed.exr --codebook 20 --codebook-start random --seed 4 --dither 1
differ 'another seed' e1.exr seed.exr

# ---- relight: lights add up, threads and plain C do not matter
relume relight few.exr -o a.exr --light 'dir 1 0 1'
relume relight few.exr -o b.exr --light 'dir 0 1 2'
relume relight few.exr -o ab.exr --light 'dir 1 0 1' --light 'dir 0 1 2' --threads 1
relume relight few.exr -o c.exr --light 'dir 1 0 1' --light 'dir 0 1 2' --cpu-mask 0
"$mkimage" sum sum.exr a.exr b.exr
below 'two lights are the sum of each' "$("$mkimage" maxdiff ab.exr sum.exr)" 1e-5
below '--cpu-mask 0' "$("$mkimage" maxdiff ab.exr c.exr)" 1e-5
"$RELUME" compare a.exr b.exr --ramps --json >c.json
above 'compare --ramps' "$(field ramp_error c.json)" 0

# ---- errors
expect_fail 'more codes than pixels' 1 "dome: a codebook of 600 codes for $((size * size)) pixels" no.exr "$RELUME" encode dome -o no.exr --codebook 600
expect_fail 'luma of joint coefficients' 2 'basis pca has no planes per colour' no.exr "$RELUME" encode dome -o no.exr --basis pca --coefficients 4 --codebook 20 --split luma
expect_fail 'luminance and two books' 2 'expected one book' no.exr "$RELUME" encode dome -o no.exr --basis sh --colour luminance --codebook 20 --stages 2
expect_fail 'too many books' 2 'at most 8 together' no.exr "$RELUME" encode dome -o no.exr --codebook 20 --stages 5 --split luma
expect_fail 'a split of another name' 2 "found 'chroma'" no.exr "$RELUME" encode dome -o no.exr --codebook 20 --split chroma
expect_fail 'options of codebooks without one' 2 'expected together with --codebook' no.exr "$RELUME" encode dome -o no.exr --share
expect_fail 'more groups than coefficients' 2 '5 groups of 4 coefficients' no.exr "$RELUME" encode dome -o no.exr --basis sh --coefficients 4 --codebook 20 --split product:5

# ---- an index beyond its book: the first sample of view0000 in a file without compression
relume encode dome -o raw.exr --codebook 5 --compression none
cp raw.exr bad.exr
if [ "$python" ]; then
    "$python" - <<'PY'
import struct
b = bytearray(open("bad.exr", "rb").read())
n = 24
want = struct.pack("<ii", 0, n * 4)  # a line's header: y, bytes; indices are one UINT a pixel
part = struct.pack("<i", 2)          # part number: preview, book0, view0000
at = b.find(part + want)
b[at + 12 : at + 16] = struct.pack("<I", 5)
open("bad.exr", "wb").write(b)
PY
    expect_fail 'an index beyond its book' 1 'bad.exr: an index; expected indices below' no.exr "$RELUME" relight bad.exr -o no.exr
else
    skip 'an index beyond its book' 'no python3'
fi
finish
