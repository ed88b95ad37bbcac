#!/bin/sh
# relume change: a relief that is known in closed form (tests/tools/change_scene.c), photographed twice.
. "$(dirname "$0")/lib.sh"
scene="$BUILD/tests/tools/change_scene"

# The second camera is turned by 4 degrees, shifted, nearer and askew; it has other lamps and exposures.
# The eight numbers take its pixels to those of the first.
moved="0.98072758 -0.07222284 8.76696739 0.07424444 0.96912648 -5.08442762 0.000125597 -0.0000627983"
size="--size 128 104 --noise 0.004 --gloss 0.05"
"$scene" a $size --lights 12 --truth truth.png
for folder in same changed; do
    marks=; [ $folder = same ] || marks="--scratch --stain"
    "$scene" $folder $size --lights 13 --seed 7 --gain 0.7 0.8 0.75 --homography $moved --roll -4 $marks
done
change() { "$RELUME" change "$1/lights.lp" "$2/lights.lp" -o "$3" --json -q >"$3.json" 2>err.txt ||
    not_ok "relume change $1 $2" "$(cat err.txt)"; }

# ---------------------------------------------------------------- nothing has changed
change a same none
check "other lights, exposure and camera are no change" grep -q '"changed": 0,.*"places": \[\]' none.json
check "the report says so" grep -q 'Nothing has changed' none/report.html
# 1 / 0.7 and 1 / 0.8 of the lamps
near() { awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { exit !(a != "" && a - b < t && b - a < t) }'; }
gain() { sed -n 's/.*"gain": \[\([^]]*\)\].*/\1/p' none.json | cut -d, -f"$1"; }
check "the exposure is found, red" near "$(gain 1)" 1.4286 0.02
check "the exposure is found, green" near "$(gain 2)" 1.25 0.02
# where the middle of the first lies in the second, by the inverse of the homography above
check "the camera is found" awk -v m="$(sed -n 's/.*"homography": \[\([^]]*\)\].*/\1/p' none.json)" -v h="$moved" 'BEGIN {
    split(m, a, ", "); split(h, b, " "); worst = 0
    for (x = 14; x < 128; x += 50) for (y = 14; y < 104; y += 38) {
        z = a[7] * x + a[8] * y + 1; u = (a[1] * x + a[2] * y + a[3]) / z; v = (a[4] * x + a[5] * y + a[6]) / z
        w = b[7] * u + b[8] * v + 1; dx = (b[1] * u + b[2] * v + b[3]) / w - x; dy = (b[4] * u + b[5] * v + b[6]) / w - y
        e = sqrt(dx * dx + dy * dy); if (e > worst) worst = e }
    exit !(worst < 0.5) }'

# ---------------------------------------------------------------- a scratch and a stain
mv changed '<b>&'
change a '<b>&' found
place() { tr '{' '\n' <found.json | sed -n 's/^"x": //p' | sed -n "$1p"; } # x, "y": y, ...
count=$(grep -o '"x": ' found.json | wc -l)
if [ "$count" = 2 ]; then ok "two places are found, and nothing else"; else not_ok "two places are found" "$(cat found.json)"; fi
# The stain: an ellipse around (0.68, 0.5) of the width, 0.14 by 0.1; the scratch: (0.22, 0.25) to (0.45, 0.33).
overlaps() { # place, left, top, right, bottom: how much of both boxes is common
    place "$1" | tr -d '"a-z_:,' | awk -v l="$2" -v t="$3" -v r="$4" -v b="$5" '{
        w = ($1 + $3 < r ? $1 + $3 : r) - ($1 > l ? $1 : l); h = ($2 + $4 < b ? $2 + $4 : b) - ($2 > t ? $2 : t)
        both = w > 0 && h > 0 ? w * h : 0; print both / ($3 * $4 + (r - l) * (b - t) - both) }'
}
above "the stain lies where it was made" "$(overlaps 1 78 57.6 96 70.4)" 0.75
above "the scratch lies where it was made" "$(overlaps 2 27 30.5 59 44)" 0.7
check "the stain is colour, not shape" sh -c "echo '$(place 1)' | grep -q '\"shape\": 0,'"
check "the scratch is shape" awk -v p="$(place 2)" 'BEGIN {
    match(p, /"shape": [0-9]+/); s = substr(p, RSTART + 9, RLENGTH - 9); match(p, /"colour": [0-9]+/)
    exit !(s + 0 > 10 * substr(p, RSTART + 10, RLENGTH - 10)) }'
for file in report.html before.png after.png changed.png shape.png colour.png significance.png degrees.exr \
    delta_e.exr significance.exr; do
    check "writes $file" test -s "found/$file"
done
if grep -q '<script\|http' found/report.html; then not_ok "the report needs nothing else" "script or link"; else ok "the report needs nothing else"; fi
check "names are escaped" grep -q 'to &lt;b&gt;&amp;/' found/report.html
[ -z "$python" ] || check "--json is JSON" "$python" -c 'import json; json.load(open("found.json"))'
"$RELUME" change a/lights.lp '<b>&/lights.lp' -o twice --threads 1 -q 2>err.txt
same "one thread measures the same" found/degrees.exr twice/degrees.exr
same "one thread marks the same" found/changed.png twice/changed.png

# ---------------------------------------------------------------- gloss alone
# 24 lamps or more; an ellipse around (0.68, 0.5) has highlights three times as bright
glossy="--size 128 104 --noise 0.004 --gloss 0.2"
"$scene" dull $glossy --lights 24
"$scene" kept $glossy --lights 27 --seed 7 --gain 0.7 0.8 0.75
"$scene" polished $glossy --lights 27 --seed 7 --gain 0.7 0.8 0.75 --polish
change dull kept none4
check "a glossy surface under other lamps has not changed" grep -q '"changed": 0,.*"gloss_known": [1-9][0-9]*,.*"places": \[\]' none4.json
rm -rf found found.json
change dull polished found
count=$(grep -o '"x": ' found.json | wc -l)
if [ "$count" = 1 ]; then ok "a place that was polished is found, and nothing else"; else not_ok "a place that was polished is found" "$(cat found.json)"; fi
above "it lies where it was made" "$(overlaps 1 78 57.6 96 70.4)" 0.6
check "it is gloss, not shape or colour, and brighter" awk -v p="$(place 1)" 'BEGIN {
    n = split(p, v, /[^-0-9.e]+/); match(p, /"gloss": [0-9]+/); g = substr(p, RSTART + 9, RLENGTH - 9)
    match(p, /"shape": [0-9]+/); s = substr(p, RSTART + 9, RLENGTH - 9); match(p, /"colour": [0-9]+/); c = substr(p, RSTART + 10, RLENGTH - 10)
    match(p, /"gloss_by": [-0-9.e]+/); b = substr(p, RSTART + 12, RLENGTH - 12); exit !(g + 0 > 10 * (s + c) && b > 0.1 && b < 0.3) }'
check "the report has it" sh -c "grep -q 'gloss alone [1-9]' found/report.html && test -s found/gloss.exr -a -s found/gloss.png"
"$scene" few --size 64 52 --lights 7
"$RELUME" change few/lights.lp few/lights.lp -o fewer 2>err.txt
check "few lamps do not tell gloss, which is said" grep -q 'gloss was not compared' err.txt

# ---------------------------------------------------------------- files
relume encode a/lights.lp -o a.exr && relume change a.exr a/lights.lp -o file --force
check "a file beside its own capture has not changed" grep -q 'Nothing has changed' file/report.html

# ---------------------------------------------------------------- bad input
bad() { # name, status, pattern, arguments of change
    name=$1 status=$2 pattern=$3
    shift 3
    expect_fail "$name" "$status" "$pattern" none2 "$RELUME" change "$@" -o none2
}
"$sphere" ball --size 64 --lights 9
bad "another object" 1 'do not lie on each other|in common' a/lights.lp ball
sed '1s/.*/3/;5,$d' a/lights.lp >a/three.lp
bad "three lights" 1 'expected 4 lights or more' a/three.lp a/lights.lp
"$RELUME" synth box -o round --size 32 --lights 9 --projection spherical -q
bad "a panorama" 1 'expected a planar one' round a/lights.lp
bad "no such file" 1 'nothing.lp: no such file' a/lights.lp nothing.lp
head -c 4000 a.exr >cut.exr
bad "a file cut short" 1 'cut.exr' cut.exr a/lights.lp
bad "a view that is not there" 2 'view 3 does not exist' a/lights.lp a/lights.lp --view-b 3
expect_fail "an existing folder" 2 'found' - "$RELUME" change a/lights.lp same/lights.lp -o found
"$scene" small --size 20 20 --lights 6
bad "too small" 1 'expected 32 x 32 or more' small/lights.lp a/lights.lp
"$scene" black --size 64 64 --lights 6 --gain 0 0 0
bad "black photographs" 1 'fewer than 3 photographs are left' black/lights.lp a/lights.lp
finish
