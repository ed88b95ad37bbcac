#!/bin/sh
# A published picture in the IIIF viewers of museums, Mirador and the Universal Viewer: each opens the
# manifest, asks for tiles and shows the picture. The browser answers for the address of the site.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/page.sh"
viewers=$TOP/build/web/iiif
if ! [ "$node" ] || ! [ "$browser" ] || ! [ -e "$viewers/mirador" ] || ! [ -e "$viewers/universalviewer" ]; then
    skip 'published pictures in IIIF viewers' 'no chromium, node, Mirador and Universal Viewer; make deps-web gets them'
    finish
    exit
fi
"$sphere" ball --size 640 --lights 6 --hemisphere --shade wrap --format jpg || exit 1
relume encode ball -o ball.exr --basis pca --coefficients 4 || exit 1
relume notes ball.exr --add 'polygon 100,100 200,100 200,200' --text 'a loss' >/dev/null || exit 1
mkdir root home
relume publish ball.exr -o root/site --url https://museum.test/site || exit 1
relume relight ball.exr -o ball.png || exit 1
ln -s "$viewers" root/viewers
cat >root/mirador.html <<'END'
<!DOCTYPE html><meta charset="utf-8"><div id="place" style="position:absolute;inset:0"></div>
<script src="viewers/mirador/dist/mirador.min.js"></script>
<script>
const viewer = Mirador.viewer({ id: 'place', windows: [{ manifestId: 'https://museum.test/site/ball/manifest.json' }] });
const notes = () => JSON.stringify(viewer.store.getState().annotations).includes('a loss');
</script>
END
cat >root/universal.html <<'END'
<!DOCTYPE html><meta charset="utf-8"><link rel="stylesheet" href="viewers/universalviewer/dist/uv.css">
<div id="place" class="uv" style="position:absolute;inset:0"></div>
<script src="viewers/universalviewer/dist/umd/UV.js"></script>
<script>
UV.init('place', { manifest: 'https://museum.test/site/ball/manifest.json' });
const notes = () => document.body.textContent.includes('ball');
</script>
END
{
    echo 'size 800 600'
    echo "serve https://museum.test/ $work/root"
} >orders.txt
# The picture fills the middle when its tiles have come and the viewer has flown there.
for viewer in mirador universal; do
    {
        echo "visit https://museum.test/$viewer.html"
        echo "until notes() && performance.getEntriesByType('resource').filter((one) => /iiif.*512.*jpg/.test(one.name)).length >= 2"
        echo 'eval new Promise((done) => setTimeout(done, 2500)).then(() => notes())'
        echo "shot $viewer.png"
    } >>orders.txt
done
HOME=$work/home timeout 240 node "$TOP/tests/tools/page.mjs" "$browser" "$work/home/profile" <orders.txt >said.txt 2>&1 ||
    not_ok 'the browser does as it is told' "$(grep -E '^failed' said.txt)"
for viewer in mirador universal; do
    sed -n "/^asked $viewer.html/,/^true/p" said.txt >$viewer.txt
    check "$viewer: the manifest and a tile are asked for" grep -qE '^asked site/ball/iiif/[0-9]+,[0-9]+,[0-9]+,[0-9]+/[0-9,]+/0/default.jpg$' $viewer.txt
    check "$viewer: all that it asks for is there" sh -c "! grep -E '^asked site/.* missing' $viewer.txt"
    # the ball is brown where the tool has it so, a little beside the middle of the window
    check "$viewer: the picture is seen" awk -v a="$("$mkimage" read $viewer.png 410 310)" -v b="$("$mkimage" read ball.png 320 320)" 'BEGIN {
        split(a, p, " "); split(b, q, " "); for (c = 1; c <= 3; c++) { d = p[c] - q[c]; if (d > 0.05 || d < -0.05) bad = 1 }
        print a, "and", b; exit bad || !(q[1] > 1.5 * q[3]) }'
done
check 'Mirador has the notes' grep -q '^true' mirador.txt
finish
