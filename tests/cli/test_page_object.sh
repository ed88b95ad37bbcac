#!/bin/sh
# Pages of baked objects: what is refused, what lies in the site, and what a browser shows beside
# relume btf render.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/page.sh"

awk -v n=8 -f "$TOP/scripts/ball.awk" >ball.obj
object() { # its members
    echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{$1}]}"
}
object '"mesh":"ball.obj","parts":[{"material":{"diffuse":[0.8,0.4,0.2]}}]' >ball.json
"$RELUME" synth --btf leather -o leather --size 8 --directions coarse --samples 1 --bounces 0 -q 2>note.txt ||
    { not_ok 'a measured material' "$(cat note.txt)"; finish; exit; }
object '"mesh":"ball.obj","parts":[{"material":"leather"}]' >shiny.json
small="--size 24x24 --bounces 0 --lights 64 --clusters 4 -q"
bake() { "$RELUME" bake "$@" 2>note.txt || { not_ok "bake $*" "$(cat note.txt)"; finish; exit; }; }
bake ball.json -o any.exr $small --coefficients 25
bake shiny.json -o shiny.exr $small --views 3 -k 16
bake ball.json -o fixed.exr --size 24x24 --rays 8 --light 'dir 1 1 1' --light 'dir -1 0 1 rgb 0 0 1' -q
bake ball.json -o haar.exr --size 16x16 --bounces 0 --haar 2 -q
expect_fail 'wavelets' 1 'haar.exr: baked with --haar, which no page shows; expected' site "$RELUME" publish haar.exr -o site
head -c 3000 any.exr >cut.exr
expect_fail 'a file cut short' 1 'cut.exr' site "$RELUME" publish cut.exr -o site

# notes: on the front, on the back, a line, an area, a view
expect_ok 'notes on an object' - "$RELUME" notes any.exr --add 'point 0,0,1' --text '<b>front</b>' --state 'eye=0,0,9&light=dir,0,0.6,0.8&exposure=0.5'
expect_ok 'on its back, a line, an area and a view' - "$RELUME" notes any.exr --add 'point 0,0,-1' --add 'line 1,0,0 0,0,1 0,1,0' --add 'polygon -0.2,-0.1,1 -0.7,-0.1,1 -0.7,-0.6,1' --add view --state 'eye=0,0,-9'
check 'lengths are in its units, angles in space' sh -c "grep -q '^n3 *line *2.82843 units 60 degrees' out.txt && grep -q '^n4 .* around 0.125 square units' out.txt && grep -q '^n1 *point *at 0,0,1 ' out.txt"
expect_ok 'a ruler sets its scale' - "$RELUME" notes any.exr --ruler n3 --length 56.56854249492381
check '... in millimetres' grep -q '^n3 *line *56.5685 mm' out.txt
expect_fail 'a place without depth' 2 "expected places as 'X,Y,Z X,Y,Z'" - "$RELUME" notes any.exr --add 'point 1,2'
expect_fail 'a place far away' 2 'lies far beside the object' - "$RELUME" notes any.exr --add 'point 1,2,99'
expect_ok 'an overlay of a picture of it' - "$RELUME" notes any.exr --to svg -o notes.svg --eye 0,0,9 --picture 128x96
check 'has what is in front, where the picture has it' sh -c "grep -q '<circle cx=.64. cy=.48.' notes.svg && grep -q '<g id=.n4.><path' notes.svg && ! grep -q 'id=.n2.' notes.svg"
check '... with lengths of the object, escaped' sh -c "grep -q '&#60;b&#62;front' notes.svg"
expect_ok 'from behind' - "$RELUME" notes any.exr --to svg -o back.svg --eye 0,0,-9
check '... what is in front is hidden' sh -c "grep -q 'id=.n2.' back.svg && ! grep -q 'id=.n1.' back.svg"
# of a ball of radius 1, over a chord as long as the square root of 2, towards the eye: 0.35
expect_ok 'the surface over a line' - "$RELUME" notes any.exr --profile n3 -o profile.csv --eye 3,3,3
check '... is that of a ball' awk -F, 'NR > 1 && $5 + 0 > most { most = $5 } END { print most; exit !(most > 0.3 && most < 0.352 && NR == 257) }' profile.csv
expect_fail 'a profile of a point' 2 "note 'n1' is a point; expected a line" - "$RELUME" notes any.exr --profile n1 -o lost.csv
expect_fail 'its notes lie beside it' 2 'any.exr is an object' - "$RELUME" notes any.exr --embed
cp any.notes.json fixed.notes.json
sed -i 's/"max": \[[^,]*/"max": [3/' fixed.notes.json
expect_fail 'notes of another object' 1 'on an object of another shape than fixed.exr' - "$RELUME" notes fixed.exr
expect_fail '... are not published' 1 'on an object of another shape' lost "$RELUME" publish fixed.exr -o lost
rm fixed.notes.json
expect_ok 'a table of them' - "$RELUME" notes any.exr --to csv -o notes.csv
check 'has places in space' grep -q '^"n1",point,"0 0 1",' notes.csv

"$RELUME" publish any.exr shiny.exr fixed.exr -o site --title '<script>alert(1)</script>' -q 2>note.txt ||
    { not_ok 'a site is published' "$(cat note.txt)"; finish; exit; }
check 'pages load what shows objects alone' sh -c 'grep -q relume-object.js site/any.html && ! grep -q "relume.js" site/any.html'
check 'a title is text' [ -z "$(grep -rl '<script>alert' site --include='*.html')" ]
"$sphere" planar --size 32 --lights 12 --hemisphere || exit 1
"$RELUME" encode planar -o planar.exr -q && "$RELUME" publish planar.exr -o flat -q || exit 1
check 'other sites have no part of it' [ ! -e flat/relume/relume-object.js ]
"$RELUME" publish any.exr -o again --threads 1 -q
check 'byte for byte' sh -c 'cmp site/any/object.bin again/any/object.bin && cmp site/any/poster.jpg again/any/poster.jpg && diff -r site/any/iiif again/any/iiif'
# what other programs show: the mesh in light from everywhere, under which a matte ball has its own colour
check 'the texture of the mesh is the colour of the ball' awk -v a="$("$mkimage" read site/any/iiif/texture.jpg 12 12)" 'BEGIN {
    split(a, p, " "); split("0.8 0.4 0.2", q, " "); for (c = 1; c <= 3; c++) { d = p[c] - q[c]; bad = bad || d > 0.03 || d < -0.03 } print a; exit bad }'
check 'byte for byte, for any threads' cmp site/any/model.glb again/any/model.glb
modules=$TOP/build/web/node_modules
if [ "$node" ] && [ -d "$modules/gltf-validator" ]; then
    check "Khronos's validator has nothing to say of the mesh" sh -c "node '$TOP/tests/tools/gltf_check.mjs' '$modules' site/shiny/model.glb | grep -q '^errors 0 warnings 0'"
else
    skip 'the mesh is glTF' 'no node and gltf-validator; make deps-web gets them'
fi
if [ "$python" ]; then
    check 'the mesh has the triangles and the box of the object, and a manifest' "$python" -c "
import json, struct
data = open('site/any/model.glb', 'rb').read(); length, = struct.unpack_from('<I', data, 12); m = json.loads(data[20:20 + length])
p = m['meshes'][0]['primitives'][0]; at = m['accessors'][p['attributes']['POSITION']]; o = json.load(open('site/any/object.json'))
assert all(abs(a - b) < 1e-6 for a, b in zip(at['min'] + at['max'], o['min'] + o['max'])), at
assert m['accessors'][p['indices']]['count'] == 3 * o['triangles'] and m['images'][0]['mimeType'] == 'image/jpeg'
body = json.load(open('site/any/iiif/model.json'))['items'][0]['items'][0]['items'][0]['body']
assert body == {'id': 'any/model.glb', 'type': 'Model', 'format': 'model/gltf-binary'}, body
m = json.load(open('site/any/manifest.json')); assert m['rendering'][0]['id'] == 'any/model.glb' and all('thumbnail' in c for c in m['items'])"
    check 'a manifest has a canvas for each picture from around it, the model, and its notes' "$python" -c "
import json, os
m = json.load(open('site/any/manifest.json')); bodies = [c['items'][0]['items'][0]['body'] for c in m['items']]
assert len(bodies) == 8 and len({b['id'] for b in bodies}) == 8 and all(os.path.exists('site/' + b['id']) for b in bodies)
assert m['seeAlso'][0]['type'] == 'Model' and m['annotations'][0]['id'] == 'any/iiif/notes.json'
notes = json.load(open('site/any/iiif/notes.json'))['items']
assert notes[0]['target']['source'] == m['seeAlso'][0]['id'] and notes[0]['target']['selector'] == {'type': 'PointSelector', 'x': 0, 'y': 0, 'z': 1}
assert 'annotations' not in json.load(open('site/fixed/manifest.json'))"
else
    skip 'the manifest of an object' 'no python3'
fi

if ! [ "$node" ] || ! [ "$browser" ]; then
    skip 'pages of objects in a browser' 'no chromium and node; make deps-web installs them'
    finish
    exit
fi
node --check site/relume/relume-object.js 2>check.txt || { not_ok 'the modules join to a script' "$(head -n 5 check.txt)"; finish; exit; }
axe=$TOP/build/web/node_modules/axe-core/axe.min.js
[ -e "$axe" ] && cp "$axe" site/axe.js || skip 'pages of objects are accessible' 'no axe-core; make deps-web gets it'
mkdir site/far
sed 's/"min": [^m]*"max": \[.*/"min": [9, 9, 9], "max": [11, 11, 11],/' site/any/object.json >far.json
{ printf 'relume.put("far/object.json", "'; base64 -w0 far.json; printf '");\n'; } >site/far/object.json.js
sed 's/any/far/' site/any/object.bin.js >site/far/object.bin.js
cp -r site bad
sed -i 's/"version": 1/"version": 9/' bad/any/object.json
{ printf 'relume.put("any/object.json", "'; base64 -w0 bad/any/object.json; printf '");\n'; } >bad/any/object.json.js
{ printf 'relume.put("shiny/object.bin", "'; head -c 3000 site/shiny/object.bin | base64 -w0; printf '");\n'; } >bad/shiny/object.bin.js
rm bad/fixed/object.bin bad/fixed/object.bin.js

n=0
shots=
open() { # page: the object alone, as large as its window
    echo "open file://$work/site/$1.html" >>orders.txt
    echo "eval (o => { o.controls.node.remove(); o.style.cssText = 'position:fixed;inset:0;height:auto;min-height:0;z-index:9'; return new Promise(done => setTimeout(done, 200)); })(document.querySelector('relume-object'))" >>orders.txt
}
snap() { # file, state, options of relume btf render
    n=$((n + 1))
    printf 'state %s\nsnap page%d.png\n' "$2" $n >>orders.txt
    file=$1
    shift 2
    "$RELUME" btf render "$file.exr" -o tool$n.png --picture 128x96 --samples 2 -q "$@" || exit 1
    shots="$shots $file:$n"
}
echo 'size 128 96' >orders.txt
open any
snap any 'light=dir,0,1,1' --light 'dir 0 1 1'
snap any 'light=dir,1,0.2,-0.3&eye=2,1.5,-2' --eye 2,1.5,-2 --light 'dir 1 0.2 -0.3'
snap any 'light=dir,-1,0,1&light=dir,1,1,1,rgb,0.1,0.3,0.9' --light 'dir -1 0 1' --light 'dir 1 1 1 rgb 0.1 0.3 0.9'
ask "window.relume.setState('light=dir,0,3,4&eye=0,0,9&later=1') || window.relume.getState()"
ask "window.relume.setState('light=point,0,0,1&eye=NaN,0,1&at=1e300,0,1') || document.querySelector('relume-object').status.textContent"
{ echo 'state light=dir,0,0,1&eye=0,0,9'; echo 'drag 30 30 90 30'; } >>orders.txt
ask 'window.relume.getState()'
{ echo 'state light=dir,0,0,1&eye=0,0,9'; echo 'key ArrowRight l ArrowRight n + ]'; } >>orders.txt
ask 'window.relume.getState()'
view="document.querySelector('relume-object')"
ask "['notes', $view.panel.notes.all.map(n => n.kind).join(), $view.panel.notes.sayMeasures($view.panel.notes.all[2]), $view.panel.list.textContent.includes('<b>front</b>')]"
# what is in front is seen, what is behind it is not; a click finds a note, or the surface
echo 'state eye=0,0,9&light=dir,0,0,1' >>orders.txt
ask "['seen', $view.viewer.toCanvas([0, 0, 1]).map(Math.round), $view.viewer.toCanvas([0, 0, -1]), $view.overlay.find(64, 48).item.id]"
ask "($view.panel.begin('line'), 0)"
{ echo 'drag 64 48 64 48'; echo 'drag 2 2 2 2'; } >>orders.txt
ask "['beside it', $view.status.textContent]"
{ echo 'drag 74 48 74 48'; echo 'key Enter'; } >>orders.txt
ask "(n => ['drawn', n.kind, n.places.length, n.places[0].map(x => +x.toFixed(2)), n.state, n.item.target.selector.type])($view.panel.notes.all[5])"
ask "($view.panel.text.value = 'made <here>', $view.panel.write(), $view.panel.choose($view.panel.notes.all[0]), $view.panel.visit(), window.relume.getState())"
echo "write saved.json $view.panel.notes.toText()" >>orders.txt
# a kept look, the same after the light has moved; another object; one that lies elsewhere
ask "(window.relume.setState('light=dir,0,1,1'), $view.keep(), window.relume.setState('light=dir,0,1,1&eye=2,1.5,-2'), $view.compare('blink').then(() => { clearInterval($view.viewer.comparison.timer); return window.relume.idle(); }).then(() => 'blinks'))"
echo 'snap kept.png' >>orders.txt
ask "($view.setAttribute('compare', 'shiny/object.json'), $view.viewer.comparison.drop(), window.relume.setState('light=dir,0,1,1'), $view.compare('blink').then(() => { clearInterval($view.viewer.comparison.timer); return window.relume.idle(); }).then(() => $view.status.textContent))"
echo 'snap other.png' >>orders.txt
ask "$view.compare('slider').then(() => { $view.divide(0.5); return window.relume.idle(); }).then(() => ['slider', $view.way.value, $view.divider.hidden])"
echo 'snap slider.png' >>orders.txt
ask "($view.setAttribute('compare', 'far/object.json'), $view.compare('lens').then(() => [$view.status.textContent, $view.way.value]))"
ask "$view.compare('off').then(() => $view.toggleMode())"
echo 'state light=dir,0,0,1&eye=0,0,9' >>orders.txt
echo 'touch 30 30 90 30' >>orders.txt
ask "['touched', window.relume.getState()]"
echo 'state light=dir,0,0,1&eye=0,0,9' >>orders.txt
echo 'touch 54 48 34 48 74 48 94 48' >>orders.txt
ask "['pinched', window.relume.getState()]"
# the surface over a line: the table of the tool
ask "($view.panel.choose($view.panel.notes.all[2]), URL.createObjectURL = (blob) => { window.table = blob.text(); return '#'; }, $view.panel.profile().then(() => $view.panel.profiled.querySelector('button').click()).then(() => ['profile', $view.panel.measures.textContent, !!$view.panel.profiled.querySelector('svg')]))"
echo "write page.csv window.table" >>orders.txt
# a line by keys alone: from the middle to 20 pixels beside it
ask "($view.panel.choose(null), window.relume.setState('light=dir,0,0,1&eye=0,0,9'), window.relume.idle().then(() => ($view.panel.begin('line'), 0)))"
echo 'key Space ArrowRight ArrowRight Space Enter' >>orders.txt
ask "(n => ['by keys', n.kind, n.places.length, n.places[0].map(x => +x.toFixed(2)), Math.round($view.viewer.toCanvas(n.places[1])[0])])($view.panel.notes.all[$view.panel.notes.all.length - 1])"
# very many notes: those in front are drawn on the card, without a stroke on the canvas; those behind are not
item="(n, x, y, z) => ({ id: 'm' + n, type: 'Annotation', body: { value: 'm' + n }, target: { selector: { type: 'PointSelector', x, y, z } } })"
ask "($view.status.remove(), $view.overlay.context.stroke = () => { window.strokes = (window.strokes || 0) + 1; }, $view.panel.choose(null), $view.panel.notes.read({ type: 'AnnotationPage', items: Array.from({ length: 200 }, (_, i) => ($item)(i, i % 2 ? 0.4 : 0, 0, i % 2 ? -0.9165 : 1)) }), window.relume.setState('light=dir,0,0,1&eye=0,0,9'), window.relume.idle().then(() => window.relume.idle()).then(() => { window.before = window.strokes; $view.viewer.turn(0.5, 0); $view.viewer.turn(-0.5, 0); return new Promise(done => setTimeout(done, 500)); }).then(() => ['many', window.strokes === undefined || window.strokes - window.before, $view.overlay.isPinned, $view.viewer.toCanvas([0.4, 0, 0.9165]).map(Math.round)]))"
echo 'shot many.png' >>orders.txt
echo 'snap alone.png' >>orders.txt
# in a page of one's own, by the element that pictures have
cat >site/own.html <<'END'
<!DOCTYPE html><script src="relume/relume.js" defer></script><relume-view src="any/object.json" state="eye=0,0,9&light=dir,0,3,4" style="position:fixed;inset:0;height:auto;min-height:0"></relume-view>
END
echo "open file://$work/site/own.html" >>orders.txt
ask "(v => v.idle().then(() => (v.object.controls.node.remove(), new Promise(done => setTimeout(done, 200)))).then(() => ['embedded', v.getState(), v.object.tagName, v.viewer || null]))(document.querySelector('relume-view'))"
echo 'state light=dir,0,1,1' >>orders.txt
echo 'snap embedded.png' >>orders.txt
open shiny
snap shiny 'light=dir,0,1,1' --light 'dir 0 1 1'
snap shiny 'light=dir,1,0.2,1&eye=2,1,2' --eye 2,1,2 --light 'dir 1 0.2 1'
open fixed
snap fixed 'light=dir,0,1,-1' --light 'dir 0 0 1'
# from a server, with all controls
{ echo "serve https://museum.test/ $work/site"; echo 'size 1000 700'; echo 'open https://museum.test/any.html'; } >>orders.txt
echo 'state eye=0,0,9&light=dir,0,0.6,0.8' >>orders.txt
[ -z "${SHOT:-}" ] || echo "shot $SHOT" >>orders.txt
echo 'key m' >>orders.txt
ask "['keys', $view.panel.node.hidden, $view.root.activeElement.textContent]"
if [ -e "$axe" ]; then
    ask "new Promise(done => { const script = document.createElement('script'); script.src = 'axe.js'; script.onload = done; document.head.append(script); })"
    ask "axe.run().then(found => 'axe ' + found.violations.filter(v => ['serious', 'critical'].includes(v.impact)).map(v => v.id))"
fi
# a phone: all that is touched is large and within the window; a button shows the rest
small="(all => [all.length, all.filter(b => b.width < 44 || b.height < 44 || b.left < 0 || b.right > innerWidth).length, document.documentElement.scrollWidth])([...$view.root.querySelectorAll('.strip button, .strip select, .strip input')].map(b => b.getBoundingClientRect()).filter(b => b.width > 0))"
echo 'size 360 640' >>orders.txt
ask "new Promise(done => setTimeout(done, 300)).then(() => ['narrow', ...$small, $view.root.querySelector('.unfold').click(), ...$small, $view.root.querySelector('.unfold').getAttribute('aria-expanded')])"
echo 'size 128 96' >>orders.txt
for page in any shiny fixed; do
    echo "open file://$work/bad/$page.html" >>orders.txt
    ask "(o => [o.status.textContent, !o.poster.hidden])(document.querySelector('relume-object'))"
done
browse
for shot in $shots; do
    # weights are 8 bits and components halves; here 0.01 to 0.02, and 7 between two lights
    below "${shot%:*}: the page shows relume btf render (${shot#*:})" "$("$mkimage" codediff page${shot#*:}.png tool${shot#*:}.png)" 0.25
done
says 'the state comes back' '^"eye=0,0,9&light=dir,0,0.6,0.8&later=1"'
says 'what cannot be shown is said' '^"This link asks for what cannot be shown \(light, eye, at\)'
says 'a drag turns the object' '^"eye=-[0-9.]+,0,[-0-9.]+&light=dir,0,0,1"'
says 'keys turn, move and add lights, enlarge and brighten' '^"eye=[-0-9.]+,0,[0-9.]+&at=0,0,1.25&exposure=0.25&light=dir,[^&]*&light=dir'
says 'a page has the notes, as text' '^\["notes","point,point,line,polygon,view","56.57 mm, 60°",true\]'
says 'notes behind the object are not seen; a click finds one' '^\["seen",\[64,48\],null,"n1"\]'
says 'beside the object there is no place' '^\["beside it","There is nothing there'
says 'places lie on the surface' '^\["drawn","line",2,\[0,0,(0\.9[89]|1)\],"eye=0,0,9&light=dir,0,0,1","WktSelector"\]'
says 'a note brings its light back' '^"eye=0,0,9&exposure=0.5&light=dir,0,0.6,0.8"'
says 'another object is compared with' '^"This is compared with shiny|^"This is compared with <script>'
says 'the slider is shown' '^\["slider","slider",false\]'
says 'what lies elsewhere is refused' '^\["[^"]* cannot be compared with this one: it lies elsewhere, or has another size\.","off"\]'
says 'a finger turns it' '^\["touched","eye=-[0-9.]+,0,[-0-9.]+&light=dir,0,0,1"\]'
says 'two fingers enlarge it' '^\["pinched","eye=0,0,9&at=[-0-9.e]+,0,3&light=dir,0,0,1"\]'
says 'a server has all that it asks for' '^asked any/object.bin$'
check '... and is not asked for more' sh -c "! grep '^asked .* missing' said.txt | grep -v favicon"
says 'on a phone all controls are at hand and large enough' '^\["narrow",11,0,360,null,16,0,360,"true"\]'
says 'keys open the notes' '^\["keys",false,"Point"\]'
[ ! -e "$axe" ] || says 'axe-core finds nothing serious' '^"axe "$'
below 'a kept look stays' "$("$mkimage" codediff kept.png page1.png)" 0.01
below 'the other object is shown as its own page does' "$("$mkimage" codediff other.png page4.png)" 0.01
near() { # two pictures, a pixel of both
    awk -v a="$("$mkimage" read $1 $3 $4)" -v b="$("$mkimage" read $2 $3 $4)" 'BEGIN {
        split(a, p, " "); split(b, q, " "); for (c = 1; c <= 3; c++) { d = p[c] - q[c]; bad = bad || d > 0.01 || d < -0.01 }
        print a, "and", b; exit bad || !(p[1] > 0.01) }'
}
near_colour() { # picture, pixel, its linear colour
    awk -v a="$("$mkimage" read $1 $2 $3)" -v b="$4 $5 $6" 'BEGIN { split(a, p, " "); split(b, q, " ")
        for (c = 1; c <= 3; c++) { d = p[c] - q[c]; bad = bad || d > 0.1 || d < -0.1 } print a; exit bad }'
}
not() { ! "$@"; }
check 'beside each other this object is at the left' near slider.png page1.png 50 44
check 'and the other one at the right' near slider.png other.png 78 44
says 'a page draws the surface over a line' '^\["profile","[^"]*",true\]'
"$RELUME" notes any.exr --profile n3 -o tool.csv -q
# places of a page are 16 bits of the box
check '... as the tool has it' awk -F, 'NR == FNR { row[FNR] = $0; next } FNR == 1 { bad = row[1] != $0; next } {
    n = split(row[FNR], p, ","); if (n != NF || n < 5) bad = 1
    for (c = 1; c <= n; c++) { d = p[c] - $c; if (d < 0) d = -d; if (d > 1e-3 * (1 + ($c < 0 ? -$c : $c))) { bad = 1; print FNR, row[FNR], $0 } } count++ } END { exit bad || count != 256 }' page.csv tool.csv
says 'keys alone draw a line' '^\["by keys","line",2,\[0,0,(0\.9[89]|1)\],84\]'
says '<relume-view> shows an object too' '^\["embedded","eye=0,0,9&light=dir,0,0.6,0.8","RELUME-OBJECT",null\]'
below '... as its page does' "$("$mkimage" codediff embedded.png page1.png)" 0.01
says 'very many notes are drawn by the card' '^\["many",(0|true),true,\[76,48\]\]'
check '... those in front are seen' near_colour many.png 60 44 0.807 0.552 0.144
check '... those behind are not' near many.png alone.png 72 44
check '... and no picture that is saved has them' not near many.png alone.png 60 44
expect_ok 'what a page saved comes back' '1 new note' "$RELUME" notes any.exr --import saved.json
check 'with its place, text and light' grep -q '^n6 *line .* made <here>' out.txt
if [ "$python" ]; then
    check 'nothing of it is lost' "$python" -c "
import json
a, b = (json.load(open(f))['items'] for f in ('saved.json', 'any.notes.json'))
assert a == b, (a, b)"
fi
says 'a newer object says so' '^\["Only a still picture can be shown: this object was published by a newer relume .format 9.*",true\]'
says 'numbers cut short are said' '^\["Only a still picture can be shown: object.bin is damaged\.",true\]'
says 'missing numbers are said' '^\["Only a still picture can be shown: bad/fixed/object.bin is missing'
finish
