#!/bin/sh
# Many objects, a folder of photographs each: one run, a capture for each, one page.
. "$(dirname "$0")/lib.sh"
"$sphere" ball --size 12 --lights 4 --hemisphere --format jpg || exit 1
"$sphere" other --size 16 --lights 5 --hemisphere --format jpg || exit 1
object() { # folder, sphere: photographs with their list
    mkdir -p "$1" && cp "$2"/view00/*.jpg "$1" && sed 's|view00/||' "$2/dirs.lp" >"$1/lights.lp"
}
said() { grep -qF -e "$1" err.txt; }
not() { ! "$@"; }
is() { test "$1" = "$2"; }
cards() { grep -c 'class="object"' "$1/report.html"; }
# fails NAME STATUS TEXT COMMAND...: the run goes on, ends so, and says that
fails() {
    name=$1 want=$2 text=$3
    shift 3
    timeout 60 "$@" >out.txt 2>err.txt
    status=$?
    if [ "$status" -eq "$want" ] && said "$text"; then ok "$name"; else
        not_ok "$name" "status $status, expected $want with '$text'; $(cat err.txt)"
    fi
}
odd='<b>"it'\''s" & 100%#?'
object 'coins/coin 1' ball
object coins/coin2 other
object "coins/$odd" ball

# ---- the same captures as one by one
expect_ok 'three objects' '^relume: out: 3 objects; see report.html there' "$RELUME" capture coins/* -o out
check 'several folders of one object' said 'photographs of one object that lie in several folders are named as coins/'
relume capture coins/coin2 -o single
check 'as one by one' diff -r single out/coin2
check 'a name of blanks, quotes and marks' test -s "out/$odd/capture.json"
check 'a card for each' is "$(cards out)" 3
check 'a link to each report' grep -qF 'href="./coin%201/report.html"' out/report.html
check 'names are escaped' grep -qF '<b class="name"><a href="./%3Cb%3E%22it%27s%22%20%26%20100%25%23%3F/report.html">&lt;b&gt;&quot;it&#39;s&quot; &amp; 100%#?</a></b>' out/report.html
check 'the page holds its pictures' is "$(grep -c 'src="data:image/jpeg;base64,' out/report.html)" 3
check 'the page needs nothing else' not grep -qE '(src|href)="(http|/)|<script' out/report.html
check 'lights are counted' grep -q '<p class="facts">5 lights' out/report.html

# ---- repeated
cp out/report.html before.html
stamp() { stat -c %i "out/coin2/$1"; }
first=$(stamp capture.json)
expect_ok 'again' '^relume: coin2 .3 of 3.: is there already; --force makes it again' "$RELUME" capture coins/* -o out/
check 'nothing is made again' is "$(stamp capture.json)" "$first"
same 'the page is the same' before.html out/report.html
rm -r out/coin2
expect_ok 'one is missing' '^relume: out: 3 objects, 2 of them there already' "$RELUME" capture coins/* -o out
same 'the page is the same again' before.html out/report.html
object coins/coin3 ball
expect_ok 'another day' '^relume: out: 1 object; see' "$RELUME" capture coins/coin3 out/coin2 -o out
check 'a capture is no object' said 'out/coin2: left out: it is a capture already'
check 'the page has earlier ones' is "$(cards out)" 4
check 'under a title' grep -q '<h2>Made earlier' out/report.html

# ---- files in the folders of the objects
expect_ok 'relume files and pictures' '^relume: out: 4 objects, 4 of them there already' "$RELUME" capture coins/* -o out \
    --encode object.exr --relight object.png --normals n.png --light 'dir 0.3 0.3 1'
for name in 'coin 1' coin2 coin3 "$odd"; do
    check "in the folder of $name" test -s "out/$name/object.exr" -a -s "out/$name/object.png" -a -s "out/$name/n.png"
done
relume capture coins/coin2 -o whole --normals whole.png --encode whole.exr --relight relit.png --light 'dir 0.3 0.3 1'
same 'normals as with the capture' whole.png out/coin2/n.png
same 'pictures as with the capture' relit.png out/coin2/object.png
first=$(stamp object.exr)
mkdir cwd cwd/object.exr && (cd cwd && "$RELUME" capture ../coins/coin2 ../coins/coin3 -o ../apart --encode object.exr -q 2>../err.txt)
check 'the working folder does not count' test -s apart/coin2/object.exr
rm out/coin3/object.png
expect_ok 'a picture is missing' - "$RELUME" capture coins/* -o out --encode object.exr --relight object.png
check 'it is made' test -s out/coin3/object.png
check 'the files stay' is "$(stamp object.exr)" "$first"
expect_ok 'force replaces files too' '^relume: out: 4 objects; see' "$RELUME" capture coins/* -o out --force --encode object.exr
check 'with the capture' test ! -e out/coin2/n.png -a -s out/coin2/object.exr
echo mine >out/coin2/note.txt
fails 'files of others stay' 2 'coin2 (3 of 4): failed: out/coin2: holds note.txt, which was not made with it' "$RELUME" capture coins/* -o out --force
check 'the others are made' grep -q '3 made, <span class="bad">1 failed' out/report.html
rm out/coin2/note.txt

# ---- objects that fail
mkdir coins/empty coins/export && cp coins/coin2/lights.lp coins/export
object coins/broken ball && head -c 300 ball/view00/light0003.jpg >coins/broken/light0003.jpg
rm -rf out
fails 'some fail' 1 'out: 3 of 7 objects failed: broken, empty, export; see report.html there' "$RELUME" capture coins/* -o out
check 'the reason' said 'broken (2 of 7): not made: coins/broken/light0003.jpg: '
check 'no photographs' said 'of 7): not made: coins/export: no photographs'
check 'the others are made' is "$(ls out | wc -l)" 5
check 'no folder of one that failed' test ! -e out/broken
check 'the page names them' grep -qF '<b class="name">broken</b> <span class="from">coins/broken</span><br>light0003.jpg' out/report.html
check 'nothing is left behind' is "$(leftovers)" ''
cp ball/view00/light0003.jpg coins/broken
fails 'again, mended' 1 'out: 2 of 7 objects failed: empty, export' "$RELUME" capture coins/* -o out
check 'that one is made' test -s out/broken/capture.json
check 'the others stay' said 'coin3 (5 of 7): is there already'
fails 'as JSON' 1 'failed' "$RELUME" capture coins/* -o out --json -q
cp out.txt objects.json
if [ "$python" ]; then
    check 'JSON of all' "$python" -c 'import json
o = {i["name"]: i for i in json.load(open("objects.json"))["objects"]}
assert len(o) == 7 and o["coin2"]["kept"] and o["coin2"]["lights"] == 5 and o["coin2"]["status"] == "ok"
assert o["empty"]["status"] == "not-found" and "no photographs" in o["empty"]["reason"] and "lights" not in o["empty"]
assert len(o["coin2"]["photographs"]) == 5 and o["coin2"]["photographs"][4]["file"] == "coins/coin2/light0004.jpg"'
fi
rm -r coins/empty coins/export coins/broken

# ---- photographs that have changed since
cp ball/view00/light0001.jpg coins/coin3/light0000.jpg
fails 'another photograph' 1 'coin3 (4 of 4): failed: out/coin3: is there already, made of other photographs: light0000.jpg is gone or has changed; --force' "$RELUME" capture coins/* -o out
object coins/coin3 ball && cp ball/view00/light0000.jpg coins/coin3/light0004.jpg
fails 'one photograph more' 1 'made of 4 photographs; coins/coin3 holds 5 now; --force' "$RELUME" capture coins/* -o out
mv coins/coin3 aside && mkdir coins/coin3
expect_ok 'photographs that were moved away' 'coin3 .4 of 4.: is there already' "$RELUME" capture coins/* -o out
rmdir coins/coin3 && rm aside/light0004.jpg && mv aside coins/coin3

# ---- which folders
object elsewhere/coin2 other
ln -s "$PWD/coins/coin2" linked
expect_ok 'equal names, and a folder twice' 'elsewhere/coin2: another folder has this name; its capture is called coin2-2' \
    "$RELUME" capture coins/coin2 elsewhere/coin2/ linked -o named
check 'once' said 'linked: left out: it is named twice'
check 'both are made' test -s named/coin2/capture.json -a -s named/coin2-2/capture.json
touch coins/notes.txt coins/a.csv
expect_ok 'files beside, and the output in the same folder' 'left out, no folders: a.csv, notes.txt' "$RELUME" capture coins/* -o coins/made
expect_ok 'again, the output being one of the folders' 'coins/made: left out: the captures are made in it' "$RELUME" capture coins/* -o coins/made
rm -r coins/made
mkdir coins/flats && "$mkimage" plane ball/view00/light0000.jpg coins/flats/flat.exr 0.5
expect_ok 'a folder that an option names' 'coins/flats: left out: an option names it' \
    "$RELUME" capture 'coins/coin 1' coins/coin3 coins/flats -o flat --flat coins/flats
rm -r coins/flats
mkdir halves && cp -r coins/coin3 halves/one && mkdir halves/two && mv halves/one/light000[23].jpg halves/two
expect_ok 'one object in two folders' '^relume: joined: 4 lights' "$RELUME" capture halves/*/*.jpg --lights halves/one/lights.lp -o joined
(cd coins/coin3 && "$RELUME" capture . ../coin2 -o ../../dots -q) || not_ok 'capture . ..' ''
check 'the name of .' test -s dots/coin3/capture.json

# ---- lights of all
rm coins/coin3/lights.lp 'coins/coin 1/lights.lp'
sed 's|.*/light[0-9]*.jpg ||' ball/dirs.lp | tail -n +2 >dome.txt
expect_ok 'a list for all' '^relume: dome: 2 objects; see' "$RELUME" capture coins/coin3 'coins/coin 1' --lights dome.txt -o dome
same 'the same lights' dome/coin3/lights.lp 'dome/coin 1/lights.lp'

# ---- refused before anything is done
refused() { # name, status, pattern, arguments
    name=$1 want=$2 pattern=$3
    shift 3
    expect_fail "$name" "$want" "$pattern" no "$RELUME" capture "$@" -q
}
two='coins/coin2 coins/coin3'
refused 'folders and photographs' 2 '2 folders and 1 photograph .coins/coin2/light0000.jpg.; expected folders alone .[*]. in a shell., each' $two coins/notes.txt coins/coin2/light0000.jpg -o no
refused 'a folder that is not there' 1 'coins/coin9: no such file' $two coins/coin9 -o no
refused 'options that exclude each other' 2 'expected one of --near and --distant' $two --near --distant -o no
refused 'a list that is not there' 1 'none.lp: cannot be opened' $two --lights none.lp -o no
refused 'a file in a folder' 2 'sub/x.exr: of many objects each has this file in its own folder; .*as x.exr' $two --normals sub/x.exr -o no
refused 'a name of the capture' 2 'light0001.exr: is a name of the capture itself' $two --albedo light0001.exr -o no
refused 'a light that is none' 2 'ditto' $two --encode a.exr --relight a.png --light ditto -o no
refused 'no folder is left' 1 'no folder of photographs is left' single out/coin2 -o no
refused 'the folder of the photographs' 2 'coins/coin2: holds photographs, and the capture coin2 would take its place' $two -o coins
refused 'one of the folders' 2 'coins/coin3: holds photographs itself' $two -o coins/coin3
check 'nothing is there' not test -e no
expect_fail 'a capture' 2 'single: is a capture, or another folder that relume made' - "$RELUME" capture $two -o single -q
echo >file && expect_fail 'a file' 2 'file: is a file' - "$RELUME" capture $two -o file -q
mkdir page && echo '<html>mine' >page/report.html
expect_fail 'a page of others' 2 "page/report.html: is no page of relume's captures" - "$RELUME" capture $two -o page -q
check 'stays' test "$(ls page)" = report.html
refused 'folders below one that is named alone' 1 'folders below have some: .*; try: relume capture coins/[*]/ -o DIR for an object of each folder, or coins/coin2 alone' coins -o no
finish
