#!/bin/sh
# A film of a moving lamp: sharp frames under lights that differ. ffmpeg is a script that has 25 frames;
# the real one takes its place where it is installed.
. "$(dirname "$0")/lib.sh"
"$RELUME" synth bust -o bust --size 128 --lights 12 --hemisphere --samples 1 -q || exit 1
"$BUILD/samples/mirrorball" bust photos || exit 1
mkdir frames && "$mkimage" png 8 3 frames photos/*.jpg

# ---- two frames of each light, and a blurred one: grey frames of 320 x 240, bright above, dark below
bytes() { head -c $((320 * $1)) /dev/zero | tr '\0' "$2"; } # rows, octal code
frame() { # bright rows, blurred rows
    bytes "$1" '\310'
    bytes "$2" '\226'
    bytes $((240 - $1 - $2)) '\144'
}
for i in 0 1 2 3 4 5 6 7 8 9 10 11; do
    frame $((60 + 10 * i)) 0
    frame $((60 + 10 * i)) 0
    [ $i -eq 5 ] && frame 112 1
done >grey.raw
mkdir fake
cat >fake/ffmpeg <<'END'
#!/bin/sh
here=$(dirname "$0")/..
for last; do :; done
[ -e "$here/broken" ] && exit 1
[ "$last" = pipe:1 ] && exec cat "$here/grey.raw"
echo "$*" | grep -o 'eq(n[^)]*)' | tr -dc '0-9\n' >"$here/chosen.txt"
n=0
for f in "$here"/frames/*; do
    n=$((n + 1))
    [ $n -le "$(wc -l <"$here/chosen.txt")" ] && cp "$f" "$(printf "${last#file:}" $n)"
done
exit 0
END
chmod +x fake/ffmpeg
echo film >'torch; rm x.mov'
expect_ok 'a film' 'torch; rm x.mov: 12 of 25 frames are taken' env PATH="$work/fake:$PATH" "$RELUME" capture 'torch; rm x.mov' -o film
check 'one frame of each light, none blurred' test "$(tr '\n' ' ' <chosen.txt)" = '0 2 4 6 8 10 13 15 17 19 21 23 '
relume capture photos -o photographs
for i in 00 07; do same "photograph $i" film/light00$i.exr photographs/light00$i.exr; done
same 'the lights' film/lights.lp photographs/lights.lp
check 'frames have the name of the film' grep -q '"file": "torch; rm x-0007.png"' film/capture.json
expect_fail 'too few frames' 2 'frames: expected a whole number from 3 to 512' out env PATH="$work/fake:$PATH" "$RELUME" capture 'torch; rm x.mov' -o out --frames 2
bytes 480 '\310' >grey.raw
expect_fail 'a lamp that stands still' 1 '2 frames show 1 lights; expected a film in which a lamp moves' out env PATH="$work/fake:$PATH" "$RELUME" capture 'torch; rm x.mov' -o out
touch broken
expect_fail 'what is no film' 1 'ffmpeg cannot read this film' out env PATH="$work/fake:$PATH" "$RELUME" capture 'torch; rm x.mov' -o out
if command -v ffmpeg >/dev/null 2>&1; then
    ffmpeg -v error -framerate 25 -pattern_type glob -i 'photos/*.jpg' -pix_fmt yuv420p real.mp4
    expect_ok 'the real ffmpeg' 'real.mp4: 1[012] of 12 frames are taken' "$RELUME" capture real.mp4 -o real
else
    expect_fail 'no ffmpeg' 3 'ffmpeg is not installed' out "$RELUME" capture 'torch; rm x.mov' -o out
fi
finish
