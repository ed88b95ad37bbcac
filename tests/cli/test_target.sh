#!/bin/sh
# relume capture --target: a ColorChecker 24 makes colours right; where photographs come from is kept
. "$(dirname "$0")/lib.sh"
made_target="$BUILD/tests/tools/made_target"
value() { sed -n "s/.*\"$1\":\[\([-0-9.e+]*\),.*/\1/p" "$2"; } # the first number of a field
mkdir s && "$made_target" set s 6 3

expect_ok 'the target is among the photographs' 'colour target, 24 of 24' "$RELUME" capture s/*.png --lights s/lights.txt --target auto -o cap --json
cp out.txt first.json
below 'colours come right' "$(value delta_e first.json)" 0.5
check 'which they were not before' awk -v d="$(value delta_e_before first.json)" 'BEGIN { exit !(d > 8) }'
check 'the blurred one is named' grep -q 'p03.png: less sharp than the others' err.txt
check 'and no other' test "$(grep -c 'less sharp' err.txt)" -eq 1
check 'warnings come first in the report' awk '/<h2>Warnings/ { w = NR } /<td>pictures/ { exit !(w && NR > w) }' cap/report.html
check 'the report shows the patches' grep -q 'purplish blue' cap/report.html
sum=$(sha256sum s/p02.png | cut -d' ' -f1)
for place in cap/capture.json cap/report.html; do check "$place has the check sum" grep -q "$sum" $place; done
expect_ok 'corrected pictures need no more' 'colour target' "$RELUME" capture cap/light*.exr --lights s/lights.txt --target auto -o again --json
below 'before the second time' "$(value delta_e_before out.txt)" 0.6
expect_ok 'encode' - "$RELUME" encode cap -o f.exr -q
expect_ok 'info' - "$RELUME" info f.exr --json
check 'the file knows its photographs' grep -q "\"sha256\":\"$sum\"" out.txt
check 'and the matrix' grep -q '"colour":{"target":"ColorChecker 24","photograph":"p0[0-9].png","matrix":\[' out.txt
[ -z "$python" ] || check 'info prints JSON' "$python" -m json.tool out.txt /dev/null

# ---- a photograph of its own, with corners in any order; others are refused
"$made_target" one t.png 180 135 30 90
corners='238.2,46.8 238.2,223.2 121.8,223.2 121.8,46.8' # 2.94 by 1.94 cells from the middle
expect_ok 'by its corners' 'colour target' "$RELUME" capture s/*.png --lights s/lights.txt --target t.png --target-corners "$corners" -o side --json
below 'by its corners' "$(value delta_e out.txt)" 0.5
expect_fail 'corners of something else' 1 't.png: no ColorChecker 24 between the corners' no "$RELUME" capture s/*.png --lights s/lights.txt --target t.png --target-corners '10,10,90,10,90,60,10,60' -o no
"$made_target" one none.png -500 -500
expect_fail 'no target' 1 'none.png: no colour target found' no "$RELUME" capture s/*.png --lights s/lights.txt --target none.png -o no
head -c 3000 t.png >short.png
expect_fail 'a broken photograph' 1 'short.png' no "$RELUME" capture s/*.png --lights s/lights.txt --target short.png -o no
expect_fail 'a missing one' 1 'gone.png' no "$RELUME" capture s/*.png --lights s/lights.txt --target gone.png -o no
printf '50 0 0\n' >few.txt
expect_fail 'too few values' 1 'few.txt: 1 colours; expected 24' no "$RELUME" capture s/*.png --lights s/lights.txt --target t.png --target-values few.txt -o no
expect_fail 'white too' 2 'one of --white and --target' no "$RELUME" capture s/*.png --target t.png --white 1,1,9,9 -o no
expect_fail 'corners alone' 2 'corners needs --target' no "$RELUME" capture s/*.png --target-corners 1,1,2,2,3,3,4,4 -o no
expect_fail 'seven numbers' 2 'eight numbers' no "$RELUME" capture s/*.png --target t.png --target-corners 1,1,2,2,3,3,4 -o no
sed 's/"provenance": {/"provenance": [{/;s/^  "projection"/], "projection"/' cap/capture.json >cap/odd.json
expect_fail 'provenance that is none' 1 'odd.json' no "$RELUME" encode cap/odd.json -o no

# ---- a profile out, and in again: the same light
for e in jpg tif; do
    expect_ok "a profile in .$e" - "$RELUME" relight f.exr -o lit.$e --icc
    check ".$e has it" grep -qa acsp lit.$e
    expect_ok "without in .$e" - "$RELUME" relight f.exr -o bare.$e
    check "bare .$e has none" test -z "$(grep -ca acsp bare.$e | grep -v '^0$')"
done
expect_ok 'a profile of tonemap' - "$RELUME" tonemap lit.tif -o toned.jpg --icc
check 'is in the picture' grep -qa acsp toned.jpg
expect_ok 'again' - "$RELUME" relight f.exr -o again.jpg --icc
same 'the profile has no date' lit.jpg again.jpg
finish
