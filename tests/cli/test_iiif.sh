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
# an object: pictures from around it, and the mesh
awk -v n=8 -f "$TOP/scripts/ball.awk" >ball.obj
echo '{"format":"relume-objects","version":1,"objects":[{"mesh":"ball.obj","parts":[{"material":{"diffuse":[0.8,0.4,0.2]}}]}]}' >ball.json
relume bake ball.json -o thing.exr --size 24x24 --rays 8 --light 'dir 1 1 1' || exit 1
relume publish thing.exr -o thing --url https://museum.test/thing || exit 1
mv thing root/thing
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
for of in manifest.json iiif/model.json; do
    sed "s,site/ball/manifest.json,thing/thing/$of,; /^const notes/d" root/universal.html >root/thing-${of##*/}.html
    {
        echo "visit https://museum.test/thing-${of##*/}.html"
        echo "until performance.getEntriesByType('resource').filter((one) => /turn-2.jpg|model.glb/.test(one.name)).length"
        echo 'eval new Promise((done) => setTimeout(done, 3000)).then(() => 0)'
        echo "shot ${of##*/}.png"
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
check 'an object: the Universal Viewer lists its pictures' grep -q '^asked thing/thing/iiif/turn-2.jpg$' said.txt
check '... and shows its mesh, which is red in the middle' awk -v a="$("$mkimage" read model.json.png 430 345)" 'BEGIN { split(a, p, " "); print a; exit !(p[1] > 0.05 && p[1] > 1.3 * p[3]) }'
check '... and all of it is there' sh -c "! grep -E '^asked thing/.* missing' said.txt"
check 'Mirador has the notes' grep -q '^true' mirador.txt
finish
