#!/bin/sh
# An exported folder in a browser: a page of our own relights it by WebGL, software only, no network.
. "$(dirname "$0")/lib.sh"
browser=
for b in chromium chromium-browser google-chrome; do
    [ "$browser" ] || browser=$(command -v $b || true)
done
if [ -z "$browser" ]; then
    skip 'exported folders in a browser' 'no chromium; make deps-web installs it'
    finish
    exit
fi
browse() { # page.html, as the browser leaves it, in dom.txt
    HOME=$work/home timeout 120 "$browser" --headless --no-sandbox --disable-gpu-sandbox --use-gl=angle \
        --use-angle=swiftshader --enable-unsafe-swiftshader --user-data-dir="$work/home/profile" \
        --virtual-time-budget=60000 --dump-dom "file://$work/page.html" >dom.txt 2>browser.txt
}
show() { # folder, pictures: what the page says, in dom.txt
    "$TOP/tests/tools/web_page.sh" "$@" >page.html
    browse
    grep -q '^end' dom.txt && return
    not_ok "the page relights $1" "$(grep -E '^(failed|light)' dom.txt; tail -n 3 browser.txt)"
}
compare() { # folder
    "$RELUME" import $1 -o back.exr -q || exit 1
    n=0 folder=$1
    set --
    for light in '0 0 1' '0.6 0.3 0.7' '-0.5 0.7 0.3'; do
        "$RELUME" relight back.exr -o back$n.png --light "dir $light" -q
        "$RELUME" relight dome.exr -o own$n.png --light "dir $light" -q
        set -- "$@" "$light" back$n.png "$light" own$n.png
        n=$((n + 1))
    done
    show $folder "$@" || return
    for l in 0 2 4; do
        # codes and weights are the same; sums are rounded twice in single precision: a code apart
        below "$folder, light $((l / 2)) in the browser is relume relight of the same codes" \
            "$(sed -n "s/^light $l .* max \([0-9]*\) .*/\1/p" dom.txt)" 1
        # the folder is lossy: no light is much worse than what export measured over all of them
        above "$folder, light $((l / 2)) in the browser is the file's own picture" \
            "$(sed -n "s/^light $((l + 1)) .* psnr \([0-9.]*\)/\1/p" dom.txt)" \
            "$(awk -v p="$promised" 'BEGIN { print p - 3 }')"
    done
}
mkdir home
"$sphere" dome --size 64 --lights 40 --hemisphere --shade wrap --format png || exit 1
"$RELUME" encode dome -o dome.exr --basis pca --coefficients 27 -q || exit 1
"$RELUME" export dome.exr -o web --quality 90 2>note.txt || exit 1
promised=$(sed -n 's/.*differs from the original by \([0-9.]*\) dB.*/\1/p' note.txt)
compare web

# ---- the page of the tutorial: it measures its own canvas, since nobody moves the pointer
{
    "$TOP/samples/webpage.sh" web
    echo "<script>const got = new Uint8Array(4), timer = setInterval(() => {
        gl.readPixels(32, 31, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, got);
        if (!got[3]) return;
        clearInterval(timer);
        tell('middle ' + got.join(' '));
    }, 200)</script>"
} >page.html
browse
"$RELUME" import web -o back.exr -q
"$RELUME" relight back.exr -o middle.png --light "dir -0.6 0.5 0.62450" -q
# both sum the same codes in single precision: a code apart
check 'webpage.sh shows relume relight of the same codes' awk -v a="$(sed -n 's/.*middle \([0-9 ]*\)<.*/\1/p' dom.txt)" \
    -v b="$("$mkimage" read middle.png 32 32)" 'BEGIN { n = split(a, p, " "); split(b, q, " ")
        for (c = 1; c <= 3; c++) {
            d = p[c] - 255 * (1.055 * q[c] ^ (1 / 2.4) - 0.055)
            if (d > 1.1 || d < -1.1 || p[c] < 20) bad = 1
        }
        exit bad || n != 4 }'

# ---- DeepZoom: levels and tiles as OpenLIME counts them
"$sphere" dome --size 520 --lights 12 --hemisphere --shade wrap --format png || exit 1
"$RELUME" encode dome -o dome.exr --basis pca --coefficients 12 -q || exit 1
"$RELUME" export dome.exr -o zoom --to deepzoom --quality 90 2>note.txt || exit 1
promised=$(sed -n 's/.*differs from the original by \([0-9.]*\) dB.*/\1/p' note.txt)
compare zoom
above 'the root is a tile, not a speck' "$(sed -n 's/^root 0 \([0-9]*\) of.*/\1/p' dom.txt)" 127
finish
