#!/bin/sh
# Shadows traced through the depth of a capture: when they are, that they are better under lights never seen, and that
# the tool, a part of a picture and the viewer show the same.
. "$(dirname "$0")/lib.sh"
psnr() { "$RELUME" eval "$1" "$2" -q --json | tr ',' '\n' | sed -n 's/.*"psnr_pooled_db": *//p' | head -1; }
alike() { "$RELUME" compare "$1" "$2" | sed -n 's/^psnr_db *//p'; }
has() { "$RELUME" info "$1" --json | grep -q "\"shadows\": $2"; }

"$RELUME" synth box -o box --size 48 --lights 40 --hemisphere --samples 4 -q
"$RELUME" synth box -o unseen --size 48 --lights 8 --hemisphere --pattern random --seed 7 --samples 4 -q
expect_ok 'encode says so' 'box: shadows are traced through the depth: 6 lights left out are shown at [0-9.]* dB PSNR, faded ones at [0-9.]*; --shadows no' \
    "$RELUME" encode box -o traced.exr
"$RELUME" encode box -o faded.exr --shadows no -q
check 'info says so' has traced.exr true
check 'and that there are none' has faded.exr false
# The ball and the box throw shadows on white: 20 against 26 dB at 128 pixels.
above 'unseen lights are shown better' "$(psnr traced.exr unseen)" "$(psnr faded.exr unseen | awk '{ print $1 + 3 }')"
above 'captured ones as well' "$(psnr traced.exr box)" 40
"$RELUME" encode box -o one.exr --threads 1 -q
check 'equal bytes for any threads' cmp traced.exr one.exr
expect_ok 'the file is whole' - "$RELUME" check traced.exr

# ---- the same everywhere
sun="dir 0.3 -0.2 0.8"
for f in traced faded; do "$RELUME" relight $f.exr -o $f.png --light "$sun" -q; done
"$VIEWER" traced.exr --offscreen window.png --size 48x48 --light "$sun" >out.txt 2>err.txt || not_ok 'the viewer shows it' "$(cat err.txt)"
above 'the viewer shows what relight shows' "$(alike traced.png window.png)" 45
below 'which are other shadows' "$(alike traced.png faded.png)" 30

# ---- passes of the graphics card: a light that moves, near ones, environments, several, parts of views, rooms
# a pixel of a smaller map is no sun: its light is spread over cells of a 256th of a turn
awk 'BEGIN { print "P3 256 128 255"; for (i = 0; i < 32768; i++) print i == 11274 ? "255 255 255" : i == 5360 ? "255 200 100" : "0 0 1" }' >suns.ppm
passes() { # name, file, options of both...: the root of the mean square is more than the mean
    name=$1 file=$2
    shift 2
    "$RELUME" relight "$file" -o cpu.exr -q "$@" && "$VIEWER" "$file" --relight passes --offscreen gpu.exr --vram "${vram:-1024}" "$@" 2>err.txt ||
        not_ok "$name" "a program failed; $(cat err.txt)"
    off=$("$RELUME" compare cpu.exr gpu.exr | awk '$1 == "rms" { print $2 * 255 }')
    below "$name: off by $off of 255" "$off" 0.01
}
"$RELUME" relight faded.exr -o cpu.exr --light "$sun" -q
"$VIEWER" traced.exr --relight passes --offscreen gpu.exr --size 48x48 --light "$sun"
below 'by passes shadows move' "$(alike cpu.exr gpu.exr)" 30
{ echo 'size 48 48' && for i in 0 1 2 3; do printf 'light dir 0.%d 0.5 0.7\nframe moved%d.exr\n' $i $i; done; } >film.txt
"$VIEWER" traced.exr --relight passes --script film.txt || not_ok 'a film by passes' 'the viewer failed'
for i in 0 1 2 3; do
    "$RELUME" relight traced.exr -o cpu.exr --light "dir 0.$i 0.5 0.7" -q
    off=$("$RELUME" compare cpu.exr moved$i.exr | awk '$1 == "rms" { print $2 * 255 }')
    below "light $i of a film by passes: off by $off of 255" "$off" 0.01
done
passes 'a lamp that was captured' traced.exr --light "dir $(tr -d ' \n' <box/capture.json | sed 's/.*"directions":\[\[[^]]*\],\[\([^]]*\)\].*/\1/; s/,/ /g')"
passes 'near lamps' traced.exr --light "point 0.3 0.6 1.4" --light "spot 0.3 -0.6 1.4 -0.1 0.3 -1 40" --light "area 0.3 0.6 1.2 0.3 0 0 0 -0.3 -0.1"
env="env suns.ppm 10 rgb 2000 2000 2000"
passes 'suns of an environment and a lamp' traced.exr --light "$env" --light "dir 0.3 0.2 0.8"
"$RELUME" relight faded.exr -o cpu.exr --light "$env" -q
"$VIEWER" traced.exr --relight passes --offscreen gpu.exr --light "$env"
below 'which show other shadows than where these fade' "$(alike cpu.exr gpu.exr)" 30
"$RELUME" encode box -o linear.exr --shadows yes --domain linear --basis table --bits half -q
passes 'linear light' linear.exr --light "$sun" --light "dir -0.5 0.1 0.7 rgb .5 .4 .2"
"$RELUME" encode box -o books.exr --shadows yes --basis pca --codebook 256 -q
passes 'a codebook' books.exr --light "$sun"
"$RELUME" synth teapot -o teapot --views 2x2 --size 96 --lights 8 --samples 1 -q
"$RELUME" encode teapot -o teapot.exr --basis table --bits half --shadows yes -q
passes 'an eye of a slab' teapot.exr --eye 0.1,-0.2,3 --size 60x60 --light "$sun"
vram=1
passes 'parts of its views' teapot.exr --eye 0.1,-0.2,3 --size 150x150 --light "$sun"
vram=
for p in cylindrical spherical; do
    "$RELUME" synth attic -o room --projection $p --size 32 --lights 16 --samples 1 -q
    "$RELUME" encode room -o room.exr --basis table --shadows yes -q
    passes "a room, $p" room.exr --pan 160 --size 60x40 --light "dir 0.2 0.8 0.5"
    passes "a lamp in a room, $p" room.exr --pan 160 --size 60x40 --light "point 0.3 0.5 0.4"
    rm -r room
done

# ---- with loss
"$RELUME" synth box -o less --size 32 --lights 24 --hemisphere --samples 4 -q
"$RELUME" synth box -o dark --size 32 --lights 8 --hemisphere --pattern random --seed 7 --samples 4 -q
"$RELUME" encode less -o fewer.exr --psnr 30 -q
check 'who asks for few bytes gets none unasked' has fewer.exr false
"$RELUME" encode less -o few.exr --psnr 30 --shadows yes -q
check 'but where they are asked for' has few.exr true
expect_ok 'that file is whole' - "$RELUME" check few.exr
expect_ok 'components that are asked for stay, and that they do not reach it is said' 'with 6 coefficients, .*; 30 dB is more than it reaches' \
    "$RELUME" encode less -o six.exr --psnr 30 --coefficients 6
above 'unseen lights are shown better' "$(psnr few.exr dark)" "$(psnr fewer.exr dark | awk '{ print $1 + 2 }')"
expect_ok 'as many bytes as were asked for' - "$RELUME" encode less -o small.exr --bytes-per-pixel 6 --shadows yes
below 'with what shadows take' "$(wc -c <small.exr)" $((6 * 32 * 32 + 1))
rm small.exr
# their words are the last of the file but for its check sums
{ head -c $(($(wc -c <few.exr) - 200)) few.exr && tail -c 200 few.exr | head -c 40 | tr '\000-\377' '\001-\377\000' && tail -c 160 few.exr; } >broken.exr
expect_fail 'damaged' 1 "broken.exr: view0000.shadows; expected tiles of sound AV1 data; --keep-going shows the rest" e.png \
    "$RELUME" relight broken.exr -o e.png --light "$sun"
expect_ok 'one can go on' '^relume: warning: broken.exr: damaged part .view0000.shadows.; shown without it$' \
    "$RELUME" relight broken.exr -o lost.png --light "$sun" --keep-going
check 'that is said once' [ "$(grep -c damaged err.txt)" = 1 ]
rm broken.exr

# ---- where it cannot be
expect_ok 'too little memory' 'box: between the lamps shadows fade; tracing them takes more than --max-memory allows' \
    "$RELUME" encode box -o small.exr --max-memory 300K
mkdir flat && sed 's/"depth": "[^"]*", //' box/capture.json >flat/capture.json && ln -s ../box/view00 flat/view00
expect_fail 'no depth' 1 'flat: shadows cannot be traced; expected depth in every view' e.exr \
    "$RELUME" encode flat -o e.exr --shadows yes --allow-outside
expect_ok 'highlights that are asked for come before shadows that are not' - "$RELUME" encode less -o shiny.exr --highlights yes
check 'and no shadows are traced' has shiny.exr false
"$RELUME" synth box -o few --size 32 --lights 12 --samples 1 -q
expect_fail 'highlights are refused before shadows are traced' 1 'few: highlights cannot move; expected at least 16 lights' e.exr \
    "$RELUME" encode few -o e.exr --highlights yes --shadows auto
expect_fail 'left out' 1 'box: shadows cannot be traced; expected depth in every view' e.exr \
    "$RELUME" encode box -o e.exr --shadows yes --no-depth
expect_fail 'another basis' 1 'box: shadows cannot be traced; expected basis pca, eigen or table' e.exr \
    "$RELUME" encode box -o e.exr --shadows yes --basis sh
"$RELUME" encode box -o plain.exr --basis table -q
check 'a basis that was asked for is as it was' has plain.exr false
"$RELUME" encode box -o asked.exr --basis table --shadows yes -q
check 'unless shadows are asked for' has asked.exr true
finish
