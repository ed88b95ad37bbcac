#!/bin/sh
# Published pages: the core of the page beside the library, and pages in a browser, from a disk,
# without network: what they show is what relume relight shows.
#
# Compares: shared/tone.glsl, web/near.js with directions.c, tone.c.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/page.sh"

# ---- the WebAssembly in the tree beside the same sources compiled natively
if [ "$node" ]; then
    "$BUILD/tests/tools/core_weights" "$BUILD/tests/core.so" >cases.txt || exit 1
    node "$TOP/tests/tools/core.mjs" "$TOP/web/core/relume-core.wasm" <cases.txt >core.txt 2>&1
    field() { sed -n "s/.* $1 \([0-9.e+-]*\).*/\1/p" core.txt; }
    # every bit, but for what a C library's exp and sin may do otherwise: an ulp of the largest weight
    below 'weights are those of the native core' "$(field differ)" 1.2e-7
    above 'nearly all of them bit by bit' "$(awk '{ print $4 / $2 }' core.txt)" 0.999
    below 'the share beyond the lights' "$(field share)" 1e-15
    below 'lights that stand for an environment' "$(field environment)" 1e-6
    # one inverse is Eigen's, the other plain
    below 'the core beside the library' "$(field library)" 1e-6
    cp "$TOP/web/recent.js" recent.mjs
    cat >recent_test.mjs <<'END'
import { Recent } from './recent.mjs';
const kept = new Recent([['a', 1], ['b', 2], ['c', 3], ['d', 4]]), left = [];
kept.use('a');
kept.trim(() => kept.size > 2, (value) => left.push(value), (value) => value !== 2);
console.log([...kept.keys()].join(), left.join(), kept.use('c'), kept.get('b'));
kept.trim(() => false, () => { throw new Error('nothing is too much'); });
END
    node recent_test.mjs >recent.txt 2>&1
    check 'the least recently used leaves first, unless it must stay' grep -qx 'b,a 3,4 undefined 2' recent.txt
else
    skip 'the core of pages' 'no node; make deps-web installs it'
fi

if ! [ "$node" ] || ! [ "$browser" ]; then
    skip 'published pages in a browser' 'no chromium and node; make deps-web installs them'
    finish
    exit
fi

# ---- three files, three pages
"$sphere" dome --size 96 --lights 40 --hemisphere --shade wrap --format png || exit 1
"$RELUME" encode dome -o dome.exr --basis pca --coefficients 18 -q || exit 1
"$RELUME" synth teapot -o pot --size 48 --views 2x2 --lights 16 --hemisphere --samples 2 -q || exit 1
"$RELUME" encode pot -o pot.exr --basis pca --coefficients 9 --domain display -q || exit 1
"$RELUME" synth attic -o room --projection spherical --size 48 --lights 24 --samples 1 -q || exit 1
"$RELUME" encode room -o room.exr --basis pca --coefficients 12 --domain display -q || exit 1
"$RELUME" notes dome.exr --add 'line 10,20 50,20' --text 'a <img src=x onerror="window.broken=1">' --state 'light=dir,0.6,0,0.8' --ruler n1 --length 4 -q >note.txt 2>&1 ||
    "$RELUME" notes dome.exr --ruler n1 --length 4 -q >>note.txt 2>&1 || exit 1
"$RELUME" publish dome.exr pot.exr room.exr -o site -q 2>note.txt ||
    { not_ok 'a site is published' "$(cat note.txt)"; finish; exit; }
"$RELUME" encode pot -o mug.exr --basis pca --coefficients 6 --domain display -q || exit 1
"$RELUME" publish mug.exr -o two --layers both -q && "$RELUME" publish mug.exr -o avif --layers avif -q || exit 1
node --check site/relume/relume.js 2>check.txt || { not_ok 'the modules join to a script' "$(head -n 5 check.txt)"; finish; exit; }
cp -r site bad
sed -i 's/"version": 1/"version": 9/' bad/pot/scene.json
{ printf 'relume.put("pot/scene.json", "'; base64 -w0 bad/pot/scene.json; printf '");\n'; } >bad/pot/scene.json.js
rm -r bad/room/v0
{ printf 'relume.put("dome/v0/0_0_0.bin", "'; head -c 3000 bad/dome/v0/0_0_0.bin | base64 -w0; printf '");\n'; } >bad/dome/v0/0_0_0.bin.js

n=0
shots= # number:file:options, one a line
snap() { # file, state, options of relume relight
    n=$((n + 1))
    echo "state $2" >>orders.txt
    echo "snap page$n.png" >>orders.txt
    "$RELUME" relight $1.exr -o tool$n.png -q $3 "$4" "$5" || exit 1
    shots="$shots $1:$n"
}
lone() { snap "$1" "light=dir,$(echo "$2" | tr ' ' ,)$3" "$4" --light "dir $2"; }
{
    echo 'size 96 96'
    show site/dome.html
} >orders.txt
lone dome '0 0 1' '' ''
lone dome '0.6 0.3 0.7' '&exposure=0.5&tone=filmic' '--exposure 0.5 --tone filmic'
lone dome '0.6 0.3 0.7' '&exposure=1&tone=reinhard' '--exposure 1 --tone reinhard'
lone dome '0.6 0.3 0.7' '&tone=gamma' '--tone gamma'
lone dome '-0.5 0.7 0.3' '&pass=luminance' '--pass luminance'
# what the state says comes back; what is absurd is left out and said
ask "window.relume.setState('light=dir,0,3,4&light=dir,1,0,0,rgb,0.5,0.25,0&exposure=-1&tone=gamma&later=1,2') || window.relume.getState()"
ask "window.relume.setState('light=dir,NaN,0,1&exposure=1e300&pass=nonsense&light=' + 'x'.repeat(300)) || [window.relume.getState(), document.querySelector('relume-view').status.textContent]"
ask "window.relume.setState('light=dir,0,0,1&'.repeat(100000)) || document.querySelector('relume-view').status.textContent"
# keys alone: the light, another one, the pass, exposure
echo 'state light=dir,0,0,1' >>orders.txt
echo 'key ArrowRight ArrowRight n p ]' >>orders.txt
ask 'window.relume.getState()'
{ echo 'drag 48 48 60 20'; } >>orders.txt
ask 'window.relume.getState()'
# notes: what was published, what is drawn by clicks and keys, and back to the tool
ask "(v => [v.panel.notes.all.length, v.panel.notes.all[0].text, v.panel.list.textContent])(document.querySelector('relume-view'))"
{
    echo "eval (v => { v.fit(); v.panel.begin('polygon'); })(document.querySelector('relume-view'))"
    echo 'drag 10 10 10 10'
    echo 'drag 30 10 30 10'
    echo 'drag 30 30 30 30'
    echo 'key Enter'
    echo "eval (v => { v.panel.text.value = 'a loss'; v.panel.write(); v.surface.focus(); })(document.querySelector('relume-view'))"
    echo "write page.notes.json document.querySelector('relume-view').panel.notes.toText()"
} >>orders.txt
ask 'window.broken === undefined'
# a look that is kept beside another one
ask "(v => { v.keep(); v.set('pass', 'colour'); v.compare('difference'); return window.relume.idle().then(() => v.viewer.comparison.way); })(document.querySelector('relume-view'))"
{
    echo 'size 96 96'
    show site/pot.html
} >>orders.txt
eye=0.1,-0.1,$(awk 'match($0, /"uv_plane_z": *[0-9.-]+/) { sub(/.*: */, "", $0); print $0 + 0; exit }' RS=, site/pot/scene.json)
snap pot "light=dir,0,0,1&eye=$eye" "--size 96x96 --eye $eye" --light 'dir 0 0 1'
snap pot "light=dir,0.5,0.3,0.7&eye=$eye" "--size 96x96 --eye $eye" --light 'dir 0.5 0.3 0.7'
lamp() { snap "$1" "light=$(echo "$2" | tr ' ' ,)$3" "$4" --light "$2"; }
lamp pot 'point 0.6 0.5 1' "&eye=$eye" "--size 96x96 --eye $eye"
# layers as AVIF; without it as JPEG, or a sentence
{
    show two/mug.html
} >>orders.txt
snap mug "light=dir,0.5,0.3,0.7&eye=$eye" "--size 96x96 --eye $eye" --light 'dir 0.5 0.3 0.7'
ask "['AVIF', !document.querySelector('relume-view').viewer.tiles.plain]"
echo 'before const own = window.createImageBitmap; window.createImageBitmap = (blob, ...more) => blob.type === "image/avif" && location.href.includes("old") ? Promise.reject(new Error("no")) : own(blob, ...more)' >>orders.txt
show 'two/mug.html?old' >>orders.txt
snap mug "light=dir,0.5,0.3,0.7&eye=$eye" "--size 96x96 --eye $eye" --light 'dir 0.5 0.3 0.7'
ask "['JPEG', document.querySelector('relume-view').viewer.tiles.plain]"
echo "open file://$work/avif/mug.html?old" >>orders.txt
ask "document.querySelector('relume-view').status.textContent"
{
    echo 'size 128 64'
    show site/room.html
} >>orders.txt
snap room 'light=dir,0,1,0.3&pan=30&tilt=10&zoom=1' '--size 128x64 --pan 30 --tilt 10' --light 'dir 0 1 0.3'
# a line in a look, which stays where it is while one looks elsewhere
view="document.querySelector('relume-view')"
ask "($view.panel.begin('line'), 0)"
{ echo 'drag 70 20 70 20'; echo 'drag 110 44 110 44'; echo 'key Enter'; } >>orders.txt
ask "(window.relume.setState('pan=200&projection=planet&zoom=0.5'), [[70, 20], [110, 44]].forEach(p => $view.viewer.toPicture(p)), window.relume.setState('pan=30&tilt=10&zoom=1'), ['turned', ...$view.panel.notes.all[0].places.map(p => $view.viewer.toCanvas(p).map(x => Math.round(10 * x) / 10))])"
echo "write room.page.json $view.panel.notes.toText()" >>orders.txt
# very many notes: the card draws them, where the look has them; those behind the eye it leaves out
ask "($view.hint.remove(), $view.status.remove(), $view.keptNotes = $view.panel.notes.page, $view.panel.choose(null), $view.panel.notes.read({ type: 'AnnotationPage', items: Array.from({ length: 200 }, (_, i) => ({ id: 'm' + i, type: 'Annotation', body: { value: 'm' }, target: { selector: { type: 'PointSelector', x: i % 2 ? $view.viewer.toPicture([60, 30])[0] : 2, y: i % 2 ? $view.viewer.toPicture([60, 30])[1] : 24 } } })) }), $view.viewer.invalidate(), new Promise(done => setTimeout(done, 700)).then(() => { let strokes = 0; $view.overlay.context.stroke = () => { strokes++; }; $view.viewer.turn(5, 0); $view.viewer.turn(-5, 0); return new Promise(done => setTimeout(done, 700)).then(() => { delete $view.overlay.context.stroke; return ['pinned', strokes, !!$view.overlay.pins, $view.viewer.toCanvas([2, 24])]; }); }))"
echo 'shot pinned.png' >>orders.txt
echo 'snap alone.png' >>orders.txt
ask "($view.panel.notes.read($view.keptNotes), $view.viewer.invalidate())"
lamp room 'point 0.5 0.8 0.3' '&pan=30&tilt=10&zoom=1&exposure=3' '--size 128x64 --pan 30 --tilt 10 --exposure 3'
ask "(document.body.append(document.querySelector('relume-view')), document.querySelector('relume-view').ready.then(() => 'put elsewhere'))"
ask "(document.querySelector('relume-view').controls.node.remove(), new Promise(done => setTimeout(done, 200)))"
snap room 'light=dir,0.5,0.5,0.7&projection=planet' '--size 128x64 --projection planet' --light 'dir 0.5 0.5 0.7'
axe=$TOP/build/web/node_modules/axe-core/axe.min.js
if [ -e "$axe" ]; then
    cp "$axe" site/axe.js
    echo "open file://$work/site/dome.html" >>orders.txt
    ask "(document.querySelector('relume-view').toggleNotes(), new Promise(done => { const script = document.createElement('script'); script.src = 'axe.js'; script.onload = done; document.head.append(script); }))"
    ask "axe.run().then(found => 'axe ' + found.violations.filter(v => ['serious', 'critical'].includes(v.impact)).map(v => v.id))"
else
    skip 'pages are accessible' 'no axe-core; make deps-web gets it'
fi
echo "open file://$work/site/dome.html" >>orders.txt
# a phone: all that is touched is large and within the window; a button shows the rest
small="(all => [all.length, all.filter(b => b.width < 44 || b.height < 44 || b.left < 0 || b.right > innerWidth).length, document.documentElement.scrollWidth])([...$view.root.querySelectorAll('.strip button, .strip select, .strip input')].map(b => b.getBoundingClientRect()).filter(b => b.width > 0))"
echo 'size 360 640' >>orders.txt
ask "new Promise(done => setTimeout(done, 300)).then(() => ['narrow', ...$small, $view.root.querySelector('.unfold').click(), ...$small, $view.root.querySelector('.unfold').getAttribute('aria-expanded')])"
# pages that cannot be shown
for page in dome pot room; do
    echo "open file://$work/bad/$page.html" >>orders.txt
    ask "[document.querySelector('relume-view').status.textContent, !document.querySelector('relume-view').poster.hidden]"
done
echo 'before HTMLCanvasElement.prototype.getContext = () => null' >>orders.txt
echo "open file://$work/site/dome.html" >>orders.txt
ask "[document.querySelector('relume-view').status.textContent, !document.querySelector('relume-view').poster.hidden, document.querySelector('relume-view').poster.alt]"
browse
for shot in $shots; do
    # codes are 8 bits and JPEG on the way: on the mean one step of 255
    below "${shot%:*}: the page shows relume relight (${shot#*:})" "$("$mkimage" codediff page${shot#*:}.png tool${shot#*:}.png)" 1
done
says 'the state comes back' '^"exposure=-1&tone=gamma&light=dir,0,0.6,0.8&light=dir,1,0,0,rgb,0.5,0.25,0&later=1,2"'
says 'an absurd state is left out and said' '^\["light=dir,[-0-9.,]*","This link asks for what cannot be shown \(light, exposure, pass\); the rest of it is\."\]'
says 'too long a state is not read' '^"This link is too long'
says 'a script in a note is text' '^true$'
says 'keys move and add lights, change pass and exposure' '^"exposure=0.25&pass=normals&light=dir,0.12,0,[0-9.]*&light=dir,'
says 'a drag moves the chosen light' '^"exposure=0.25&pass=normals&light=dir,0.12,0,[0-9.]*&light=dir,0.25,0.58333'
says 'published notes are shown, as text' '^\[1,"a <img .*","a <img .*4 mm"\]'
"$RELUME" notes dome.exr --import page.notes.json >notes.txt 2>&1 || not_ok 'the tool takes the notes of the page' "$(cat notes.txt)"
"$RELUME" notes dome.exr >notes.txt 2>&1
if [ "$(wc -l <notes.txt)" -eq 2 ] && grep -q 'n2 *polygon .* a loss' notes.txt; then
    ok 'an area drawn on the page comes back, what was there comes once'
else
    not_ok 'an area drawn on the page comes back, what was there comes once' "$(cat notes.txt)"
fi
# the same by the viewer, in a window five times as large
says 'a line in a panorama stays while one looks elsewhere' '^\["turned",\[70,20\],\[110,44\]\]'
says 'very many notes in a panorama are drawn by the card' '^\["pinned",0,true,null\]'
check '... where they lie, and in no picture that is saved' awk -v a="$("$mkimage" read pinned.png 56 26)" -v b="$("$mkimage" read alone.png 56 26)" 'BEGIN {
    split(a, p, " "); split(b, q, " "); print a, "and", b; exit !(p[1] > 0.7 && p[2] > 0.45 && p[3] < 0.25) || (q[1] > 0.7 && q[2] > 0.45) }'
printf 'size 640 320\nkey ctrl+n\nshot none.png\nclick 163 48\nshot none.png\nclick 350 100\nclick 550 220\nkey enter\nshot line.png\n' >jot.txt
"$VIEWER" room.exr --state 'pan=30&tilt=10&zoom=1' --script jot.txt >jot.out 2>&1 || not_ok 'the viewer notes in a look' "$(cat jot.out)"
"$RELUME" notes room.exr --import room.page.json --json >both.json 2>note.txt
check 'page and viewer find the same places of a panorama, and the tool keeps both' awk '
    { n = split($0, part, "\"places\": "); for (i = 2; i <= n; i++) { split(part[i], v, /[^-0-9.e]+/); for (k = 2; k <= 5; k++) p[i, k] = v[k] } }
    END { for (k = 2; k <= 5; k++) { d = p[2, k] - p[3, k]; if (d > 0.02 || d < -0.02) bad = 1 } print p[2, 2], p[3, 2]; exit bad || n != 3 || p[2, 2] == "" }' both.json
says 'two looks are compared' '^"difference"'
says 'without WebGL2 there is a still picture and a sentence' '^\["Only a still picture can be shown: this browser has no WebGL2\.",true,"'
[ ! -e "$axe" ] || says 'axe-core finds nothing serious' '^"axe "$'
says 'on a phone all controls are at hand and large enough' '^\["narrow",11,0,360,null,21,0,360,"true"\]'
says 'a browser takes AVIF' '^\["AVIF",true\]'
says 'where it cannot, JPEG' '^\["JPEG",true\]'
says 'where there is none, a sentence' '^"Only a still picture can be shown: this browser does not decode its AVIF pictures'
says 'a view that is put elsewhere opens again' '^"put elsewhere"'
says 'a newer file says so' '^\["Only a still picture can be shown: this file was published by a newer relume .format 9.*",true\]'
says 'a missing tile is said' '^\["Only a still picture can be shown: room/v0/0_0_0.bin is missing\."'
says 'a tile that is cut short is said' '^\["Only a still picture can be shown: v0/0_0_0.bin is damaged'
finish
