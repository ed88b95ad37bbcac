#!/bin/sh
# Shadows and highlights that move, in pages and in files dropped onto them: what is shown is what relume relight shows.
#
# Compares: web/moving.js with stage.c.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/page.sh"

"$RELUME" synth box -o box --size 64 --lights 24 --hemisphere --samples 4 -q && "$RELUME" encode box -o box.exr -q || exit 1
"$RELUME" encode box -o faded.exr --shadows no -q || exit 1
"$RELUME" synth teapot -o pot --size 40 --views 2x1 --lights 16 --hemisphere --samples 2 -q && "$RELUME" encode pot -o pot.exr --shadows yes -q || exit 1
"$RELUME" synth attic -o room --projection spherical --size 40 --lights 24 --samples 2 -q && "$RELUME" encode room -o room.exr --shadows yes -q || exit 1
"$sphere" coin --size 48 --lights 20 --hemisphere --shade wrap --format png && "$RELUME" encode coin -o coin.exr --highlights yes -q || exit 1
"$RELUME" publish box.exr pot.exr room.exr coin.exr -o site -q 2>err.txt || { not_ok 'a site is published' "$(cat err.txt)"; finish; exit; }
for file in box pot room coin; do
    check "$file: what it moves by is published" grep -q '"moving": {"scale"' site/$file/scene.json
done
"$RELUME" publish faded.exr -o still -q || exit 1
check 'nothing of files where nothing moves' [ -z "$(find still/faded -name 'moving*')" ]
cp coin.exr hurt.exr
printf 'these bytes are damaged' | dd of=hurt.exr bs=1 seek=$(($(wc -c <coin.exr) - 700)) conv=notrunc 2>dd.txt
expect_fail 'a damaged model' 1 'hurt.exr: view0000.highlights;' hurt "$RELUME" publish hurt.exr -o hurt -q
check 'without it, where one goes on' "$RELUME" publish hurt.exr -o hurt -q --keep-going
check 'it is not there' sh -c '! grep -q "\"moving\"" hurt/hurt/scene.json'

if ! [ "$node" ] || ! [ "$browser" ]; then
    skip 'what moves in a browser' 'no chromium and node; make deps-web installs them'
    finish
    exit
fi
cp -r site bad
{ printf 'relume.put("coin/v0/moving.bin", "'; head -c 300 bad/coin/v0/moving.bin | base64 -w0; printf '");\n'; } >bad/coin/v0/moving.bin.js
rm bad/box/v0/moving.bin.js

n=0 shots=
snap() { # file, limit, state, options of relume relight
    n=$((n + 1))
    echo "state $3" >>orders.txt
    echo "snap page$n.png" >>orders.txt
    "$RELUME" relight $1.exr -o tool$n.png -q $4 --light "$5" || exit 1
    shots="$shots $1:$n:$2"
}
lone() { # file, direction, more of the state, options, limit
    snap "$1" "$5" "light=dir,$(echo "$2" | tr ' ' ,)$3" "$4" "dir $2"
}
{
    echo 'size 64 64'
    echo "before const own = Element.prototype.append; Element.prototype.append = function (...nodes) { if (nodes.some(n => /moving.bin/.test(n.src || ''))) window.drawnThen = !!document.querySelector('relume-view').viewer.drawn; return own.apply(this, nodes); }"
    show site/box.html
} >orders.txt
lone box '0.2 0.3 0.8' '' '' 1
lone box '-0.62 0.55 0.56' '' '' 1
ask "['behind', window.drawnThen]"
near() { snap "$1" 1 "light=$(echo "$2" | tr ' ' ,)$3" "$4" "$2"; } # file, light, more of the state, options
near box 'point 0.3 0.6 1.4' '' ''
near box 'area 0.2 0.5 1.2 0.2 0 0 0 -0.2 0.05 rgb 9 9 9' '' ''
{
    echo 'size 80 80'
    show site/pot.html
} >>orders.txt
lone pot '0.6 0.3 0.5' '&eye=0.1,0,3' '--size 80x80 --eye 0.1,0,3' 1
near pot 'point 0.6 0.5 1' '&eye=0.1,0,3' '--size 80x80 --eye 0.1,0,3'
{
    echo 'size 96 48'
    show site/room.html
} >>orders.txt
# a picture of 40 rows, enlarged twice: 1.2 by planes of sRGB codes
lone room '0.3 0.8 0.3' '&pan=30&tilt=10&zoom=1' '--size 96x48 --pan 30 --tilt 10' 0.7
near room 'point 0.5 0.8 0.3 rgb 5 5 5' '&pan=30&tilt=10&zoom=1' '--size 96x48 --pan 30 --tilt 10'
{
    echo 'size 48 48'
    show site/coin.html
} >>orders.txt
lone coin '0.3 0.2 0.9' '' '' 1
echo 'size 64 64' >>orders.txt
ask "fetch('data:application/octet-stream;base64,$(base64 -w0 box.exr)').then(r => r.blob()).then(b => window.relume.open(new File([b], 'box.exr')))"
ask "(v => { v.controls.node.remove(); v.style.cssText = 'position:fixed;inset:0;height:auto;min-height:0;z-index:9'; return new Promise(done => setTimeout(done, 100)); })(document.querySelector('relume-view'))"
lone box '0.2 0.3 0.8' '' '' 0.5
for file in box coin; do
    echo "open file://$work/bad/$file.html" >>orders.txt
    ask "window.relume.idle().then(() => document.querySelector('relume-view').status.textContent)"
done
browse
for shot in $shots; do
    file=${shot%%:*} i=${shot#*:}
    below "$file: the page shows relume relight (${i%:*})" "$("$mkimage" codediff page${i%:*}.png tool${i%:*}.png)" "${i#*:}"
done
"$RELUME" relight faded.exr -o faded.png -q --light 'dir 0.2 0.3 0.8'
above 'which fading would not' "$("$mkimage" codediff faded.png tool1.png)" 3
says 'what moves loads behind the first picture' '^\["behind",true\]'
says 'what is missing is said' '"A part of the picture cannot be shown: box/v0/moving.bin is missing\."'
says 'what is cut short is said' '"A part of the picture cannot be shown: v0/moving.bin is damaged\."'
finish
