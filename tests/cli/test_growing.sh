#!/bin/sh
# A basis and a model of BTFs are one file and one line each: build/tests/growing/relume is the tool with
# tests/growing/*.c and a line in the list of bases, and of models (make/tests.mk), and nothing else.
. "$(dirname "$0")/lib.sh"
grown="$BUILD/tests/growing/relume"
[ -x "$grown" ] || { echo "skipped: the grown tool is not built (make build/tests/growing/relume)"; exit 0; }
"$sphere" cap --size 24 --lights 40 || exit 1

says() { name=$1 word=$2; shift 2; expect_ok "$name" - "$@"; grep -q "$word" out.txt || not_ok "$name" "no $word in: $(head -c 300 out.txt)"; }
says 'help knows the basis' linear "$grown" encode --help
expect_ok 'encode' - "$grown" encode cap -o linear.exr --basis linear
says 'the file names it' linear "$grown" info linear.exr
expect_ok 'relight' - "$grown" relight linear.exr -o linear.png --light "dir 1 0 1"
expect_ok 'eval' - "$grown" eval linear.exr cap --json
psnr=$(field psnr_db out.txt)
# 1, x, y and z span what harmonics of degree 1 span: the two fits differ by the ridge
"$grown" encode cap -o sh.exr --basis sh --coefficients 4 2>/dev/null
"$grown" eval sh.exr cap --json >sh.json
below 'it is as good as sh with four' "$(awk -v a="$psnr" -v b="$(field psnr_db sh.json)" 'BEGIN { d = a - b; print d < 0 ? -d : d }')" 0.1
says 'sweep' linear "$grown" sweep cap --basis linear,sh --coefficients 4 --leave-out 10 --csv
expect_fail 'the plain tool refuses the file' 1 linear - "$RELUME" info linear.exr

expect_ok 'fit a model' - "$grown" btf fit corduroy --size 8 --directions coarse --model mean -o mean
expect_ok 'evaluate it' - "$grown" btf eval mean corduroy --size 8 --directions coarse --json
expect_ok 'render it' - "$grown" btf render mean -o mean.png --eye 0,0,1 --light "dir 0 0 1"
says 'it is compared with the others' mean "$grown" btf compare corduroy --size 8 --directions coarse --models rfp,mean
finish
