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
bake ball.json -o any.exr $small -k 25
bake shiny.json -o shiny.exr $small --views 3 -k 16
bake ball.json -o fixed.exr --size 24x24 --rays 8 --light 'dir 1 1 1' --light 'dir -1 0 1 rgb 0 0 1' -q
bake ball.json -o haar.exr --size 16x16 --bounces 0 --haar 2 -q
expect_fail 'wavelets' 1 'haar.exr: baked with --haar, which no page shows; expected' site "$RELUME" publish haar.exr -o site
head -c 3000 any.exr >cut.exr
expect_fail 'a file cut short' 1 'cut.exr' site "$RELUME" publish cut.exr -o site

"$RELUME" publish any.exr shiny.exr fixed.exr -o site --title '<script>alert(1)</script>' -q 2>note.txt ||
    { not_ok 'a site is published' "$(cat note.txt)"; finish; exit; }
check 'pages load what shows objects alone' sh -c 'grep -q relume-object.js site/any.html && ! grep -q "relume.js" site/any.html'
check 'a title is text' [ -z "$(grep -rl '<script>alert' site --include='*.html')" ]
"$sphere" planar --size 32 --lights 12 --hemisphere || exit 1
"$RELUME" encode planar -o planar.exr -q && "$RELUME" publish planar.exr -o flat -q || exit 1
check 'other sites have no part of it' [ ! -e flat/relume/relume-object.js ]
"$RELUME" publish any.exr shiny.exr fixed.exr -o again --title '<script>alert(1)</script>' --threads 1 -q
check 'byte for byte' diff -r site again

if ! [ "$node" ] || ! [ "$browser" ]; then
    skip 'pages of objects in a browser' 'no chromium and node; make deps-web installs them'
    finish
    exit
fi
node --check site/relume/relume-object.js 2>check.txt || { not_ok 'the modules join to a script' "$(head -n 5 check.txt)"; finish; exit; }
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
open shiny
snap shiny 'light=dir,0,1,1' --light 'dir 0 1 1'
snap shiny 'light=dir,1,0.2,1&eye=2,1,2' --eye 2,1,2 --light 'dir 1 0.2 1'
open fixed
snap fixed 'light=dir,0,1,-1' --light 'dir 0 0 1'
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
says 'a newer object says so' '^\["Only a still picture can be shown: this object was published by a newer relume .format 9.*",true\]'
says 'numbers cut short are said' '^\["Only a still picture can be shown: object.bin is damaged\.",true\]'
says 'missing numbers are said' '^\["Only a still picture can be shown: bad/fixed/object.bin is missing'
finish
