#!/bin/sh
# Outputs that cannot be written, broken relume files, wrong options, interruption.
. "$(dirname "$0")/lib.sh"
"$sphere" good --size 24 --lights 10 --half || exit 1
L="--basis sh --coefficients 4"
"$RELUME" encode good -o good.exr $L 2>/dev/null || not_ok encode failed
encode="$RELUME encode good $L -o"
relight="$RELUME relight good.exr -o"

# ---- nowhere to write
for o in nowhere/deep/o.exr good.exr/o.exr /proc/o.exr; do
    expect_fail "encode to $o" 3 "$o: .*(cannot be|no temporary)" "$o" $encode $o
    expect_fail "relight to $o" 3 "$o: cannot be (written|created)" "$o" $relight $o
done
mkdir folder
expect_fail 'encode to a folder' 3 'folder: .*a folder has this name' - $encode folder
expect_fail 'relight to a folder' 3 'folder.exr: .*a folder has this name' - sh -c "mkdir folder.exr; $relight folder.exr"
expect_fail 'export to a folder in no folder' 3 'web/statue: cannot be created; there is no folder web: make it first' web \
    "$RELUME" export good.exr -o web/statue
expect_fail 'relight to hdr, no such folder' 3 'nowhere/o.hdr: ' nowhere/o.hdr $relight nowhere/o.hdr
expect_fail 'relight to tif, no such folder' 3 'nowhere/o.tif: ' nowhere/o.tif $relight nowhere/o.tif
expect_fail 'relight to an unknown kind' 2 '-o: o.xyz: no picture format for this ending' o.xyz $relight o.xyz
expect_fail 'relight to no kind' 2 '-o: o: no picture format for this ending' o $relight o
if [ -w /dev/full ]; then
    expect_fail 'encode to a full device' 3 '/dev/full: writing failed; No space' - $encode /dev/full
    expect_fail 'relight to a full device' 3 '/dev/full: writing failed; No space' - $relight /dev/full
    for e in png jpg tif hdr exr; do
        ln -sf /dev/full full.$e
        expect_fail "relight to a full $e" 3 "full.$e: writing failed; No space" - $relight full.$e
    done
    for command in 'info good.exr --json' 'compare good.exr good.exr --json' 'info good.exr' \
        'query good.exr --eye 0,0,4 --direction 0,0,-1 --json' 'eval good.exr good --json' 'lights -n 5 --json'; do
        expect_fail "'$command' to a full device" 3 'standard output: writing failed' - sh -c "\"$RELUME\" $command >/dev/full"
    done
else
    skip '/dev/full' 'no such device here'
fi
expect_fail 'stdout closed' 3 'standard output: writing failed' - sh -c "\"$RELUME\" info good.exr --json >&-"
expect_ok 'stderr closed' - sh -c "$encode closed.exr 2>&-"
same 'a closed stderr does not write into the file' good.exr closed.exr

# ---- a limit of the file's size (blocks of 512 bytes)
"$sphere" large --size 128 --lights 6 --half
"$RELUME" encode large -o large.exr --basis table 2>/dev/null
for o in l.exr l.png l.jpg l.tif l.hdr; do
    expect_fail "relight to $o over the size limit" 3 "$o: .*(writing failed|cannot be written)" $o \
        sh -c "ulimit -f 2; exec \"$RELUME\" relight large.exr -o $o"
done
expect_fail 'encode over the size limit' 3 'l.exr: .*temporary file failed; File too large' l.exr \
    sh -c "ulimit -f 2; exec \"$RELUME\" encode large -o l.exr"
expect_fail 'encode over the size limit at its end' 3 'l.exr: writing failed; File too large' l.exr \
    sh -c "ulimit -f 1500; exec \"$RELUME\" encode large -o l.exr --basis table --compression none --bits 16"
expect_fail 'synth over the size limit' 3 'File too large|cannot be written' stage \
    sh -c "ulimit -f 2; exec \"$RELUME\" synth box -o stage --size 64 --lights 2 --samples 1"
echo kept >old.png
expect_fail 'a folder for a file' 2 "expected the name of a file, as FILE.exr; found 'new/'" new "$RELUME" encode large -o new/
expect_ok 'a folder with a slash at its end' - "$RELUME" export large.exr -o web/
expect_fail 'a failing relight' 3 'old.png' - sh -c "ulimit -f 2; exec \"$RELUME\" relight large.exr -o old.png"
if [ "$(cat old.png)" = kept ]; then ok 'keeps the file that was there'; else not_ok 'keeps the file that was there' 'it changed'; fi

# ---- open files: however many lights, few descriptors are enough; at 5 there is no room for the output
expect_ok '10 lights with 6 descriptors' - sh -c "ulimit -n 6; exec $encode files.exr"
expect_fail 'too few open files' 3 'good.*too many files are open' few.exr sh -c "ulimit -n 5; exec $encode few.exr"

# ---- synth folders
mkdir full && echo x >full/keep
expect_fail 'synth into a folder with files' 2 'full: already exists.*--force' - "$RELUME" synth box -o full --size 8 --lights 1 --samples 1
if [ -f full/keep ]; then ok 'the files are kept'; else not_ok 'the files are kept' 'they are gone'; fi
expect_fail 'synth --force into a folder that relume did not make' 2 'full: not made by relume' - "$RELUME" synth box -o full --size 8 --lights 1 --samples 1 --force
if [ -f full/keep ]; then ok '--force keeps them too'; else not_ok '--force keeps them too' 'they are gone'; fi
expect_fail 'synth into nowhere' 3 'nowhere/deep: cannot be created' nowhere "$RELUME" synth box -o nowhere/deep --size 8 --lights 1
expect_fail 'unknown scene' 2 "unknown scene 'tea'" none "$RELUME" synth tea -o none

# ---- Ctrl-C
interrupted() { # name, output, command...
    name=$1 output=$2
    shift 2
    for delay in 1.5 0.8 0.4 0.2 0.1 0.05; do  # a fast machine may be done before the signal
        timeout --foreground -s INT $delay "$@" 2>err.txt
        status=$?
        [ "$status" -ne 0 ] && break
        rm -rf "$output"
    done
    if [ "$status" -eq 0 ]; then
        not_ok "$name" "was done before the signal came"
    elif [ "$status" -ne 124 ] && [ "$status" -ne 130 ]; then
        not_ok "$name" "status $status: $(cat err.txt)"
    elif ! grep -q interrupted err.txt || [ "$(errors_of err.txt | wc -l)" -ne 1 ]; then
        not_ok "$name" "said: $(cat err.txt)"
    elif [ -e "$output" ] || [ "$(leftovers)" ]; then
        not_ok "$name" "left: $output $(leftovers)"
    else
        ok "$name"
    fi
}
interrupted 'synth interrupted' slow "$RELUME" synth box -o slow --size 300 --lights 100 --samples 256 --threads 1
"$sphere" long --size 8 --lights 1
awk 'BEGIN { print 3000; for (i = 0; i < 3000; i++) printf "long/view00/light0000.exr %g %g 1\n", cos(i), sin(i) }' >long.lp
interrupted 'encode interrupted' slow.exr "$RELUME" encode long.lp -o slow.exr --basis table

# ---- relume files
info() { expect_fail "$1" 1 "$2" - "$RELUME" info "$3"; }
info 'no such file' 'nothing.exr: no such file' nothing.exr
info 'a folder' 'folder: a folder without capture.json' folder
: >empty.exr; info 'empty file' 'empty.exr: cannot be read as OpenEXR; it is empty' empty.exr
echo text >text.exr; info 'text file' 'text.exr: cannot be read as OpenEXR; it is a file of another kind' text.exr
head -c 900 good.exr >head.exr; info 'a beginning' 'head.exr: cannot be read as OpenEXR; it is damaged or cut off in its header' head.exr
expect_fail 'a folder to check' 1 'folder: cannot be read as OpenEXR; it is empty, or a folder' - "$RELUME" check folder
expect_fail 'an ordinary EXR' 1 'light0000.exr: an OpenEXR file, but not a relume file' - "$RELUME" eval good/view00/light0000.exr good
$relight picture.png; info 'a PNG' 'picture.png: one photograph under one light cannot be relit' picture.png
"$mkimage" bigexr big.exr 1000000 1000000; info 'an EXR that claims 1000000 x 1000000' 'big.exr: ' big.exr
if [ "$python" ]; then
    "$python" - <<'E'
b = open('good.exr', 'rb').read()
k = b'relume.version\0int\0\4\0\0\0'
i = b.index(k) + len(k)
open('new.exr', 'wb').write(b[:i] + b'\x09' + b[i + 1:])
E
    info 'a newer version' 'new.exr: version 9 of the format is newer than this program, which reads up to 4; update relume' new.exr
else
    skip 'a newer version' 'no python3'
fi
n=$(wc -c <good.exr)
for part in 1 5 20 60 95 99; do
    head -c $((n * part / 100)) good.exr >cut.exr
    expect_fail "relume file cut to $part %" 1 'cut.exr: ' cut.png "$RELUME" relight cut.exr -o cut.png
done
head -c $((n - 1)) good.exr >cut.exr
expect_fail 'relume file without its last byte' 1 'cut.exr: ' cut.png "$RELUME" relight cut.exr -o cut.png
expect_fail 'capture of another size' 1 'large: 128 x 128 pixels; expected 24 x 24' - "$RELUME" eval good.exr large --json
expect_fail 'compare of two sizes' 1 'light0000.exr: 128 x 128' - "$RELUME" compare good/view00/light0000.exr large/view00/light0000.exr --json

# ---- options
usage() { expect_fail "$1" 2 "$2" u.exr "$RELUME" $3; }
usage 'unknown command' "did you mean 'relight'" relihgt
usage 'unknown basis' "unknown --basis 'shh'; did you mean 'sh'" 'encode good -o u.exr --basis shh'
usage 'unknown option' "did you mean '--coefficients'" 'encode good -o u.exr --coeficients 9'
usage 'unknown short option' "encode: unknown option '-z'" 'encode good -o u.exr -z'
usage 'count that sh has not' 'the nearest number is 9' 'encode good -o u.exr --basis sh --coefficients 10'
usage 'coefficients 0' 'from 1 to' 'encode good -o u.exr --coefficients 0'
usage 'coefficients 300000' 'from 1 to' 'encode good -o u.exr --coefficients 300000'
usage 'coefficients abc' 'whole number' 'encode good -o u.exr --coefficients abc'
usage 'coefficients 4.5' 'whole number' 'encode good -o u.exr --coefficients 4.5'
usage 'bits 9' "unknown --bits '9'" 'encode good -o u.exr --bits 9'
usage 'domain' "did you mean 'linear'" 'encode good -o u.exr --domain liner'
usage 'compression' "did you mean 'zip'" 'encode good -o u.exr --compression zap'
usage 'transfer' 'gamma:G' 'encode good -o u.exr --transfer gamma:0'
usage 'no output' 'expected -o' 'encode good'
usage 'no input' 'found 0 inputs' 'encode -o u.exr'
usage 'two inputs' 'found 2 inputs' 'encode good good -o u.exr'
usage 'value missing' 'after it; found none' 'encode good -o'
usage 'threads -1' 'from 0 to 256' 'encode good -o u.exr --threads -1'
usage 'threads nan' 'whole number' 'encode good -o u.exr --threads nan'
usage 'two numbers of three' "--eye: expected three numbers x,y,z; found '1,2'" 'relight good.exr -o u.exr --eye 1,2'
usage 'a size of no pixels' "--size: expected WxH, W or xH, at most 65536 a side and 2.30 pixels; found '0x4'" 'relight good.exr -o u.exr --size 0x4'
usage 'a number or a word' "--exposure: expected a number from -100 to 100, or auto; found '101'" 'relight good.exr -o u.exr --exposure 101'
usage 'an empty word of a list' "--coefficients: expected words separated by commas, at most 64; found '4,,9'" 'sweep good --coefficients 4,,9'
usage 'a comma behind a list' "--basis: expected words separated by commas, at most 64; found 'sh,'" 'sweep good --basis sh,'
usage 'a wrong part of a repeated option' "unknown --without 'lid'; did you mean 'lids'" 'glare x.exr -o u.exr --without fibres --without lid'
usage 'bytes' "--max-memory: expected a size like 500M or 4G; found '4Q'" 'info good.exr --max-memory 4Q'
usage 'a flag with a value' "--json: takes no value; found '1'" 'info good.exr --json=1'
expect_ok 'the last of two values counts' - "$RELUME" encode good -o=u.exr $L --bits 16 --bits=8
expect_ok 'eight bits' - "$RELUME" info u.exr
check 'of 8 bits' grep -q '^storage *8 bits' out.txt
rm u.exr

light() { expect_fail "light '$1'" 2 "$2" u.exr "$RELUME" relight good.exr -o u.exr --light "$1"; }
light 'sun 1 2 3' "light 'sun 1 2 3': unknown kind"
light 'dir 0 0 0' 'found zero'
light 'dir 0 0' 'expected .*dir x y z.* found .the end'
light 'dir nan 0 1' 'expected .*dir x y z.* found .nan 0 1'
light 'dir 0 0 1 rgb 1 2' 'expected .*rgb r g b.* found .the end'
light 'dir 0 0 1 red' "found 'red'"
frame() { expect_fail "relight $*" "$status_wanted" 'good.exr: |relight: |--' u.exr "$RELUME" relight good.exr -o u.exr "$@"; }
status_wanted=2
frame --view 7
frame --view -1
frame --size 0x5
frame --size 65536x65536
frame --eye 0,0
frame --eye 0,0,3
frame --pan 5
frame --view 0 --pan 5
query() { expect_fail "query $*" "$status_wanted" 'good.exr: |query: |direction' - "$RELUME" query good.exr --json "$@"; }
query --eye 0,0,3
query --eye 0,0,3 --direction 0,0,0
query --eye 0,0,3 --direction 0,0
status_wanted=1
query --eye 0,0,3 --direction 1,0,0
query --eye 5,0,3 --direction 0,0,-1
finish
