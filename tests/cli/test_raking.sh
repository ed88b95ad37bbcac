#!/bin/sh
# Raking light: the lowest captured light of a side that shows relief, in the tool, the viewer and pages.
#
# Compares: raking.js with relief.c.
. "$(dirname "$0")/lib.sh"
. "$TOP/tests/cli/page.sh"

# ---- the page's choice beside the library's
if [ "$node" ]; then
    for file in raking lights; do sed "s/\.js'/.mjs'/" "$TOP/web/$file.js" >$file.mjs; done
    cat >cases.mjs <<'END'
import { readFileSync } from 'node:fs';
import { lowestOf } from './raking.mjs';
let same = 0;
const lines = readFileSync(0, 'utf8').trim().split('\n');
for (const line of lines) {
    const { directions, side, first, next } = JSON.parse(line), found = lowestOf(directions, side);
    same += found === first && lowestOf(directions, side, found) === next;
}
console.log(same, lines.length);
END
    "$BUILD/tests/tools/relief_cases" | node cases.mjs >same.txt 2>&1
    check 'pages take the lights that the library takes' grep -qx '400 400' same.txt
else
    skip 'the raking light of pages' 'no node; make deps-web installs it'
fi

# ---- the tool
"$sphere" dome --size 48 --lights 60 --hemisphere --shade lambert --mask --format exr || exit 1
relume encode dome -o dome.exr --basis table --interpolant delaunay || exit 1
relume relight dome.exr --every-light -o every --format exr || exit 1
lamp() { sed -n 's/.*captured light \([0-9]*\),.*/\1/p' err.txt; }
for side in left right top bottom; do
    expect_ok "raking light from the $side" "dome.exr: raking light is captured light [0-9]+, from the (upper |lower )?$side( left| right)?, [0-9]+ degrees above the picture" \
        "$RELUME" relight dome.exr -o $side.exr --light "raking $side"
    check "... is that light" cmp $side.exr "every/light$(printf %04d "$(lamp)").exr"
done
"$RELUME" relight dome.exr -o vector.exr --light 'raking -2 0' 2>err.txt
check 'a side as a vector' cmp left.exr vector.exr
relume relight dome.exr -o twice.exr --light 'raking left rgb 2 2 2' --save-rig rig.json
check 'a colour' [ "$("$mkimage" read twice.exr 20 20 | awk '{ printf "%.4f", $1 }')" = "$("$mkimage" read left.exr 20 20 | awk '{ printf "%.4f", 2 * $1 }')" ]
check 'a rig keeps the direction' grep -q '"light": *"dir -' rig.json
relume relight dome.exr -o rig.exr --rig rig.json
check '... which shows the same' cmp twice.exr rig.exr
relume query dome.exr --eye 0,0,4 --direction 0,0,-1 --light 'raking left' >asked.txt
relume query dome.exr --eye 0,0,4 --direction 0,0,-1 --rig rig.json >kept.txt
check 'query knows it' awk 'NR == FNR { v = $1; next } { exit !($1 > 0 && (d = $1 - 2 * v) * d < 1e-8) }' asked.txt kept.txt
expect_fail 'an unknown side' 2 "light 'raking up': expected .raking \[left \| upper left" out.png "$RELUME" relight dome.exr -o out.png --light 'raking up'
expect_fail 'a side and a word' 2 "light 'raking left now': expected .raking .*, found 'now'" out.png "$RELUME" relight dome.exr -o out.png --light 'raking left now'
expect_fail 'half a vector' 2 "light 'raking 1': expected .raking" out.png "$RELUME" relight dome.exr -o out.png --light 'raking 1'
echo '{ "format": "relume-rig", "version": 1, "lights": [ { "light": "raking" } ] }' >words.json
expect_fail 'a rig that does not know the file' 1 "raking light needs the captured lights of a file" out.png "$RELUME" relight dome.exr -o out.png --rig words.json
relume synth attic -o room --projection spherical --size 16 --lights 9 --samples 1 && relume encode room -o room.exr --basis table || exit 1
expect_fail 'a panorama' 1 'room.exr: raking light needs a picture of a surface' out.png "$RELUME" relight room.exr -o out.png --light raking

# ---- the viewer: from the side of the light
relume relight dome.exr -o default.exr --light raking --save-rig default.json
rakes() { # rig to write, script
    printf "size 48 48\n$2\nkey w\n" >keys.txt
    "$VIEWER" dome.exr --script keys.txt 2>err.txt || not_ok 'the viewer runs' "$(cat err.txt)"
    mv dome-0001.json $1
}
rakes front.json 'key 1'
rakes again.json 'light dir -1 0 0.2\nkey 1\nkey 1'
rakes two.json 'light dir -1 0 0.2\nkey 1\nkey 2'
direction() { sed -n 's/.*"light": *"dir \([^"]*\)".*/\1/p' "$1"; }
same_direction() { # file, file: first lights, to 5 digits
    [ "$(direction "$1" | awk 'NR == 1 { printf "%.5f %.5f %.5f", $1, $2, $3 }')" = "$(direction "$2" | awk 'NR == 1 { printf "%.5f %.5f %.5f", $1, $2, $3 }')" ]
}
check 'light from the front rakes from the upper left' same_direction default.json front.json
check 'from the left, and again' same_direction rig.json again.json
check 'a second light beside it' [ "$(direction two.json | wc -l)" -eq 2 ]
check '... to its right' awk '{ a[NR] = atan2($2, $1) } END { d = (a[1] - a[2]) * 57.2958; d += d < 0 ? 360 : 0; exit !(d > 25 && d < 155) }' <<END
$(direction two.json)
END

# ---- pages
relume publish dome.exr -o site || exit 1
relief=$(tr -d ' \n' <site/dome/scene.json | sed -n 's/.*"relief":\[\([0-9,]*\)\].*/\1/p')
low=$(lamp)
"$RELUME" relight dome.exr -o left.exr --light 'raking left' 2>err.txt
low=$(lamp)
check 'scene.json lists the lights that show relief' sh -c "echo ,$relief, | grep -q ,$low,"
check '... and no others' [ "$(echo "$relief" | tr , '\n' | wc -l)" -lt 55 ]
if ! [ "$node" ] || ! [ "$browser" ]; then
    skip 'raking light in a browser' 'no chromium and node; make deps-web installs them'
    finish
    exit
fi
cp -r site old
sed -i '/"relief"/d' old/dome/scene.json
{ printf 'relume.put("dome/scene.json", "'; base64 -w0 old/dome/scene.json; printf '");\n'; } >old/dome/scene.json.js
{
    echo 'size 96 96'
    show site/dome.html
    echo 'state light=dir,-1,0,0.2'
    echo 'key 1 1'
} >orders.txt
ask "'raking ' + window.relume.getState()"
echo 'key 2' >>orders.txt
ask "'sides ' + window.relume.getState()"
show old/dome.html >>orders.txt
echo 'key 1' >>orders.txt
ask "'fixed ' + window.relume.getState()"
browse
page_direction() { sed -n "s/.*$1 light=dir,\([-0-9.e,]*\).*/\1/p" said.txt | awk -F , '{ printf "%.5f %.5f %.5f", $1, $2, $3 }'; }
check 'the page takes the light that the tool takes' [ "$(page_direction raking)" = "$(direction rig.json | awk '{ printf "%.5f %.5f %.5f", $1, $2, $3 }')" ]
check 'two sides' [ "$(grep -o 'sides .*' said.txt | grep -o 'light=dir' | wc -l)" -eq 2 ]
check '... as in the viewer' [ "$(sed -n 's/.*sides .*light=dir,\([-0-9.e,]*\).*/\1/p' said.txt | awk -F , '{ printf "%.4f %.4f", $1, $2 }')" = "$(direction two.json | awk 'NR == 2 { printf "%.4f %.4f", $1, $2 }')" ]
check 'a site of before keeps its height' [ "$(page_direction fixed)" = '-0.97815 0.00000 0.20791' ]
finish
