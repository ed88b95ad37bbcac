#!/bin/sh
# What people do on published pages beside looking: comparing two files, very many notes, profiles, lamps
# that stand near.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/page.sh"
if ! [ "$node" ] || ! [ "$browser" ]; then
    skip 'tools of published pages' 'no chromium and node; make deps-web installs them'
    finish
    exit
fi
"$sphere" old --size 48 --lights 20 --hemisphere --shade wrap --format png || exit 1
"$sphere" new --size 96 --lights 20 --hemisphere --shade full --format png || exit 1
relume encode old -o old.exr --basis pca --coefficients 9 || exit 1
relume encode new -o new.exr --basis pca --coefficients 12 --no-depth || exit 1
relume synth teapot -o pot --size 24 --views 2x2 --lights 9 --hemisphere --samples 1 || exit 1
relume encode pot -o pot.exr --basis pca --coefficients 6 || exit 1
"$RELUME" notes old.exr --add 'line 8.3,12 30.5,24 40,44.2' --scale 0.25 -q >/dev/null || exit 1
"$RELUME" notes new.exr --add 'line 32.2,40.1 64,58.7' -q >/dev/null || exit 1
"$RELUME" notes pot.exr --add 'line 10.625,12.625 14.625,12.625' -q >/dev/null || exit 1
for file in old new; do
    "$RELUME" notes $file.exr --profile n1 -o $file.csv -q || exit 1
done
relume publish old.exr new.exr pot.exr -o site --metadata /dev/stdin <<'END' || exit 1
{"title": "Both", "files": {"new": {"title": "After the <b>cleaning</b>"}}}
END
# A page with the attribute. Its script has pixels() of what is seen, rows from the top.
page() { # name, other file
    cat >site/$1.html <<END
<!DOCTYPE html><script src="relume/relume.js" defer></script><relume-view src="old/scene.json" compare="$2/scene.json"></relume-view>
<script>
const view = document.querySelector('relume-view');
async function pixels() {
    const picture = await createImageBitmap(await view.snapshot()), { width, height } = picture;
    const context = Object.assign(document.createElement('canvas'), { width, height }).getContext('2d');
    context.drawImage(picture, 0, 0);
    return context.getImageData(0, 0, width, height).data;
}
// The largest difference of what is seen from expected(own, other), pixel by pixel; null: no matter.
async function worst(expected) {
    await view.idle();
    const seen = await pixels();
    let most = 0;
    for (let i = 0; i < seen.length; i++) {
        const wanted = i % 4 < 3 ? expected(own[i], other[i], (i >> 2) % 96, Math.floor(i / 384)) : null;
        most = wanted === null ? most : Math.max(most, Math.abs(seen[i] - wanted));
    }
    return most;
}
let own, other;
</script>
END
}
page both new
page unlike pot
page none lost
light=0.3,0.4,0.8
{
    echo 'size 96 96'
    show site/both.html
    echo "state light=dir,$light"
} >orders.txt
ask "pixels().then(seen => { own = seen; return 0; })"
ask "view.compare('blink').then(() => { clearInterval(view.viewer.comparison.timer); return view.idle(); }).then(() => ['blinks', view.viewer.comparison.second, view.status.textContent])"
echo 'snap other.png' >>orders.txt
ask "pixels().then(seen => { other = seen; return 0; })"
ask "view.compare('slider').then(() => { view.divide(0.25); return worst((a, b, x) => (x < 23 ? a : x > 25 ? b : null)); }).then(most => 'slider ' + most)"
ask "view.compare('difference').then(() => worst((a, b) => Math.min(2 * Math.abs(a - b), 255))).then(most => 'difference ' + most)"
ask 'view.toggleMode()'
echo 'drag 60 30 60 30' >>orders.txt
ask "view.compare('lens').then(() => worst((a, b, x, y) => (away => away < 15 ? b : away > 20 ? a : null)(Math.hypot(x + 0.5 - 60, y + 0.5 - 30)))).then(most => ['lens', most, view.status.textContent])"
ask "(view.keep(), view.compare('difference').then(() => worst(() => 0)).then(most => ['kept', most, view.status.textContent]))"
for page in unlike none; do
    echo "open file://$work/site/$page.html" >>orders.txt
    ask "view.compare('slider').then(() => [view.status.textContent, view.viewer.comparison.way, view.viewer.comparison.kept])"
done
# ten thousand notes: all but the last at the left
cat >site/many.html <<'END'
<!DOCTYPE html><script src="relume/relume.js" defer></script><relume-view src="old/scene.json"></relume-view>
<script>
const view = document.querySelector('relume-view'), strokes = [];
const frame = () => new Promise((done) => requestAnimationFrame(done));
const { stroke } = CanvasRenderingContext2D.prototype;
CanvasRenderingContext2D.prototype.stroke = function () { strokes[strokes.length - 1]++; stroke.call(this); };
function begin() {
    const { overlay, panel } = view, { draw } = overlay;
    overlay.draw = () => { strokes.push(0); draw.call(overlay); };
    const item = (n) => ({ id: `n${n}`, type: 'Annotation', body: { value: `note ${n}` }, target: { selector:
        { type: 'PointSelector', x: n < 10000 ? n % 97 / 6 : 40, y: n < 10000 ? n % 101 / 3 : 20 } } });
    panel.notes.read({ type: 'AnnotationPage', items: Array.from({ length: 10000 }, (_, i) => item(i + 1)) });
    view.viewer.invalidate();
}
async function settled() {
    do await frame(); while (view.overlay.marks.job || !view.overlay.marks.shown);
}
// What lies over the picture at a place of it, of the layer that moves.
function over(place) {
    const { canvas } = view.overlay.marks.shown, box = canvas.getBoundingClientRect(), [x, y] = view.viewer.toCanvas(place);
    return [...canvas.context.getImageData((x - box.left) * canvas.width / box.width, (y - box.top) * canvas.height / box.height, 1, 1).data];
}
async function pan(steps) {
    strokes.length = 0;
    for (let i = 0; i < steps; i++) {
        view.viewer.shift(-2, 1);
        await frame();
        await frame();
    }
    return [strokes.length >= steps, Math.max(...strokes)];
}
</script>
END
# the table of a profile that is handed out; lamps near a surface that has depth, and near z = 0
lamps='point,0.4,0.3,0.8 spot,0.3,0.2,1.2,-0.2,-0.3,-1,25,rgb,2,2,2&light=dir,0,0.6,0.8,rgb,0.2,0.1,0.1 area,0.3,0.2,0.8,0,0.3,0,0.3,0,0,rgb,6,6,6'
table() { # file
    ask "(URL.createObjectURL = (blob) => { window.table = blob.text(); return '#'; }, 0)"
    echo "write page_$1.csv (async (view, panel) => { panel.choose(panel.notes.all[0]); await panel.profile(); panel.profiled.querySelector('button').click(); return window.table; })(document.querySelector('relume-view'), document.querySelector('relume-view').panel)" >>orders.txt
}
# as of a file without depth
sed -i 's/"depth": true, //' site/pot/scene.json
{ printf 'relume.put("pot/scene.json", "'; base64 -w0 site/pot/scene.json; printf '");\n'; } >site/pot/scene.json.js
show site/pot.html >>orders.txt
ask "window.relume.setState('light=point,0,0,1') || ['slab', document.querySelector('relume-view').status.textContent]"
echo 'state light=dir,0,0,1' >>orders.txt
table pot
for file in old:48 new:96; do
    echo "size ${file#*:} ${file#*:}" >>orders.txt
    show site/${file%:*}.html >>orders.txt
    table ${file%:*}
    n=0
    for lamp in $lamps; do
        n=$((n + 1))
        echo "state light=$lamp&exposure=-0.5" >>orders.txt
        echo "snap near_${file%:*}$n.png" >>orders.txt
        relume relight ${file%:*}.exr -o lamp_${file%:*}$n.png --state "light=$lamp&exposure=-0.5" || exit 1
    done
done
ask 'window.relume.getState()'
ask "(view => { const { controls } = view, seen = []; window.relume.setState('light=dir,0,0.6,0.8'); for (const [name, value] of [['distance', -1], ['softness', 30], ['distance', 0], ['softness', 0], ['distance', 3]]) { controls[name].value = value; controls.setLight(); seen.push(window.relume.getState()); } return ['sliders', ...seen]; })(document.querySelector('relume-view'))"
ask "window.relume.setState('light=spot,0,0,1,0,0,0,20&light=area,0,0,1,1,0,0,1,0,0&light=point,1,2&light=point,1,1,1,nofall,rgb,1,2,3') || ['nofall', window.relume.getState()]"
show site/many.html >>orders.txt
ask '(begin(), settled().then(() => `slices ${Math.max(...strokes)}`))'
ask 'pan(5).then(found => ["panned", ...found])'
ask '["over", over([40, 20 + 5 / view.viewer.framing().scale]), over([40, 20])]'
ask '(([x, y]) => ["found", view.overlay.find(x + 3, y).item.id, view.overlay.find(x - 15, y)])(view.viewer.toCanvas([40, 20]))'
ask '(view.viewer.enlarge(1.5), settled().then(() => ["enlarged", over([40, 20 + 5 / view.viewer.framing().scale])]))'
ask "(view.viewer.setFraming({ x: 40, y: 20, scale: 20 }), view.idle().then(() => [\"near\", Math.max(...strokes.slice(-1)), view.overlay.marks.shown]))"
echo 'key . . ,' >>orders.txt
ask '[view.status.textContent, view.overlay.chosen.item.id]'
ask '(view.toggleNotes(), view.viewer.setFraming({ x: 40, y: 20, scale: 3 }), new Promise(done => setTimeout(done, 600)).then(() => [view.panel.list.children.length, view.panel.list.textContent.slice(0, 10)]))'
browse
relume relight new.exr -o new.png --light "dir $(echo $light | tr , ' ')" || exit 1
below 'the other file is shown in the light of this one, at its own resolution' "$("$mkimage" codediff other.png new.png)" 1
says 'what is compared is said, as text' '^\["blinks",true,"This is compared with After the <b>cleaning</b>\."\]'
# both are drawn once more: a code of rounding
says 'a slider shows this file and the other one' '^"slider [01]"'
says 'the difference is twice that of the codes' '^"difference [0-2]"'
says 'a lens follows the pointer and shows the other file' '^\["lens",[01],"The lens shows After the <b>cleaning</b>\."\]'
says 'a kept look takes its place' '^\["kept",0,"This is compared with the kept look\."\]'
says 'a file of another kind is refused' '^\["pot cannot be compared with this one: it is slab, this one planar\.","off",null\]'
says 'a missing file is said' '^\["site/lost/scene.json is missing\.","off",null\]'
# a mark has two strokes
says 'ten thousand notes are drawn by and by' '^"slices 1600"'
says 'none is drawn again while the picture moves' '^\["panned",true,0\]'
says 'they lie where they belong' '^\["over",\[[12][0-9]{2},[12][0-9]{2},[0-9]+,[12][0-9]{2}\],\[0,0,0,0\]\]'
says 'a click finds its note' '^\["found","n10000",null\]'
says 'they lie where they belong when it is enlarged' '^\["enlarged",\[[12][0-9]{2},[12][0-9]{2},[0-9]+,[12][0-9]{2}\]\]'
says 'few notes are drawn as ever' '^\["near",2,null\]'
says 'keys go from note to note, which is said' '^\["1 of 10000: note 1","n1"\]'
says 'a list has what is near' '^\[201,"note 10000"\]'
# heights: of depth as it is published, 16 bits of its inverse; of normals as far as 8 bits, JPEG and a
# highlight go
profile() { # name, file, share of the range that heights may differ by
    check "$1" awk -F, -v share="$3" '{ sub(/\r$/, "") }
        NR == FNR { row[NR] = $1 FS $2 FS $3; height[NR] = $4; full[NR] = $0; n = NR; next }
        FNR == 1 && $0 != full[1] { bad = "header " $0 }
        FNR > 1 { if ($1 FS $2 FS $3 != row[FNR] || (NF > 4 && $4 * 0.25 - $6 > 1e-3)) bad = "row " $0
            away = $4 > height[FNR] ? $4 - height[FNR] : height[FNR] - $4
            most = away > most ? away : most; range = height[FNR] > range ? height[FNR] : range; lines = FNR }
        END { print bad, lines, n, most, range; exit bad != "" || lines != n || !(most <= share * range) }' $2.csv page_$2.csv
}
profile 'a profile of depth is that of relume notes' old 0.001
profile 'a profile of normals is that of relume notes' new 0.06
relume relight pot.exr -o pot.png --size 96x96 --light 'dir 0 0 1' || exit 1
check 'elsewhere a profile has the light that is seen' awk -F, -v want="$("$mkimage" read pot.png 42 50)" '{ sub(/\r$/, "") }
    function code(x) { return x <= 0 ? 0 : x < 0.0031308 ? 12.92 * x : 1.055 * x ^ (1 / 2.4) - 0.055 }
    NR == 1 && $0 != "along_px,x,y,red,green,blue" { bad = 1 }
    NR == 2 { split(want, rgb, " "); for (c = 1; c <= 3; c++) { d = code($(3 + c)) - code(rgb[c]); if (d > 0.03 || d < -0.03) bad = 1; sum += rgb[c] } }
    END { print want; exit bad || NR != 6 || !(sum > 0.05) }' page_pot.csv
for file in old new; do
    for n in 1 2 3; do
        # codes are 8 bits and JPEG on the way: on the mean one step of 255
        below "$file: lamp $n near it is that of relume relight" "$("$mkimage" codediff near_$file$n.png lamp_$file$n.png)" 1
    done
done
says 'near lamps come back in the state' '^"exposure=-0.5&light=area,0.3,0.2,0.8,0,0.3,0,0.3,0,0,rgb,6,6,6"'
# a point of 0.5 has a quarter of the value; half an angle of 30 degrees, pi / (4 tan^2 30) = 2.35619
says 'sliders bring a light near, make it soft and take it away, as bright' '^\["sliders","light=point,0,0.3,0.4,rgb,0.25,0.25,0.25","light=area,0,0.3,0.4,[-0-9.,]*,rgb,2.35619,2.35619,2.35619","light=area,0,0.6,0.8,[-0-9.,]*,rgb,2.35619,2.35619,2.35619","light=point,0,0.6,0.8","light=dir,0,0.6,0.8"\]'
says 'lamps that cannot be are left out' '^\["nofall","light=point,1,1,1,rgb,1,2,3,nofall"\]'
says 'a slab without depth has no near lamps, which is said' '^\["slab","This link asks for what cannot be shown \(light\); the rest of it is\."\]'
finish
