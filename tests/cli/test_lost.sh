#!/bin/sh
# Nothing of the user's is ever lost: no command replaces what it reads or what relume did not make,
# writers of one place do not mix, and stopped runs leave nothing that stays.
. "$(dirname "$0")/lib.sh"
"$sphere" cap --size 16 --lights 9 --half || exit 1
"$sphere" shots --size 24 --lights 9 --format jpg || exit 1
"$RELUME" encode cap -o file.exr --basis sh --coefficients 4 2>/dev/null || not_ok encode failed
synth="$RELUME synth box --size 8 --lights 1 --samples 1 -o"

state() { find . ! -name out.txt ! -name err.txt ! -name only.txt -type f -exec md5sum {} + | sort; find . -type d -o -type l | sort; }
# refused NAME PATTERN COMMAND...: status 2, one sentence, and every file, folder and link is as before
refused() {
    name=$1 pattern=$2
    shift 2
    state >../before.$$
    expect_fail "$name" 2 "$pattern" - "$@"
    state >../after.$$
    same "$name: nothing changed" ../before.$$ ../after.$$
    rm -f ../before.$$ ../after.$$
}
# kept NAME FILE TEXT
kept() { if [ "$(cat "$2" 2>&1)" = "$3" ]; then ok "$1"; else not_ok "$1" "$2: $(cat "$2" 2>&1)"; fi; }

# ---- neighbours of an output
mkdir w.part && echo mine >w.part/keep
expect_ok 'export beside a folder w.part' - "$RELUME" export file.exr --to relight -o w
kept 'w.part is kept' w.part/keep mine
mkdir v.old && echo mine >v.old/keep
$synth v 2>/dev/null
expect_ok 'replacing v beside a folder v.old' - $synth v --force
kept 'v.old is kept' v.old/keep mine
rm -rf w.part v.old

# ---- what relume did not make
echo mine >plain
refused '--force on a file' 'plain: ' $synth plain --force
mkdir album && echo mine >album/keep
refused '--force on a folder of the user' 'album: .*not made by relume' $synth album --force
"$RELUME" synth box --size 8 --lights 1 --samples 1 -o mixed 2>/dev/null && echo mine >mixed/notes.txt
refused '--force on a folder with a file of the user' 'mixed: .*notes.txt' $synth mixed --force
mkdir -p mixed2 && rmdir mixed2 && $synth mixed2 2>/dev/null && mkdir -p mixed2/mine
refused '--force on a folder with a folder of the user' 'mixed2: .*mine' $synth mixed2 --force
expect_ok '--force on a folder of relume' - $synth w --force
expect_ok 'an empty folder' - sh -c "mkdir empty; $synth empty"

# ---- what is read
lp=shots/dirs.lp
refused 'capture onto its photographs' 'shots' "$RELUME" capture shots/view00/*.jpg --lights $lp -o shots --force
refused 'capture onto their folder' 'shots/view00' "$RELUME" capture shots/view00/*.jpg --lights $lp -o shots/view00 --force
refused 'encode onto its .lp' 'cap/dirs.lp: .*(read|relume file)' "$RELUME" encode cap/dirs.lp -o cap/dirs.lp
refused 'encode onto a photograph' 'light0003.exr: .*read' "$RELUME" encode cap/dirs.lp -o cap/view00/light0003.exr
refused 'encode onto the manifest' 'capture.json: .*(read|relume file)' "$RELUME" encode cap -o cap/capture.json
refused 'relight onto its input' 'file.exr: .*read' "$RELUME" relight file.exr -o file.exr
ln -s file.exr link.exr && ln file.exr hard.exr
refused 'relight onto a link to its input' '(link|file).exr: .*read' "$RELUME" relight file.exr -o link.exr
refused 'relight onto a hard link of its input' 'hard.exr: .*read' "$RELUME" relight file.exr -o hard.exr
refused 'relight a link onto its input' 'file.exr: .*read' "$RELUME" relight link.exr -o file.exr
refused 'glare onto its input' 'light0000.exr: .*read' "$RELUME" glare cap/view00/light0000.exr -o cap/view00/light0000.exr
cp cap/view00/light0000.exr sky.exr
refused 'relight onto its environment' 'sky.exr: .*read' "$RELUME" relight file.exr --light 'env sky.exr' -o sky.exr
refused 'compare onto an input' 'sky.exr: .*read' "$RELUME" compare sky.exr cap/view00/light0001.exr -o sky.exr
"$RELUME" export file.exr --to relight -o web 2>/dev/null
plane=$(find web -name 'plane_0*')
refused 'import onto a plane' "$plane: .*(read|relume file)" "$RELUME" import web -o "$plane"
state >../before.$$
"$RELUME" import web -o web 2>/dev/null && not_ok 'import onto its folder' 'it worked'
state >../after.$$
same 'import onto its folder: nothing changed' ../before.$$ ../after.$$
refused 'sweep onto the manifest' 'capture.json: .*read' "$RELUME" sweep cap -o cap/capture --basis sh --coefficients 4
mkdir -p deep && $synth deep/made 2>/dev/null && "$RELUME" encode deep/made -o deep/made.exr 2>/dev/null
refused 'synth onto the folder of its lights' 'deep/made' "$RELUME" synth box --size 8 --lights-from deep/made/capture.json -o deep/made --force
refused 'synth around it' 'deep: ' "$RELUME" synth box --size 8 --lights-from deep/made/capture.json -o deep --force

# ---- films and folders of pictures
lamp=cap/view00/light0000.exr
echo mine >f.mp4.part && mkdir film.part && echo mine >film.part/keep
expect_ok 'a folder of frames beside film.part' - "$RELUME" glare $lamp -o film --frames 1
kept 'film.part is kept' film.part/keep mine
if command -v ffmpeg >/dev/null; then
    expect_ok 'a film beside f.mp4.part' - "$RELUME" glare $lamp -o f.mp4 --frames 1
    kept 'f.mp4.part is kept' f.mp4.part mine
    cp $lamp film.mkv
    refused 'a film onto its input' 'film.mkv: .*read' "$RELUME" glare film.mkv -o film.mkv --frames 1
    rm -f film.mkv
else
    skip 'films' 'no ffmpeg'
fi
refused 'frames into a folder of the user' 'album: already exists' "$RELUME" glare $lamp -o album --frames 1
refused 'merged brackets onto a photograph' 'light0000.exr: .*read' "$RELUME" hdr cap/view00/light000[01].exr -o cap/view00/light0000.exr
if [ -x "$VIEWER" ]; then
    refused 'the viewer onto its file' 'file.exr: .*read' sh -c "exec \"$VIEWER\" file.exr --offscreen file.exr --size 32x32 2>&1 >&2 | sed 's/^relume-view/relume/' >&2; exit 2"
fi

# ---- several writers
# (one that begins when another is done finds its folder there)
for i in 1 2 3 4; do $synth four 2>err$i.txt & done
wait
check 'four synths into one folder: no error' sh -c '! grep -vhE "another run made this folder meanwhile|already exists" err[1-4].txt'
expect_ok 'their folder is whole' 'four.exr: ' "$RELUME" encode four -o four.exr --skip-missing
check 'nothing of them is left' test -z "$(leftovers)"
rm -f err[1-4].txt
"$sphere" half --size 16 --lights 9 --half --hemisphere
sweep="$RELUME sweep half -o two --basis sh,hsh,table --coefficients 4 -q"
for i in 1 2; do $sweep --csv >sweep$i.csv 2>&1 & done
wait
for i in 1 2; do cut -d , -f 1-12,14- sweep$i.csv >rows$i.csv; done  # without the seconds it took
check 'two sweeps into one table' cmp rows1.csv rows2.csv
expect_ok 'their rows are kept, none is broken' - $sweep --csv
check 'those of one of them' test "$(grep -cxFf two.csv out.txt)" -eq 4

# ---- signals: the sign of each, nothing left
for signal in INT TERM HUP; do
    for delay in 1 0.5 0.2 0.1; do
        timeout --foreground -s $signal $delay "$RELUME" synth box -o slow --size 400 --lights 100 --samples 256 --threads 1 2>err.txt
        status=$?
        [ $status -eq 0 ] || break
    done
    if [ $status -ne 124 ] || [ -e slow ] || [ "$(leftovers)" ] || ! grep -q interrupted err.txt; then
        not_ok "SIG$signal" "status $status, $(cat err.txt), left: $(ls -d slow 2>&1) $(leftovers)"
    else
        ok "SIG$signal"
    fi
done
"$RELUME" synth box -o slow --size 400 --lights 100 --samples 256 --threads 1 2>err.txt & pid=$!
sleep 0.3; kill -HUP $pid; wait $pid 2>/dev/null; status=$?
if [ $status -eq 129 ]; then ok 'the shell sees the signal'; else not_ok 'the shell sees the signal' "$status, expected 129"; fi

# ---- killed: the old one or the new one, and no litter after the next run
KILLS=1 expect_ok 'killed at random' - "$TOP/tests/tools/kills.sh"

# ---- calls to the system that fail
if [ -e "$BUILD/tests/tools/faults.so" ]; then
    expect_ok 'writing, flushing and renaming that fail' - "$TOP/tests/tools/faults.sh" 1000 'encode export synth'
else
    skip 'calls that fail' 'tests/tools/faults.so is not built'
fi

# ---- a full disk
mkdir small
if mount -t tmpfs -o size=64k tmpfs small 2>/dev/null; then
    trap 'umount small; cd /; rm -rf "$work"' EXIT
    head -c 60000 /dev/zero >small/filler
    $synth small/v 2>/dev/null
    expect_fail 'encode on a full disk' 3 'small/full.exr: .*No space left' small/full.exr "$RELUME" encode cap -o small/full.exr --basis table --compression none
    expect_fail 'synth on a full disk' 3 'No space left' small/w "$RELUME" synth box --size 64 --lights 2 --samples 1 -o small/w
    check 'what was there is there' test "$(wc -c <small/filler)" -eq 60000
    umount small
    trap 'cd /; rm -rf "$work"' EXIT
else
    skip 'a full disk' 'no right to mount one'
fi

# ---- the longest names
for n in 243 251; do  # and .exr
    long=$(printf "%0${n}d" 0)
    expect_ok "a name of $((n + 4)) bytes" - "$RELUME" relight file.exr -o $long.exr -q
    expect_ok "twice" - "$RELUME" relight file.exr -o $long.exr -q
    expect_ok "a folder of $n bytes" - $synth $long
    expect_ok "twice, --force" - $synth $long --force
done

# ---- folders of before: they have no list
$synth before 2>/dev/null && rm before/.relume
refused '--force on a folder of an older version' 'before: not made by relume, or by a version that kept no list' $synth before --force

# ---- /dev/stdout that somebody appends to
echo first >log
"$RELUME" encode cap -o /dev/stdout -q --basis sh --coefficients 4 >>log 2>err.txt
check 'appending to a file by /dev/stdout' sh -c 'head -n 1 log | grep -qx first && [ "$(wc -c <log)" -gt 100 ]'
finish
