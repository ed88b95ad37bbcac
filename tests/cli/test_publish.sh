#!/bin/sh
# Publishing: what an independent reader sees in a site, what lies in it, what visitors read, what is refused.
. "$(dirname "$0")/lib.sh"
site_relit="$BUILD/tests/tools/site_relit"
publish() { "$RELUME" publish "$@" 2>err.txt || not_ok "publish $*" "$(cat err.txt)"; }

"$sphere" planar --size 130 --lights 24 --hemisphere --format png || exit 1
"$sphere" slab --size 32 --lights 12 --hemisphere --views 2 || exit 1
"$sphere" wrap --size 32 --lights 16 --shade wrap --format png --mask || exit 1
fresh wrap round
sed 's/"planar"/"cylindrical"/; /"window"/d' wrap/capture.json >round/capture.json
plain="--shadows no --highlights no"
relume encode planar -o planar.exr $plain
relume encode slab -o slab.exr $plain
relume encode wrap -o wrap.exr --basis sh --coefficients 9 $plain
relume encode round -o round.exr $plain
# mostly dark, linear: 2.2 to 4.1 in plain codes of linear light
"$RELUME" synth attic -o room --projection spherical --size 64 --lights 12 --samples 2 -q || exit 1
relume encode room -o room.exr --basis pca --coefficients 9 $plain

# ---- what it shows: the mean difference, in 255ths, of a reader that knows only the site
publish planar.exr slab.exr wrap.exr round.exr room.exr -o site --title Objects --url https://museum.example/a/
for file in planar:0 slab:3 wrap:0 round:0 room:0; do
    name=${file%:*} view=${file#*:}
    for light in 0,0,1 0.6,0.3,0.5 -0.7,0.2,0.3; do
        relume relight "$name.exr" -o lit.exr --view "$view" --light "dir $(echo "$light" | tr , ' ')"
        # the issue's bound; here 0.1 to 0.9
        below "$name under $light" "$("$site_relit" "site/$name" "$view" "$light" lit.exr | cut -d ' ' -f 1)" 1
    done
done
relume relight planar.exr -o lit.exr --size 65 --light 'dir 0.6 0.3 0.5'
# means of coefficients are not quite means of light; here 0.7
below 'a reduced level' "$("$site_relit" site/planar 0 0.6,0.3,0.5 lit.exr 1 | cut -d ' ' -f 1)" 1.5

check 'planes of linear light have a guide' grep -q '"knee": 0.03' site/room/scene.json
check 'which older pages do not know' grep -q '"version": 2' site/room/scene.json
check 'others are as they were' grep -q '"version": 1' site/planar/scene.json

# ---- what lies in it
for page in site/*.html; do
    missing=$(grep -oE '(src|href|poster)="[^"]*"' "$page" | sed 's/.*="//; s/"$//' | grep -v ':' | while read -r to; do
        [ -f "site/$to" ] || echo "$to"
    done)
    if [ "$missing" ]; then not_ok "links of $page" "there is no $missing"; else ok "links of $page"; fi
done
copies=$(find site -name '*.bin' -o -name scene.json -o -name '*.png' | while read -r file; do
    grep -q "^relume.put(\"${file#site/}\", " "$file.js" || echo "$file.js is called otherwise"
    sed 's/.*", "//; s/");$//' "$file.js" | base64 -d | cmp -s - "$file" || echo "$file.js differs"
done)
if [ "$copies" ]; then not_ok 'script copies hold the same bytes' "$copies"; else ok 'script copies hold the same bytes'; fi
check 'depth of a slab' test -s site/slab/v3/depth.png
check 'a mask' test -s site/wrap/v0/mask.png
"$RELUME" publish slab.exr -o web --for web -q && "$RELUME" publish slab.exr -o disk --for disk -q
check '--for web has no script copies' [ -z "$(find web/slab -name '*.js')" ]
check '--for disk has script copies alone' [ -z "$(find disk/slab -name '*.bin' -o -name scene.json)" ]

# planes as AVIF, beside JPEG and alone
publish wrap.exr -o avif --layers avif && publish wrap.exr -o two --layers both
check 'AVIF in a tile' grep -q ftypavif two/wrap/v0/0_0_0.avif.bin
check 'its JPEG is as without' cmp two/wrap/v0/0_0_0.bin site/wrap/v0/0_0_0.bin
check 'AVIF alone' [ -s avif/wrap/v0/0_0_0.avif.bin -a ! -e avif/wrap/v0/0_0_0.bin ]
check 'which older pages refuse' grep -q '"version": 2' avif/wrap/scene.json
check 'both they show' grep -q '"version": 1' two/wrap/scene.json
expect_fail 'layers of another kind' 2 "'--layers'|--layers.*webp" bad "$RELUME" publish wrap.exr -o bad --layers webp

# tiles of the image service: all that info.json promises
width=$(field width site/planar/iiif/info.json) height=$(field height site/planar/iiif/info.json)
lost=$(sed -n 's/.*"scaleFactors": \[\(.*\)\]}.*/\1/p' site/planar/iiif/info.json | tr -d ' ' | tr , '\n' | awk -v w="$width" -v h="$height" '
    function least(a, b) { return a < b ? a : b }
    { for (y = 0; y < h; y += 512 * $1) for (x = 0; x < w; x += 512 * $1) {
        a = least(512 * $1, w - x); b = least(512 * $1, h - y)
        printf "%d,%d,%d,%d/%d,%d\n", x, y, a, b, int((a + $1 - 1) / $1), int((b + $1 - 1) / $1) } }' | while read -r tile; do
    [ -s "site/planar/iiif/$tile/0/default.jpg" ] || echo "$tile"
done)
check 'tiles of the image service' [ "$width$lost" = 130 ]
check 'addresses for IIIF' grep -q '"id": "https://museum.example/a/planar/iiif", "type": "ImageService3"' site/planar/manifest.json
if [ "$python" ]; then
    check 'the manifest and its canvas' "$python" - <<'E'
import json
m = json.load(open('site/planar/manifest.json'))
assert m['@context'] == 'http://iiif.io/api/presentation/3/context.json' and m['type'] == 'Manifest'
canvas = m['items'][0]
painting = canvas['items'][0]['items'][0]
assert painting['motivation'] == 'painting' and painting['target'] == canvas['id']
assert (canvas['width'], canvas['height']) == (painting['body']['width'], painting['body']['height']) == (130, 130)
ids = [m['id'], canvas['id'], painting['id'], painting['body']['id'], m['seeAlso'][0]['id'], m['homepage'][0]['id']]
assert len(set(ids)) == 6 and all(i.startswith('https://museum.example/a/planar') for i in ids)
for f in 'planar', 'slab', 'wrap', 'round':
    json.load(open('site/%s/scene.json' % f))
E
else
    skip 'the manifest and its canvas' 'no python3'
fi

# ---- what visitors read: shown, not obeyed
hostile='</title><script>alert("1")</script>&amp; '"'"'"'
publish wrap.exr -o hostile --title "$hostile" --maker "$hostile" --licence 'https://a/"onclick="alert(1)' --description "$hostile"
check 'no script of a title' [ -z "$(grep -rl '<script>alert' hostile; grep -l '"onclick=' hostile/*.html)" ]
check 'a title as it is' grep -q '<h1>&lt;/title&gt;&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt;&amp;amp; &#39;&quot;</h1>' hostile/wrap.html
mkdir -p a b
for name in 'a/Co in.exr' 'b/co-in.exr' index.exr open.exr '<script>.exr' 'é.exr'; do cp round.exr "$name"; done
echo '{"maker": "A museum", "files": {"index": {"title": "Second", "object": "7"}, "nobody": {}}}' >museum.json
publish 'a/Co in.exr' b/co-in.exr index.exr open.exr '<script>.exr' 'é.exr' -o names --metadata museum.json
check 'names of pages' [ "$(cd names && LC_ALL=C ls -d -- *.html | tr '\n' ' ')" = 'co-in-2.html co-in.html index-2.html index.html object.html open-2.html open.html script.html ' ]
check 'metadata of a file' grep -q '<h1>Second</h1>' names/index-2.html
check 'metadata of all' grep -q '<dd>A museum</dd>' names/script.html
check 'metadata of a file that is not there' grep -q 'museum.json: "files" has "nobody", which is none of the files' err.txt
bad_metadata() { # text, pattern
    echo "$1" >bad.json
    expect_fail "metadata $1" 1 "bad.json.*$2" bad "$RELUME" publish round.exr -o bad --metadata bad.json
}
bad_metadata '[1]' 'an object'
bad_metadata '{"title": 5}' 'expected a text'
bad_metadata '{"titel": "a"}' 'did you mean .title'
bad_metadata '{"files": []}' 'with a member for each file'
bad_metadata '{' 'JSON'

# ---- whole or not at all
"$RELUME" publish wrap.exr slab.exr -o one --threads 1 -q && "$RELUME" publish wrap.exr slab.exr -o three --threads 3 -q
check 'equal files for any threads' diff -r one three
mkdir mine && echo x >mine/keep
expect_fail 'a folder with files' 2 'mine: already exists.*--force' - "$RELUME" publish round.exr -o mine
expect_fail 'a folder that relume did not make' 2 'mine: not made by relume' - "$RELUME" publish round.exr -o mine --force
check 'it is kept' [ "$(cat mine/keep)" = x ]
expect_ok 'a site made again' - "$RELUME" publish round.exr -o one --force
check 'nothing of the old one is left' [ ! -e one/slab ]
expect_fail 'a file that is not there' 1 'nothing.exr: ' site2 "$RELUME" publish round.exr nothing.exr -o site2
head -c 3000 round.exr >cut.exr
expect_fail 'a file that is cut off' 1 'cut.exr: ' site2 "$RELUME" publish round.exr cut.exr -o site2
: >empty.exr
expect_fail 'an empty file' 1 'empty.exr: ' site2 "$RELUME" publish empty.exr -o site2
expect_fail 'a PSNR that cannot be reached' 1 'planar.exr: 99 dB cannot be reached' site2 "$RELUME" publish planar.exr -o site2 --psnr 99
expect_fail 'a size that is too small' 1 'planar.exr: 0.001 bytes a pixel is too small' site2 "$RELUME" publish planar.exr -o site2 --bytes-per-pixel 0.001
expect_fail 'two wishes' 2 'expected one of --quality' site2 "$RELUME" publish planar.exr -o site2 --psnr 40 --quality 90
expect_fail 'an address of another kind' 2 "address 'javascript:1'; expected one that begins with https://" site2 "$RELUME" publish round.exr -o site2 --url javascript:1
expect_fail 'a full disk' 3 'writing failed|cannot be written|temporary' site2 sh -c "ulimit -f 20; exec \"$RELUME\" publish planar.exr -o site2"
timeout --foreground -s INT 0.3 "$RELUME" publish planar.exr planar.exr -o stopped >out.txt 2>err.txt
check 'nothing is left when it is stopped' [ $? -ne 0 -a ! -e stopped -a -z "$(leftovers)" ]
finish
