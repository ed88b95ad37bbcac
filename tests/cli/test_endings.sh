#!/bin/sh
# The ending of an output's name decides its format, in every command, before any work is done: what
# it cannot mean is refused with a sentence, and nothing else is written under it.
. "$(dirname "$0")/lib.sh"
"$sphere" dome --size 16 --lights 12 --hemisphere || exit 1
"$RELUME" encode dome -o dome.exr --basis hsh --coefficients 9 -q || exit 1
lit=dome/view00/light0000.exr
magic() { od -An -tx1 -N4 "$1" | tr -d ' \n'; }
holds() { # name, file, first bytes
    if [ "$(magic "$2")" = "$3" ]; then ok "$1"; else not_ok "$1" "$2 begins with $(magic "$2"), expected $3"; fi
}

# ---- pictures
for pair in exr:762f3101 EXR:762f3101 png:89504e47 jpg:ffd8ffe0 JPEG:ffd8ffe0 hdr:233f5241 rgbe:233f5241 \
    tif:49492a00 bmp:424d3603 ppm:50360a31 pfm:50460a31; do
    expect_ok "a picture .${pair%:*}" - "$RELUME" relight dome.exr -o p.${pair%:*}
    holds "is one" p.${pair%:*} ${pair#*:}
done
"$RELUME" compare p.rgbe p.exr --json >c.json
above 'and .rgbe holds light, not display codes' "$(field psnr_db c.json)" 40 # 8 bits of mantissa

# ---- what writes pictures writes no other ending; missing inputs show that nothing is done before
for ending in foo pgm gif psd fits exr.bak; do
    expect_fail "relight to .$ending" 2 "-o: o.$ending: no picture format for this ending; expected .exr" o.$ending \
        "$RELUME" relight missing.exr -o o.$ending
done
no() { # name, option, command...: refused for its ending before anything is read
    name=$1 option=$2
    shift 2
    expect_fail "$name" 2 "$option: o.foo: no picture format for this ending" o.foo "$RELUME" "$@"
}
no 'glare' -o glare missing.exr -o o.foo
no "an eye's pattern" --psf glare --psf o.foo
no 'compare' -o compare missing.exr missing.exr -o o.foo
no 'btf render' -o btf render missing -o o.foo
no 'btf render of objects' -o btf render missing.json -o o.foo
no 'an exposure merged' -o hdr missing.png -o o.foo
no 'albedo' --albedo capture missing -o cap --albedo o.foo
no 'a relit picture' --relight capture missing -o cap --encode c.exr --relight o.foo
expect_fail 'numbered pictures' 2 'o%04d.foo: no picture format' - "$RELUME" glare missing.exr -o o%04d.foo --frames 2
for option in --normals --height; do
    expect_fail "$option as JPEG" 2 "$option: n.jpg: " n.jpg \
        "$RELUME" capture missing -o cap $option n.jpg
done
viewer_refuses() {
    "$VIEWER" missing.exr --offscreen o.foo 2>err.txt
    [ $? -eq 2 ] && grep -q -- '--offscreen: o.foo: no picture format for this ending' err.txt
}
check 'the viewer' viewer_refuses

# ---- relume files are EXR
for ending in jpg png tif ptm; do
    expect_fail "encode to .$ending" 2 "-o: o.$ending: a relume file is an OpenEXR file; expected a name that ends in .exr" \
        o.$ending "$RELUME" encode missing -o o.$ending
    expect_fail "import to .$ending" 2 "-o: o.$ending: a relume file is" o.$ending "$RELUME" import missing -o o.$ending
    expect_fail "capture --encode to .$ending" 2 "--encode: o.$ending: a relume file is" o.$ending \
        "$RELUME" capture missing -o cap --encode o.$ending
done

# ---- rigs are JSON, and two outputs are two files
expect_fail 'a rig over a list of lights' 2 'dome/dirs.lp: a rig is a JSON file; expected a name that ends in .json' - \
    "$RELUME" relight missing.exr -o o.png --save-rig dome/dirs.lp
expect_fail 'two outputs of one name' 2 '^relume: --encode and --normals: both are ./o.exr, and one would be lost' o.exr \
    "$RELUME" capture missing -o cap --encode o.exr --normals ./o.exr
cp dome.exr old.exr && ln old.exr also.exr
expect_fail 'of one file' 2 'both are also.exr, and one would be lost' - "$RELUME" capture missing -o cap --albedo old.exr --encode also.exr
same 'which stays' dome.exr old.exr
expect_fail 'a missing photograph is reached by others' 1 'missing: no such file' - "$RELUME" capture missing -o cap --encode o.exr --normals p.exr

# ---- export: the ending says what is written
export_as() { # name, first bytes, export's words
    file=$1 want=$2
    shift 2
    expect_ok "export $file $*" - "$RELUME" export dome.exr -o $file "$@"
    holds 'is what its name says' $file $want
    rm -rf $file
}
export_as i.ptm 50544d5f # PTM_
export_as i.PTM 50544d5f
export_as i.lptm 50544d5f
export_as i.ptm 50544d5f --to lptm
export_as i.rti 23485348 # #HSH
"$RELUME" export dome.exr -o lptm.lptm -q
check '.lptm is one of luminance' grep -q PTM_FORMAT_LRGB lptm.lptm
expect_ok 'any other name is a folder' - "$RELUME" export dome.exr -o web.v2
check 'with its planes' test -s web.v2/info.json
against() { # out, --to, pattern
    expect_fail "export -o $1 --to $2" 2 "$3" "$1" "$RELUME" export missing.exr -o $1 --to $2
}
against i.ptm rti '-o: i.ptm: --to rti writes an .rti file; expected another name, or --to ptm'
against i.rti ptm '--to ptm writes a .ptm file; expected another name, or --to rti'
against i.lptm ptm '--to ptm writes a .ptm file; expected another name, or --to lptm'
against i.ptm relight '--to relight writes a folder; expected another name, or --to ptm'
against i.rti deepzoom '--to deepzoom writes a folder; expected another name, or --to rti'
for ending in jpg exr png; do
    expect_fail "export to .$ending" 2 "-o: i.$ending: export writes no pictures" i.$ending "$RELUME" export missing.exr -o i.$ending
done
for ending in hsh dzi json zip; do
    expect_fail "export to .$ending" 2 "-o: i.$ending: export cannot write this ending" i.$ending "$RELUME" export missing.exr -o i.$ending
done
finish
