#!/bin/sh
# What a stranger sees first: folders with other things beside the photographs, sentences that say
# how good a picture is and what comes next.
. "$(dirname "$0")/lib.sh"

# ---- a folder with all that lies around: texts, what relume made, masks, other documents
"$sphere" ball --size 48 --lights 9 --hemisphere --shade lambert --format png || exit 1
mkdir photos && mv ball/view00/*.png photos/ 2>/dev/null
cp ball/dirs.lp photos/ 2>/dev/null || cp ball/*.lp photos/
sed -i 's|view00/||' photos/*.lp
"$RELUME" encode photos -o photos/old.exr --basis sh --coefficients 4 2>/dev/null
echo 'all rights' >photos/LICENSE
printf '%%PDF-1.4' >photos/notes.pdf
expect_ok 'what is no photograph is left out, in one line' \
    'photos: left out, no photographs: LICENSE, notes.pdf \(a PDF document\), old.exr \(a relume file\)$' \
    "$RELUME" capture photos -o cap
check 'the lights of its .lp file are used, and said' grep -q 'photos/.*\.lp: light directions are taken from this file' err.txt
check 'all lights are there' test -s cap/light0008.exr -a ! -e cap/light0009.exr
check 'what comes next' grep -qF 'cap: 9 lights; see report.html there; next: relume encode cap -o FILE.exr' err.txt
expect_ok 'the same by its files' 'photos/LICENSE: left out' "$RELUME" capture photos/* -o again
same 'gives the same lights' cap/lights.lp again/lights.lp
cp photos/*.lp photos/second.lp
expect_fail 'two .lp files: none is chosen' 1 'no mirror ball found; give --lights' out sh -c "'$RELUME' capture photos -q -o out"
expect_fail 'a document that calls itself a photograph is refused' 1 'bad.jpg: not a readable image but a PDF document' out \
    sh -c "cp photos/notes.pdf photos/bad.jpg; '$RELUME' capture photos -q --lights photos/second.lp -o out"
mkdir texts && cp photos/LICENSE photos/old.exr texts
expect_fail 'nothing is left' 1 'texts: no photographs; found LICENSE, old.exr \(a relume file\); expected some' out \
    "$RELUME" capture texts -o out

# ---- photographs one folder below, as data sets of several objects have them
mkdir -p set/statue set/coin set/empty && cp photos/light*.png set/statue && cp photos/light000[0-5].png set/coin
cp photos/light0000.png set/mask.png
expect_fail 'photographs in folders below' 1 \
    'set: no photographs; folders below have some: coin \(6\), statue \(9\); try: relume capture set/\*/ -o DIR for an object of each folder, or set/statue alone$' out \
    "$RELUME" capture set -q -o out
awk 'NF == 4 { print $2, $3, $4 }' photos/second.lp >set/light_directions.txt
cp photos/light0001.png set/one.png
mv set/statue "set/a statue"
expect_fail 'and their lights beside them' 1 \
    "set: 1 photograph; folders below have more: a statue \(9\), coin \(6\); try: relume capture set/\*/ --lights set/light_directions.txt -o DIR for an object of each folder, or 'set/a statue' alone\$" out \
    "$RELUME" capture set -q -o out
expect_fail 'a list of lights above is named' 1 'no mirror ball found; give --lights set/light_directions.txt,' out \
    "$RELUME" capture 'set/a statue' -q -o out
rm set/one.png set/mask.png
expect_fail 'other commands name the folder' 1 "set: no photographs; folders below have some: .*; give 'set/a statue'\$" out.exr \
    "$RELUME" hdr set -q -o out.exr

# ---- a list of lights that is no .lp file
mv set/light_directions.txt 'set/a statue/'
expect_ok 'a list of lights beside the photographs is used, and said' \
    'a statue/light_directions.txt: light directions are taken from this file' "$RELUME" capture 'set/a statue' -o named
same 'it is that of the .lp file' cap/lights.lp named/lights.lp
cp "set/a statue/light_directions.txt" "set/a statue/lights.txt"
"$RELUME" capture 'set/a statue' -o out 2>err.txt
check 'of two none is, and said' grep -q 'a statue: left out, no photographs: lights.txt, light_directions.txt$' err.txt
rm "set/a statue/lights.txt" && sed -i 1d "set/a statue/light_directions.txt"
"$RELUME" capture 'set/a statue' -o out 2>err.txt
check 'nor one that does not fit' grep -q 'a statue/light_directions.txt: is not read; as light directions it would have a line x y z for each of the 9 photographs' err.txt
"$RELUME" capture photos -o out 2>err.txt
check 'two .lp files: both are named' grep -q 'photos: left out.* and 2 more$' err.txt

# ---- grids and panoramas
mkdir grid && for i in 0 1 2 3; do cp photos/light000$i.png grid/cam_$i.png; done
for other in depth.png cam_mask.png gt_normal.png; do cp grid/cam_0.png grid/$other; done
cp photos/LICENSE grid
expect_ok 'a grid beside its depth, mask and normals' 'grid: left out, no photographs: LICENSE, cam_mask.png \(mask\), depth.png \(depth\) and 1 more' \
    "$RELUME" lightfield grid -o slab
check 'a slab says what comes next' grep -qF 'slab: a light slab; next: relume encode slab -o FILE.exr' err.txt
mkdir world && cp grid/cam_0.png world/depths.png && cp photos/LICENSE world
expect_ok 'a panorama beside its licence' 'world: left out, no photograph: LICENSE$' "$RELUME" panorama world -o around
check 'a panorama says what comes next' grep -qF 'around: a panorama; next: relume encode around -o FILE.exr' err.txt

# ---- how good it is, in words
expect_ok 'a capture encoded at once says how well' 'k.exr: reproduces your photographs at [0-9.]* dB PSNR \(differences (not|hardly) visible\)' \
    "$RELUME" capture photos --lights photos/second.lp -o known --encode k.exr --skip-bad
expect_ok 'eval judges' - "$RELUME" eval k.exr known
check 'the mean' grep -qE '^PSNR +[0-9.]+ dB \(mean over images\): differences (not|hardly) visible$' out.txt
check 'and the worst light' grep -qE '^worst +[0-9.]+ dB \(light [1-9]\): differences ' out.txt
"$sphere" low --size 24 --lights 9 --hemisphere --shade lambert --format png
lp=$(ls low/*.lp)
sed -i '2s/ [-0-9.e]* [-0-9.e]* [-0-9.e]*$/ 0.999 0 -0.045/' "$lp"
expect_ok 'a lamp a little below the horizon' - "$RELUME" encode "$lp" -o low.exr --basis sh --coefficients 4
expect_ok 'is nothing to warn of when its own capture is judged' - "$RELUME" eval low.exr "$lp"
awk 'NF == 1 { next } $4 > 0.5' known/lights.lp >high && { wc -l <high; cat high; } >known/high.lp
expect_ok 'lamps all above the rest' - "$RELUME" encode known/high.lp -o high.exr
expect_ok 'lights beyond them are one remark' 'high.exr: [1-9] of 9 lights lie outside the directions that were photographed for it, by up to [0-9]+ degrees' \
    "$RELUME" eval high.exr known
check 'and no other' test "$(wc -l <err.txt)" -eq 1

# ---- an output that cannot be made is refused before the work
mkdir taken && echo mine >taken/mine
expect_fail 'a relume file under the name of a folder' 3 'taken: cannot be written; a folder has this name' - \
    timeout 5 "$RELUME" encode photos/second.lp -o taken
for command in 'btf fit corduroy' 'btf tile corduroy' 'synth --btf corduroy' 'synth box'; do # the first three took 40 s
    expect_fail "$command into a folder of others" 2 'taken: already exists; expected a new or empty folder, or --force' - \
        timeout 5 "$RELUME" $command -o taken
done
check 'and it stays' grep -q mine taken/mine
expect_fail 'an error while a folder is made names it' 3 '^relume: full/view00/[a-z0-9]*.exr: writing failed; File too large' full \
    sh -c "ulimit -f 4; exec '$RELUME' synth box -o full --size 64 --lights 4"

# ---- sentences
expect_ok 'options before the command' - "$RELUME" -q --threads 1 --max-memory=1G info k.exr
expect_fail 'an option of a command before it' 2 "--size: options come after the command; expected 'relume COMMAND --size" \
    - "$RELUME" --size 3 info k.exr
expect_fail 'materials are listed' 1 'X: cannot be read; no such file or folder, and no built-in material, which are: .*leather' x.png "$RELUME" btf render X -o x.png
for light in '1 1 1' '1,1,1'; do
    expect_fail "a light without its kind: $light" 2 "its kind is missing; did you mean 'dir 1 1 1'" x.png \
        "$RELUME" relight k.exr -o x.png --light "$light"
done
expect_fail 'a folder that is no web folder' 1 'texts: a folder without info.json, so no web folder' x.exr "$RELUME" import texts -o x.exr
expect_fail 'a capture to import' 1 "this is a capture, for 'relume encode'" x.exr "$RELUME" import cap -o x.exr

# ---- strengths of passes, as the viewer's sliders
relit() { out=$1; shift; "$RELUME" relight k.exr -o "$out" --light 'dir 1 1 1' "$@"; }
relit g1.png --pass diffuse-gain --gain 1
relit g2.png --pass diffuse-gain
relit g2b.png --pass diffuse-gain --gain 2
relit g9.png --pass diffuse-gain --gain 9
same 'the usual gain is 2' g2.png g2b.png
differ 'much gain' g1.png g9.png
differ 'no gain' g2.png g1.png
relit h.png --pass specular
relit h2.png --pass specular --highlight 2 --exponent 9
differ 'another highlight' h.png h2.png
relit u.png --pass unsharp
relit u2.png --pass unsharp --radius 20 --gain 2
differ 'a wider radius' u.png u2.png
relit f.png --pass false-colour --range 0,100
check 'all is dark under a range of 100: dark blue' sh -c "'$mkimage' read f.png 24 24 | awk '{ exit !(\$3 > \$1) }'"
expect_fail 'a gain of nothing' 2 'gain works only with --pass diffuse-gain' x.png "$RELUME" relight k.exr -o x.png --gain 3
expect_fail 'a range upside down' 2 "range: expected two luminances LOW,HIGH, the first one smaller; found '3,1'" x.png \
    "$RELUME" relight k.exr -o x.png --pass false-colour --range 3,1

# ---- other people's files
expect_ok 'an .lptm' - "$RELUME" export k.exr -o k.lptm
expect_ok 'comes back' - "$RELUME" relight k.lptm -o back.png
data=$TOP/../shared/data/exr-openexr-images
if [ -d "$data" ]; then
    expect_ok 'luminance with coarser colour' - "$RELUME" tonemap "$data/StarField.exr" -o x.png
else
    skip 'luminance with coarser colour' 'no ../shared/data'
fi
finish
