#!/bin/sh
# The model that relume maps writes: valid glTF, and in a browser (three.js, software only, no network)
# what the library itself shows of the maps.
. "$(dirname "$0")/lib.sh"
modules=$TOP/build/web/node_modules
browser=
for b in chromium chromium-browser google-chrome; do
    [ "$browser" ] || browser=$(command -v $b || true)
done
if [ -z "$browser" ] || ! command -v node >/dev/null || [ ! -d "$modules/three" ] || [ ! -d "$modules/gltf-validator" ]; then
    skip 'models of maps in a browser' 'no chromium, node, three.js or gltf-validator; make deps-web installs them'
    finish
    exit
fi
valid() { # folder
    check "$1/model.gltf is valid glTF" sh -c \
        "node '$TOP/tests/tools/gltf_check.mjs' '$modules' $1/model.gltf | tee said.txt | grep -q '^errors 0 warnings 0 '"
}
"$RELUME" synth teapot --projection planar -o glossy --size 96 --lights 36 --hemisphere --samples 4 -q || exit 1
"$BUILD/tests/tools/maps_relit" glossy maps '0.1 0.2 1' 0.png '0.6 0.3 0.7' 1.png '-0.5 0.7 0.3' 2.png || exit 1
valid maps
"$RELUME" maps glossy -o mesh --mesh 12 --directx --width 80 -q || exit 1
valid mesh
"$sphere" masked --size 24 --lights 12 --hemisphere --mask --format exr
"$RELUME" maps masked -o cut -q || exit 1
valid cut

mkdir home
node "$TOP/tests/tools/gltf_page.mjs" "$modules" maps 96 '0.1 0.2 1' 0.png '0.6 0.3 0.7' 1.png '-0.5 0.7 0.3' 2.png >page.html
HOME=$work/home timeout 120 "$browser" --headless --no-sandbox --allow-file-access-from-files --disable-gpu-sandbox \
    --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --user-data-dir="$work/home/profile" \
    --virtual-time-budget=60000 --dump-dom "file://$work/page.html" >dom.txt 2>browser.txt
grep -q '^end' dom.txt || not_ok 'the page shows the model' "$(grep -E '^(failed|light)' dom.txt; tail -n 3 browser.txt)"
for l in 0 1 2; do
    # normals of 8 bits are 0.3 degrees apart, colours and roughness 1/255: highlights move by a few
    # codes. A normal map that is upside down, or a highlight of another width, is below 35 dB
    above "light $l in three.js is what the library shows, dB" "$(sed -n "s/^light $l .* psnr \([0-9.]*\)/\1/p" dom.txt)" 45
done
finish
