#!/bin/sh
# Files of other kinds open directly, in the tool and in the viewer, as what they are; what cannot be
# opened is refused with what to do instead; nothing is left of what is made on the way.
. "$(dirname "$0")/lib.sh"
mkdir tmp
export TMPDIR="$work/tmp"
light='dir 0.4 0.3 0.8'
"$sphere" dome --size 32 --lights 30 --hemisphere --format png || exit 1
relume encode dome -o pca.exr --basis pca --coefficients 12
relume encode dome -o ptm.exr --basis ptm --coefficients 6
relume encode dome -o hsh.exr --basis hsh --coefficients 9
relume export ptm.exr -o i.ptm
relume export hsh.exr -o i.rti
relume export pca.exr -o web
relume export pca.exr -o zoom --to deepzoom

# ---- a folder of photographs with one list is a capture for every command
mkdir listed && cp dome/view00/*.png listed && sed 's|view00/||' dome/dirs.lp >listed/lights.LP
expect_ok 'encode a folder with one .lp' 'reproduces your photographs' "$RELUME" encode listed -o listed.exr
expect_ok 'eval with such a folder' - "$RELUME" eval listed.exr listed

# ---- RTI of other formats: what import makes of them
for file in i.ptm i.rti web web/info.json zoom; do
    relume import $file -o imported.exr
    relume relight imported.exr -o want.exr --light "$light"
    expect_ok "relight $file" - "$RELUME" relight $file -o got.exr --light "$light"
    same "$file: the picture of the imported file" want.exr got.exr
    "$RELUME" info $file --json >info.json
    check "info $file" grep -q '"source": "RTI of another format"' info.json
    case $file in *.ptm | *.rti) bytes=$(wc -c <$file) ;; *) bytes=null ;; esac
    check "and its own bytes: $bytes" grep -q "\"file_bytes\": $bytes," info.json
done
relume query i.ptm --eye 0,0,4 --direction 0,0,-1 --light "$light" >got.txt
"$RELUME" import i.ptm -o imported.exr -q
relume query imported.exr --eye 0,0,4 --direction 0,0,-1 --light "$light" >want.txt
same 'query i.ptm' want.txt got.txt
expect_ok 'export of a .ptm' 'copied unchanged: nothing is lost' "$RELUME" export i.ptm -o again.ptm
same 'its codes' i.ptm again.ptm

# ---- captures, encoded by the defaults
relume encode dome -o default.exr --shadows no
relume relight default.exr -o want.exr --light "$light"
mkdir photos && cp dome/view00/*.png photos && sed 's|view00/||' dome/dirs.lp >photos/lights.lp
for file in dome dome/capture.json dome/dirs.lp photos; do
    expect_ok "relight $file" - "$RELUME" relight $file -o got.exr --light "$light"
    "$RELUME" compare got.exr want.exr --json >c.json
    above "$file: about the picture of an encoded file" "$(field psnr_db c.json)" 30
done

# ---- pictures of linear light
lit=plain.exr
"$mkimage" gain want.exr $lit 40
relume tonemap $lit -o plain.hdr --exposure 0 # a linear format
for file in $lit plain.hdr; do
    expect_ok "relight $file" - "$RELUME" relight $file -o got.exr --light "$light"
    below "$file is itself under any light" "$("$mkimage" maxdiff got.exr $file)" 0.016 # halves up to 32
done
relume tonemap $lit -o bright.hdr --exposure 20
relume relight bright.hdr -o got.exr # cut at 65504 before
"$mkimage" gain got.exr back.exr 9.5367431640625e-7
below 'a million times brighter is itself too' "$("$mkimage" maxdiff back.exr plain.hdr)" 1e-6
relume info plain.exr >info.txt
check 'info of a picture' grep -q '^source        picture' info.txt
expect_fail 'a picture that is no sphere' 1 "plain.exr: 32 x 32 pixels; a picture of all directions is twice as wide as high" x.png \
    "$RELUME" relight $lit -o x.png --pan 20
"$RELUME" synth attic -o attic --projection spherical --size 24 --lights 1 --hemisphere --samples 1 -q
relume encode attic -o sphere.exr --basis table --bits half
relume relight sphere.exr -o want.exr --pan 30 --tilt 10 --size 40x30 --light 'dir 0 1 0'
relume relight attic/view00/light0000.exr -o got.exr --pan 30 --tilt 10 --size 40x30
below 'a picture of all directions is looked at' "$("$mkimage" maxdiff got.exr want.exr)" 1e-3

# ---- tonemap, of numbers that halves hold
relume relight plain.exr -o halves.exr
lit=halves.exr
relume relight $lit -o want.png --exposure -2 --tone reinhard
expect_ok 'tonemap' - "$RELUME" tonemap $lit -o got.png --exposure -2
same 'tonemap is relight of a picture, reinhard' want.png got.png
relume tonemap $lit -o got.exr --exposure 1 --tone filmic
"$mkimage" gain $lit want.exr 2
same 'linear formats stay linear' want.exr got.exr
relume relight $lit -o want.png --exposure auto --tone reinhard
relume tonemap $lit -o got.png
same 'exposure is automatic' want.png got.png
expect_fail 'an unknown tone' 2 "unknown --tone 'flimic'; did you mean 'filmic'" x.png "$RELUME" tonemap $lit -o x.png --tone flimic
expect_fail 'no picture' 1 'nothing.hdr: no such file' x.png "$RELUME" tonemap nothing.hdr -o x.png

# ---- the viewer
for file in i.ptm web web/info.json dome dome/capture.json photos plain.hdr; do
    if "$VIEWER" $file --offscreen got.png --light "$light" --gl osmesa 2>err.txt && [ -s got.png ]; then
        ok "relume-view $file"
    else
        not_ok "relume-view $file" "$(cat err.txt)"
    fi
    rm -f got.png
done
relume import i.ptm -o imported.exr
for file in i.ptm imported.exr; do "$VIEWER" $file --offscreen $file.png --light "$light" --gl osmesa; done
same 'the viewer shows a .ptm as its import' i.ptm.png imported.exr.png

# ---- refused, with what to do
mkdir empty two && touch two/a.lp two/b.lp
bad() { expect_fail "$1" 1 "$2" x.png "$RELUME" relight "$3" -o x.png; }
bad 'one photograph' "light0000.png: one photograph under one light cannot be relit; expected the .lp file or the folder of all of them, or 'relume capture" dome/view00/light0000.png
bad 'a folder of nothing' "empty: a folder without capture.json, info.json or a single .lp file; .*: relume capture empty -o DIR" empty
bad 'a folder of two lists' 'two: a folder without' two
"$VIEWER" empty --offscreen x.png 2>err.txt
check 'the viewer says so too' grep -q '^relume-view: empty: a folder without capture.json' err.txt
mkdir tiles && touch tiles/info.xml
bad 'tiles of WebRTI' 'tiles: tiles of WebRTI .info.xml., which relume does not read; expected the .ptm or .rti' tiles
echo words >words.txt
bad 'a text' 'words.txt: relume cannot open this; expected a relume file \(.exr\), .ptm' words.txt
cp words.txt false.ptm
echo '{}' >other.json
bad 'a .ptm that is none' 'false.ptm: not a polynomial' false.ptm
bad 'nothing there' 'nothing.ptm: no such file' nothing.ptm
head -c 200 i.ptm >cut.ptm
bad 'a .ptm cut short' 'cut.ptm: ' cut.ptm
bad 'a JSON of something else' 'other.json: relume cannot open this' other.json

if [ "$(ls -A tmp)" ]; then not_ok 'no temporary file is left' "$(ls -A tmp)"; else ok 'no temporary file is left'; fi
TMPDIR=$work/nowhere expect_fail 'no place for a temporary file' 3 'nowhere: no temporary file can be made' x.png \
    "$RELUME" relight i.ptm -o x.png
# a file is written to a descriptor as to a file
"$RELUME" encode dome -o /dev/fd/3 --basis ptm --coefficients 6 -q 3>fd.exr || not_ok 'encode to a descriptor' "$?"
same 'encode to a descriptor' ptm.exr fd.exr
finish
