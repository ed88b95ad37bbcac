#!/bin/sh
# Relume files that are dropped onto pages, from a disk, without network: what is shown is what relume
# relight shows, and what cannot be shown is refused by a sentence.
. "$(dirname "$0")/lib.sh"
node=$(command -v node || true)
browser=
for b in chromium chromium-browser google-chrome; do
    [ "$browser" ] || browser=$(command -v $b || true)
done
if ! [ "$node" ] || ! [ "$browser" ]; then
    skip 'files dropped onto pages' 'no chromium and node; make deps-web installs them'
    finish
    exit
fi

"$sphere" dome --size 48 --lights 16 --hemisphere --shade wrap --format png || exit 1
"$RELUME" encode dome -o dome.exr -q || exit 1
"$RELUME" encode dome -o log.exr --domain log --basis pca -q || exit 1
"$sphere" ball --size 32 --lights 12 --hemisphere --shade wrap --format png --mask || exit 1
"$RELUME" encode ball -o lossy.exr --psnr 40 -q || exit 1
"$RELUME" synth teapot -o pot --size 32 --views 2x2 --lights 12 --hemisphere --samples 1 -q || exit 1
"$RELUME" encode pot -o pot.exr -q || exit 1
"$RELUME" synth attic -o room --projection spherical --size 32 --lights 16 --samples 1 -q || exit 1
"$RELUME" encode room -o room.exr --shadows no -q || exit 1
"$RELUME" publish dome.exr -o site -q || exit 1
head -c 900 dome.exr >head.exr
head -c "$(($(wc -c <dome.exr) * 2 / 3))" dome.exr >cut.exr
echo text >text.exr
"$RELUME" relight dome.exr -o ordinary.exr -q || exit 1
{ # the first digit of the version's value, four bytes behind its size
    at=$(grep -obUa 'relume.version' dome.exr | head -n 1 | cut -d : -f 1)
    head -c "$((at + 23))" dome.exr && printf '\011' && tail -c "+$((at + 25))" dome.exr
} >newer.exr
named='<img src=x onerror=window.broken=1>'
cp dome.exr "$named.exr"

# As a visitor drops it: an event with a file, onto the first view, or anywhere on a page without one.
cat >drop.js <<'E'
window.dropped = (base64, name) => new Promise((done) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)), dataTransfer = new DataTransfer();
    const before = document.querySelector('relume-view'), place = before ? before.surface : document.querySelector('h1');
    const said = () => (before ? before.status : document.querySelector('[data-relume-said]')).textContent;
    dataTransfer.items.add(new File([bytes], name));
    if (before)
        before.status.textContent = '';
    place.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true, composed: true }));
    const timer = setInterval(() => {
        const now = document.querySelector('relume-view');
        if (now === before && (said() === '' || said().startsWith('Opening ')))
            return;
        clearInterval(timer);
        done(now === before ? said() : now.ready.then(() => now.status.textContent));
    }, 20);
});
E
echo "before $(tr '\n' ' ' <drop.js)" >orders.txt
drop() { # file
    echo "eval dropped('$(base64 -w0 "$1")', '$1')" >>orders.txt
}
alone() {
    echo "eval (v => { v.controls.node.remove(); v.style.cssText = 'position:fixed;inset:0;height:auto;min-height:0;z-index:9'; return new Promise(done => setTimeout(done, 100)); })(document.querySelector('relume-view'))" >>orders.txt
}
n=0 shots=
snap() { # file, state, options of relume relight
    n=$((n + 1))
    echo "state $2" >>orders.txt
    echo "snap page$n.png" >>orders.txt
    "$RELUME" relight "$1.exr" -o tool$n.png -q $3 "$4" "$5" || exit 1
    shots="$shots $n"
}
echo 'size 48 48' >>orders.txt
# a page that has no view of its own, then one that has the dropped file
echo "visit file://$work/site/index.html" >>orders.txt
drop text.exr
drop "$named.exr"
alone
snap "$named" 'light=dir,0.6,0.3,0.7' '' --light 'dir 0.6 0.3 0.7'
for bad in head cut text ordinary newer log; do drop "$bad.exr"; done
drop lossy.exr
alone
echo 'size 32 32' >>orders.txt
snap lossy 'light=dir,0.3,0.3,0.7' '' --light 'dir 0.3 0.3 0.7'
shots=${shots% *} masked=$n
drop pot.exr
alone
echo 'size 96 96' >>orders.txt
snap pot 'light=dir,0.5,0.3,0.7&eye=0.1,-0.1,3' '--size 96x96 --eye 0.1,-0.1,3' --light 'dir 0.5 0.3 0.7'
drop room.exr
alone
snap room 'light=dir,0,1,0.3&pan=30&tilt=10&zoom=1' '--size 96x96 --pan 30 --tilt 10' --light 'dir 0 1 0.3'
echo "visit file://$work/site/open.html" >>orders.txt
echo "eval window.relume.open(new File(['?'], 'x.exr')).then(() => 'opened', (error) => error.message)" >>orders.txt
echo 'eval window.broken === undefined' >>orders.txt
mkdir home
HOME=$work/home timeout 170 node "$TOP/tests/tools/page.mjs" "$browser" "$work/home/profile" <orders.txt >said.txt 2>&1 ||
    not_ok 'the browser does as it is told' "$(grep -E '^failed' said.txt)"
check 'pages throw nothing' sh -c '! grep "^thrown" said.txt'
says() { # name, line
    if grep -qF "$2" said.txt; then ok "$1"; else not_ok "$1" "expected '$2', found: $(cat said.txt)"; fi
}
for shot in $shots; do
    # codes are those of the file, or halves: what is left is rounding to 8 bits, and how slabs are enlarged
    below "a dropped file shows relume relight ($shot)" "$("$mkimage" codediff page$shot.png tool$shot.png)" 0.5
done
below 'coded with loss, within a mask' "$("$mkimage" read page$masked.png 16 16 | tr '\n' ' ' |
    awk -v tool="$("$mkimage" read tool$masked.png 16 16)" '{ split(tool, t); d = $1 - t[1]; print (d < 0 ? -d : d) }')" 0.01
check 'outside it the ground of the page' [ "$("$mkimage" read page$masked.png 1 1 | cut -c 1-6)" = 0.0080 ]
says 'a beginning is refused' '"head.exr: cannot be read as OpenEXR; it is damaged or cut off in its header."'
says 'a file that is cut off is refused' '"cut.exr: '
says 'a text is refused, on a page with a view' '"text.exr: cannot be read as OpenEXR; it is a file of another kind."'
says 'an ordinary EXR is refused' '"ordinary.exr: an OpenEXR file, but not a relume file'
says 'a newer version is refused' '"newer.exr: version 9 of the format is newer than this program'
says 'logarithms are refused' '"log.exr: its coefficients are logarithms'
says 'a name is text' 'onerror=window.broken=1>.exr was read by this browser and sent nowhere."'
check 'on a page without a view too' [ "$(grep -c '^"text.exr: ' said.txt)" -eq 2 ]
says 'a script is told why' '"x.exr: cannot be read as OpenEXR'
check 'no script of a name runs' [ "$(tail -n 1 said.txt)" = true ]
finish
