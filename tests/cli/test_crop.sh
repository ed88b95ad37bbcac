#!/bin/sh
# A part of the photographs: as it is given, or the object without ball and table.
. "$(dirname "$0")/lib.sh"
"$RELUME" synth bust -o bust --size 128 --lights 12 --hemisphere --samples 1 -q || exit 1
"$BUILD/samples/mirrorball" bust photos || exit 1
expect_ok 'whole' 'whole: 12 lights' "$RELUME" capture photos -o whole
expect_ok 'a part' 'cropped to 40,20,48,80 of 128 x 128 pixels' "$RELUME" capture photos -o part --crop 40,20,48,80

# ---- the same pixels, directions and places
for at in '0 0' '47 79' '20 33'; do
    set -- $at
    for i in 02 11; do
        check "pixel $at of photograph $i" test "$("$mkimage" read part/light00$i.exr $1 $2)" = \
            "$("$mkimage" read whole/light00$i.exr $(($1 + 40)) $(($2 + 20)))"
    done
done
same 'the same lights' part/lights.lp whole/lights.lp
# the window of 128 pixels spans -1 to 1: 40 / 64 - 1 = -0.375, 1 - 20 / 64 = 0.6875
check 'the window keeps its place' grep -q '"window": {"min": \[-0.375, -0.5625\], "max": \[0.375, 0.6875\]' part/capture.json
check 'the photographs say what they are a part of' grep -q '"crop": \[40, 20, 48, 80\]' part/capture.json
relume encode part -o part.exr --basis table
relume encode whole -o whole.exr --basis table
relume relight part.exr -o a.exr --light 'dir -0.5 0.4 0.8'
relume relight whole.exr -o b.exr --light 'dir -0.5 0.4 0.8' --crop 40,20,48,80
above 'relit alike' "$(psnr a.exr b.exr)" 45

# ---- the object
expect_ok 'the object' 'cropped to [0-9,]* of 128 x 128 pixels' "$RELUME" capture photos -o auto --crop auto --json
crop=$(sed 's/.*"crop":\[\([0-9,]*\)\].*/\1/' out.txt)
echo "$crop" | tr , ' ' >crop.txt
read -r x y w h <crop.txt
# the head stands in columns 37 to 88 and rows 12 to 122; the ball in columns 5 to 30
check 'the ball is outside' test "$x" -ge 29
check 'all of the head is inside' sh -c "[ $x -le 37 ] && [ $((x + w)) -ge 88 ] && [ $y -le 13 ] && [ $((y + h)) -ge 121 ]"
check 'little beside it' test "$w" -le 66

# ---- near lights and mask
for at in 1.5,0,1.5 -1.5,0.2,1.5 0,1.5,1.5 0.1,-1.5,1.4 1,1,1.8 -1,1,1.6; do lamps="${lamps:-} --lamp $at"; done
"$RELUME" synth box -o lamps --size 32 $lamps --samples 1 -q
"$mkimage" plane lamps/view00/light0000.exr mask.exr 1
near() { relume capture lamps/view00 --lights lamps/capture.json --near --mask mask.exr -o "$@" && relume encode "$1" -o "$1.exr" --basis table; }
near all
near some --crop 4,6,20,16
check 'the mask is cropped' test "$("$mkimage" size some/mask.exr)" = '20 16'
places() { sed -n '/"positions"/,/]/p' "$1" | tr -d ' '; }
places all/capture.json >all.txt
places some/capture.json >some.txt
same 'lamps stay where they are' all.txt some.txt
# another place than the lamps': distances and directions are those of the window
relume relight all.exr -o all-lit.exr --light 'point 0.6 0.9 1.2' --crop 4,6,20,16
relume relight some.exr -o some-lit.exr --light 'point 0.6 0.9 1.2'
above 'a near light shows the same' "$(psnr all-lit.exr some-lit.exr)" 40

# ---- heights
"$sphere" dome --size 48 --lights 16 --hemisphere --format png || exit 1
tail -n +2 dome/dirs.lp | cut -d' ' -f2- >lights.txt
relume capture dome/view00 --lights lights.txt -o far --height all-height.exr --width 48
relume capture dome/view00 --lights lights.txt -o farther --height some-height.exr --width 48 --crop 12,8,24,30
slope() { echo "$("$mkimage" read "$1" $2 $4) $("$mkimage" read "$1" $3 $4)" | awk '{ print $4 - $1 }'; }
below 'heights keep their millimetres' "$(echo "$(slope all-height.exr 18 30 20) $(slope some-height.exr 6 18 12)" |
    awk '{ d = $1 - $2; print d < 0 ? -d : d }')" 0.02

# ---- what cannot be
bad() { # name, pattern, value
    expect_fail "$1" 2 "$2" out "$RELUME" capture photos -o out --crop "$3"
}
bad 'beyond the border' 'crop 100,0,40,40: expected a part of the photographs of 128 x 128 pixels' 100,0,40,40
bad 'three numbers' 'crop: expected auto, or four whole numbers' 1,2,3
bad 'nothing' 'crop: expected auto, or four whole numbers' 1,2,0,3
finish
