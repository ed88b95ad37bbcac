#!/bin/sh
# relume notes: notes beside a file, measured, handed to other programs, refused when they are bad.
. "$(dirname "$0")/lib.sh"
"$sphere" dome --size 48 --lights 24 --hemisphere --shade wrap --format png || exit 1
"$RELUME" encode dome -o dome.exr -q || exit 1
export RELUME
printf '#!/bin/sh\nexec "$RELUME" notes dome.exr "$@"\n' >notes && chmod +x notes
expect_ok 'a first note' - ./notes --add 'point 10,20' --text 'a "spot", <here>' --state 'light=dir,0,0,1' --creator Ann
expect_ok 'lines, a polygon and a view' - ./notes --add 'line 6,24 42,24' --add 'line 0,0 10,0 10,10' \
    --add 'polygon 0,0 10,0 10,10 0,10' --add view --text '=1+1'
expect_ok 'a ruler sets the scale' - ./notes --ruler n2 --length 18
check 'the list is in millimetres' grep -q '^n2 *line *18 mm ' out.txt
check 'angles and areas too' sh -c "grep -q '^n3 .* 10 mm 90 degrees' out.txt && grep -q '^n4 .* around 25 square mm' out.txt"
cp dome.notes.json kept.json
expect_ok 'a table' - ./notes --to csv -o notes.csv
check 'cells are quoted, formulas disarmed' sh -c "grep -q '^\"n1\",point,\"10 20\",,,,,,\"a \"\"spot\"\", <here>\",\"light=dir,0,0,1\",\"Ann\"' notes.csv && grep -q \"\\\"'=1+1\\\"\" notes.csv"
expect_ok 'an overlay' - ./notes --to svg -o notes.svg
check 'its text is escaped' grep -q 'a &#34;spot&#34;, &#60;here&#62;</text>' notes.svg
if [ "$python" ]; then
    check 'it is XML, the list and the page are JSON' "$python" -c "
import json, xml.dom.minidom
xml.dom.minidom.parse('notes.svg')
assert [n['type'] for n in json.load(open('dome.notes.json'))['items']] == 5 * ['Annotation']"
else
    skip 'XML and JSON' 'no python3'
fi
same 'looking changes nothing' dome.notes.json kept.json
expect_ok 'a page for IIIF' - ./notes --to iiif -o page.json --canvas https://example.org/canvas
expect_ok 'comes back without new notes' '0 new notes' ./notes --import page.json
same 'and nothing is lost' dome.notes.json kept.json
expect_ok 'a profile' - ./notes --profile n2 -o profile.csv
# the sphere has a radius of .45 of the width of the picture: the test of the library knows its heights
check 'is a table in both units' sh -c "head -n 1 profile.csv | grep -q '^along_px,x,y,height_px,along_mm,height_mm' && [ \$(wc -l <profile.csv) = 38 ]"
check 'it rises to the middle' awk -F, 'NR == 20 { m = $4 } NR == 13 { a = $4 } END { exit !(m > a + 0.5 && a > 0) }' profile.csv
expect_ok 'other words' - ./notes --rewrite n1 --text gone --remove n3 --remove n5
check 'are there' sh -c "[ \$(grep -c . out.txt) = 3 ] && grep -q '^n1 .*gone' out.txt"
expect_ok 'JSON' - ./notes --json
check 'has a number for everything' grep -q '"id": "n4", "kind": "polygon", "places": \[\[0, 0\], .*"length": 40, "area": 100, "degrees": null' out.txt

# ---- what is refused leaves the list as it is
cp dome.notes.json kept.json
fail() { name=$1 status=$2 pattern=$3; shift 3; expect_fail "$name" "$status" "$pattern" - ./notes "$@"; }
fail 'unknown kind' 2 "unknown kind of note 'dot'; " --add 'dot 1,2'
fail 'broken place' 2 "expected places as 'X,Y X,Y'" --add 'point 1;2'
fail 'no number' 2 'lies far beside the picture' --add 'point nan,2'
fail 'too few places' 2 'a line has 2 to 10000 places; found 1' --add 'line 1,2'
fail 'unknown note' 2 "there is no note 'n9'" --remove n1 --remove n9
fail 'text for nothing' 2 'belong to --add' --text x
fail 'ruler alone' 2 'need each other' --ruler n2
fail 'ruler of a point' 2 "note 'n1' has no length" --ruler n1 --length 3
fail 'profile of a polygon' 2 'is a polygon; expected a line' --profile n4 -o p.csv
fail 'no such view' 2 'has 1 view, counted from 0' --view 1
fail 'notes of nobody' 1 'none.json' --import none.json
echo '{"type": "AnnotationPage", "items": [{"target": {"selector": {"type": "PointSelector"}}}]}' >bad.json
fail 'a broken note' 1 'bad.json: note 1: its selector cannot be read' --import bad.json
same 'nothing of it is kept' dome.notes.json kept.json
sed 's/"width": 48/"width": 50/' kept.json >dome.notes.json
fail 'notes of another file' 1 'these notes are on a file of 1 view of 50 x 48 pixels; found 1 of 48 x 48 in dome.exr'
head -c 300 kept.json >dome.notes.json
fail 'a list cut short' 1 'dome.notes.json: line .*; expected JSON' --add 'point 1,2'
check 'is not replaced' test "$(wc -c <dome.notes.json)" = 300
cp kept.json dome.notes.json
expect_ok 'without notes and scale' - ./notes --remove n1 --remove n2 --remove n4
check 'the scale stays' grep -q '"relume:mmPerPixel": 0.5,' dome.notes.json

# ---- a file that is encoded again keeps what is inside it; pictures of another size do not
cp dome.exr old.exr
"$RELUME" notes old.exr --add 'point 3,4' --text kept -q >/dev/null && "$RELUME" notes old.exr --embed -q >/dev/null
expect_ok 'encoded again' - "$RELUME" encode dome -o old.exr --bits half -q
check 'notes stay inside' sh -c "'$RELUME' notes old.exr | grep -q kept && [ ! -e old.notes.json ]"
"$sphere" larger --size 64 --lights 12 --hemisphere --shade wrap --format png || exit 1
"$RELUME" encode larger -o old.exr -q 2>err.txt
check 'those of other pictures lie beside it' sh -c "grep -q 'notes on pictures of another size; they are in old.exr.notes-before.json' err.txt && grep -q kept old.exr.notes-before.json"

# ---- inside the file: it holds its notes and is else the same, byte by byte
cp dome.exr alone.exr
printf '{"@context": "http://www.w3.org/ns/anno.jsonld", "type": "AnnotationPage", "items": [{"id": "n1", "type": "Annotation",
"body": {"type": "TextualBody", "value": "für <später>", "language": "de"}, "target": {"selector": {"type": "PointSelector", "x": 3, "y": 4}}}]}' >foreign.json
rm dome.notes.json
expect_ok 'notes of another program' - ./notes --import foreign.json --add 'line 1,1 40,30' --text long --state 'light=dir,0,0,1' --scale 0.5
"$RELUME" notes dome.exr --json >before.json
expect_ok 'notes go into the file' - ./notes --embed
check 'and not beside it' test ! -e dome.notes.json
differ 'the file has them' dome.exr alone.exr
expect_ok 'it is whole' - "$RELUME" check dome.exr
"$RELUME" notes dome.exr --json >inside.json
same 'the tool finds them there' before.json inside.json
expect_ok 'publish too' - "$RELUME" publish dome.exr -o site
check 'with what others wrote' grep -q '"language": *"de"' site/dome/notes.json
printf 'size 500 300\nkey ctrl+n\nshot seen.png\n' >look.txt
"$VIEWER" dome.exr --script look.txt && mv seen.png inside.png
expect_ok 'notes come out' - ./notes --extract
same 'the file is what it was' dome.exr alone.exr
"$RELUME" notes dome.exr --json >after.json
same 'nothing is lost' before.json after.json
check 'nor what others wrote' grep -q '"language": *"de"' dome.notes.json
"$VIEWER" dome.exr --script look.txt
same 'the viewer finds them there too' seen.png inside.png
mv dome.notes.json lost.json
"$VIEWER" dome.exr --script look.txt
differ 'and shows them' seen.png inside.png
mv lost.json dome.notes.json
expect_ok 'a list beside a file' - ./notes --embed --add 'point 1,1'
expect_ok 'hides that inside' - ./notes --remove n1 --remove n2 --remove n3
check 'even an empty one' sh -c "./notes --json | grep -q '\"notes\": \[\]'"
rm dome.notes.json
check 'which is there still' sh -c '[ $(./notes | wc -l) = 3 ]'
cp dome.exr held.exr
fail 'in and out at once' 2 'choose one of them' --embed --extract
expect_fail 'nothing to take out' 1 'it holds no notes; --embed puts them there' - "$RELUME" notes alone.exr --extract
cp dome/view00/depth.exr other.exr
expect_fail 'an EXR that is none of ours' 1 'notes go into relume files' - "$RELUME" notes other.exr --embed
# a byte of the text, so that it is no JSON
sed 's/"AnnotationPage"/"AnnotationPage!/' held.exr >dome.exr
fail 'broken notes inside' 1 'dome.exr: the notes inside: line .*; expected JSON'
finish
