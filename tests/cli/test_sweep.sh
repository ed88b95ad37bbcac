#!/bin/sh
# relume sweep: the grid, its outputs, going on after an interruption, wrong options.
. "$(dirname "$0")/lib.sh"
"$sphere" cap --size 24 --lights 20 --hemisphere --format png || exit 1
"$sphere" held --size 24 --lights 7 --pattern random --seed 5 --hemisphere --format png
"$sphere" small --size 16 --lights 7 --hemisphere
mkdir tmp
export TMPDIR="$work/tmp"
sweep="$RELUME sweep cap --leave-out 5"
grid="--basis pca,sh,table --coefficients 4,9 --bits 8,half"

# ---- domains beside each other, each picture at its own exposure
expect_ok 'domains' - $sweep --basis eigen --coefficients 4 --domain linear,log:0.05 --tone-map --json
check 'a row of each' sh -c 'grep -c "\"basis\": \"eigen\"" out.txt >/dev/null && grep -o "\"domain\": \"[a-z:0-9.]*\"" out.txt | tr "\n" " " | grep -q "linear.*linear.*log:0.05"'
check 'and it is said' grep -q '"tone_mapped": true' out.txt
$sweep --basis eigen --coefficients 4 --domain linear,log,log:0.01,linear,log:0.05 --tone-map --csv -q | awk -F, 'NR > 1 { print $1, $16 }' >names.txt
printf 'eigen linear linear\neigen log log\neigen log:0.05 log:0.05\n' >want.txt
same 'rows are told apart, and none comes twice' names.txt want.txt

# ---- outputs
expect_ok 'sweep' - $sweep $grid -o out --json
cp out.txt out1.json
same 'OUT.json is what --json prints' out1.json out.json
if [ "$(grep -o '"basis"' out.json | wc -l)" -eq 10 ]; then ok 'rows: 2 x 2 x 2 and table x 2'; else not_ok 'rows' "$(cat out.json)"; fi
if [ "$(awk -F, 'NF != 16' out.csv | wc -l)" -eq 0 ] && [ "$(wc -l <out.csv)" -eq 11 ]; then ok 'CSV has 16 columns and 11 lines'; else not_ok 'CSV' "$(cat out.csv)"; fi
if grep -q '"hull": true' out.json; then ok 'the hull is marked'; else not_ok 'hull' "$(cat out.json)"; fi
for f in bytes bytes_per_pixel psnr_before_db psnr_db psnr_pooled_db ssim; do
    above "sweep: $f" "$(field $f out.json)" 1e-6
done
expect_ok 'the PNG is a picture' - "$RELUME" compare out.png out.png --json
if [ "$python" ]; then
    check 'JSON parses, without NaN' "$python" -c 'import json, sys; json.load(open("out.json"), parse_constant=sys.exit)'
    check 'SVG is well-formed' "$python" -c 'import xml.dom.minidom as x; assert x.parse("out.svg").documentElement.tagName == "svg"'
else
    skip 'JSON and SVG' 'no python3'
fi
expect_ok '--csv' - $sweep $grid --csv
if [ "$(head -n 1 out.txt | cut -d, -f1)" = coder ]; then ok '--csv has a header'; else not_ok '--csv' "$(cat out.txt)"; fi
expect_ok 'a second capture' - "$RELUME" sweep cap --test held --basis sh --coefficients 9 --json
"$RELUME" encode cap -o sh9.exr --basis sh --coefficients 9 2>/dev/null
"$RELUME" eval sh9.exr held --json | sed 's/, "per_light.*//' >e.json
for f in psnr_db psnr_pooled_db ssim; do
    below "sweep --test is encode and eval: $f" "$(awk -v a="$(field $f out.txt)" -v b="$(field $f e.json)" 'BEGIN { d = a - b; print d < 0 ? -d : d }')" 0.01
done
if [ "$(field bytes out.txt)" = "$(field file_bytes e.json)" ]; then ok 'bytes are those of the file'; else not_ok 'bytes' "$(field bytes out.txt), $(field file_bytes e.json)"; fi
awk 'NR == 1 { print 5; next } NR < 7 { print $1, cos(NR), sin(NR), 1 }' small/dirs.lp >small/ring.lp
expect_ok 'a ring of lamps' 'all 5 lamps stand on one ring' "$RELUME" sweep small/ring.lp --leave-out 2 --basis pca,sh --coefficients 1,4 --json
check 'is one warning for all rows and folds' test "$(grep -c 'stand on one ring' err.txt)" -eq 1
no_times() { sed 's/"seconds": [0-9.e-]*//g' "$1"; }
for n in 1 7; do "$RELUME" sweep cap $grid --json --threads $n -q | sed 's/"seconds": [0-9.e-]*//g' >t$n.json; done
same 'sweep with 1 and 7 threads' t1.json t7.json

# ---- coders that share what they learn from are those that are made alone
rows() { cut -d, -f1-12,15 | grep -v '^coder'; }
$sweep --basis auto,pca,sh --coefficients 4,9 --bits 8,half --csv -q | rows >together.csv
for b in auto pca sh; do for k in 4 9; do for w in 8 half; do $sweep --basis $b --coefficients $k --bits $w --csv -q; done; done; done | rows >alone.csv
same 'rows of one sweep and of one for each' together.csv alone.csv

expect_ok 'auto, interpolants, luminance, codebooks' - $sweep --basis auto,pca,table,sh --coefficients 4 --interpolant auto,tps --colour rgb,luminance --codebook 0,32 --stages 2 --csv
for r in auto,4,8,plane,0 auto,4,8,-,32 'pca auto' 'pca tps,4,8,plane,0' 'table auto,20,8,plane,0' 'table tps,20,8,-,32' sh,4,8,plane,0 'sh luminance,4,8,plane,0'; do
    case $r in
    'pca auto') if grep -q "^$r" out.txt; then not_ok 'pca auto is auto' "$(cat out.txt)"; else ok 'pca auto is auto'; fi ;;
    *) if grep -q "^$r" out.txt; then ok "a row $r"; else not_ok "a row $r" "$(cat out.txt)"; fi ;;
    esac
done
if grep -q '^sh luminance,4,8,-,32,.*expected one book' out.txt; then ok 'luminance and several codebooks: a reason'; else not_ok 'luminance and codebooks' "$(cat out.txt)"; fi

# ---- rows that cannot be measured are named, the others are there
expect_ok 'sizes that a basis does not have' - $sweep --basis sh,ptm --coefficients 4,6
check 'have a row, too' sh -c 'grep -q "^sh  *6 .*skipped: .*coefficients" out.txt && grep -q "^ptm  *4 .*skipped: .*coefficients" out.txt'
expect_fail 'sizes that no basis has' 2 'none of the bases has that many; .*ptm has 3 6; sh has 1 4 9' - $sweep --basis ptm,sh --coefficients 7
expect_ok 'more coefficients than lights' - $sweep --basis sh --coefficients 9,16 --json
if grep -q '"coefficients": 16.*"skipped": "16 coefficients of basis sh need at least 16 lights; found 15"' out.txt; then ok 'the reason is given'; else not_ok 'the reason is given' "$(cat out.txt)"; fi
# No usual size at all: it was a crash while the diagram was drawn.
"$RELUME" synth box -o few --size 4 --lights 3 --hemisphere --samples 1 -q
expect_ok 'a basis that wants more lights' - "$RELUME" sweep few --basis ptm -o fewer
check 'it says so' grep -q 'ptm .*skipped: 6 coefficients of basis ptm need at least 6 lights; found 2' out.txt
expect_ok 'nothing can be measured' - $sweep --basis sh --coefficients 36 -o none
[ -e none.svg ] && not_ok 'no diagram without points' 'none.svg exists'

# ---- a photograph that cannot be read, at whatever time, is no reason to leave out a row
reading_fails() {
    n=2 failed=0
    while
        rm -f hit
        LD_PRELOAD="$BUILD/tests/tools/faults.so" RELUME_FAULT=read:$n+:5 RELUME_FAULT_HIT="$work/hit" RELUME_FAULT_UNDER="$work/small" \
            "$RELUME" sweep small -q --leave-out 3 --basis sh --coefficients 1,4 >out.txt 2>err.txt
        status=$?
        [ -e hit ]
    do
        [ $status = 1 ] && failed=$((failed + 1))
        if [ $status = 0 ] && grep -q skipped out.txt; then not_ok "reading number $n fails" "$(cat out.txt)"; fi
        n=$((n + 5))
    done
    above 'readings that fail end the sweep' $failed 3
}
case $BUILD in
*asan* | *tsan*) skip 'readings that fail' 'sanitizers want to be loaded first' ;;
*) if [ -e "$BUILD/tests/tools/faults.so" ]; then reading_fails; else skip 'readings that fail' 'tests/tools/faults.so is not built'; fi ;;
esac

# ---- resume: equal seconds mean that nothing was measured again
expect_ok 'sweep again' - $sweep $grid -o out --json
same 'finished rows are reused' out.txt out1.json
expect_ok 'a larger grid' - $sweep $grid,16 -o out --json
if [ "$(grep -o '"seconds": [^,]*' out1.json | while read -r s; do grep -cF "$s" out.txt; done | sort -u)" = 1 ]; then ok 'its known rows are reused'; else not_ok 'its known rows are reused' "$(cat out.txt)"; fi
cp out.resume kept.resume
sed '2s/0x1/0x2/' kept.resume >out.resume
expect_ok 'a broken line' 'out.resume: some lines are damaged' $sweep $grid -o out --json
no_times out.txt >a.json
no_times out1.json >b.json
same 'its row is measured again' a.json b.json
head -c 700 kept.resume >out.resume
expect_ok 'a line cut short' 'out.resume: some lines are damaged' $sweep $grid -o out --json
no_times out.txt >a.json
same 'the rows are right' a.json b.json
touch -d '2001-01-01' cap/view00/light0003.png
expect_ok 'an image has changed' 'some lines are damaged' $sweep $grid -o out --json
differ 'everything is measured again' out.txt out1.json
echo 'my notes' >notes.resume
cp notes.resume notes.copy
expect_ok 'a foreign file' 'notes.resume: not written by relume sweep' $sweep --basis sh --coefficients 4 -o notes
same 'a foreign file is left alone' notes.resume notes.copy
: >void.resume
expect_ok 'an empty file' - $sweep --basis sh --coefficients 4 -o void

# ---- Ctrl-C keeps finished rows and nothing else
case $BUILD in *asan* | *tsan*) size=24 ;; *) size=64 ;; esac
"$sphere" long --size $size --lights 50
rm -rf stop.*
"$RELUME" sweep long --basis pca,sh,dct --bits 8,16,half -o stop 2>err.txt & pid=$!
for i in $(seq 300); do
    [ -e stop.resume ] && [ "$(wc -l <stop.resume)" -ge 3 ] && break
    sleep 0.1
done
kill -INT $pid
wait $pid
status=$?
rows=$(wc -l <stop.resume)
if [ $status -eq 130 ] && [ "$rows" -ge 3 ] && [ ! -e stop.csv ] && [ ! -e stop.png ]; then ok 'interrupted'; else not_ok 'interrupted' "status $status, $rows lines; $(ls stop.*) $(cat err.txt)"; fi
if [ "$(ls tmp)" ]; then not_ok 'nothing is left in TMPDIR' "$(ls tmp)"; else ok 'nothing is left in TMPDIR'; fi

# ---- wrong options and inputs
bad() { # name, pattern, options...
    name=$1 pattern=$2
    shift 2
    expect_fail "$name" 2 "$pattern" no.csv "$RELUME" sweep cap -o no "$@"
}
bad 'unknown basis' "unknown --basis 'pcb'; did you mean 'pca'" --basis sh,pcb
bad 'unknown bits' "unknown --bits '9'" --bits 9
bad 'unknown step' "unknown --step 'plain'; did you mean 'plane'" --step plain
bad 'unknown colour' "unknown --colour" --colour cmyk
bad 'unknown interpolant' "unknown --interpolant 'tpz'; did you mean 'tps'" --interpolant tpz
bad 'unknown domain' "unknown --domain" --domain lagged
bad 'a size that is no number' '--coefficients: .*four' --coefficients 4,four
bad 'a size of 0' '--coefficients: ' --coefficients 0
bad 'a size that no basis has' '--coefficients: none of the bases' --basis sh --coefficients 5
bad 'a codebook that is no number' '--codebook: .*many' --codebook many
bad 'stages without codebooks' '--stages: expected together with --codebook' --stages 2
bad 'an empty word' '--basis: ' --basis sh,,pca
bad 'a comma at the end' '--basis: ' --basis sh,
bad 'two ways to judge' '--leave-out or --test' --leave-out 2 --test held
bad 'two ways to print' '--json or --csv' --json --csv
bad 'nothing left to learn from' 'leaving out 20 lights' --leave-out 20
bad 'an unknown option' "unknown option '--bases'; did you mean '--basis'" --bases sh
expect_fail 'no capture' 1 'nowhere: ' no.csv "$RELUME" sweep nowhere -o no
expect_fail 'a second capture of another size' 1 '16 x 16' no.csv "$RELUME" sweep cap --test small -o no
expect_fail 'nowhere to write' 3 'nowhere/o: cannot be created; there is no folder nowhere: make it first' - $sweep $grid -o nowhere/o
if [ "$(ls tmp)" ]; then not_ok 'nothing is left in TMPDIR at the end' "$(ls tmp)"; else ok 'nothing is left in TMPDIR at the end'; fi
finish
