#!/bin/sh
# relume hdr: brackets of a made camera whose radiance is known, the memorial church, and
# what is refused.
. "$(dirname "$0")/lib.sh"
made_photo="$BUILD/tests/tools/made_photo"
number() { sed -n "s/.*\"$1\": \{0,1\}\([-0-9.e+]*\).*/\1/p" "$2"; } # every value of a field

# ---- a steady camera: radiance within 2 %, of which noise makes 0.9 %
"$made_photo" truth truth.exr 160 120
printf '1\n4 # the longest\n1/4\n' >times.txt
"$made_photo" photo a.png 160 120 1 0 0 0 0.5
"$made_photo" photo b.png 160 120 4 0 0 0 0.5
"$made_photo" photo c.png 160 120 0.25 0 0 0 0.5
expect_ok 'three exposures' - "$RELUME" hdr a.png b.png c.png --times times.txt -o out.exr --save-response curve.txt
below 'radiance within 2 %' "$("$made_photo" logrms out.exr truth.exr 0)" 0.02
check 'a table is printed' grep -q '^b.png .* 4 ' out.txt
check 'the curve is monotone' awk 'NR > 2 { if ($2 < r || $3 < g || $4 < b) exit 1; r = $2; g = $3; b = $4 }' curve.txt
expect_ok 'by the curve that was found' - "$RELUME" hdr a.png b.png c.png --times times.txt -o again.exr --response curve.txt
same 'the same bytes' out.exr again.exr
expect_ok 'on three threads' - "$RELUME" hdr a.png b.png c.png --times times.txt -o again.exr --align blocks --ghosts --threads 3
expect_ok 'on one' - "$RELUME" hdr a.png b.png c.png --times times.txt -o one.exr --align blocks --ghosts --threads 1
same 'equal bytes for any threads' again.exr one.exr
expect_ok 'a grey region' - "$RELUME" hdr a.png b.png c.png --times times.txt -o out.exr --white 10,10,20,20
mkdir shots && cp a.png b.png c.png shots && cp a.png shots/d.png && cp b.png shots/e.png && cp c.png shots/f.png
expect_ok 'two brackets of a folder' - "$RELUME" hdr shots --times times.txt -o made --json
same 'one picture each' made/a.exr made/d.exr
check 'both are reported' test "$(number output out.txt | wc -l)" -eq 2
# numbers of float files do not end at 1: nothing is saturated, and the merge goes on above 1
for gain in 5 10 20; do "$mkimage" gain truth.exr g$gain.exr $gain; done
printf '1\n2\n4\n' >gains.txt
expect_ok 'three exposures as floats' - "$RELUME" hdr g5.exr g10.exr g20.exr --times gains.txt -o floats.exr --json
below 'the radiance of the shortest' "$("$mkimage" maxdiff floats.exr g5.exr)" 1e-4 # of up to 100: rounding
check 'no float is saturated' test "$(number saturated out.txt | sort -u)" = 0
printf 'c.png 0.25\nb.png 4s\na.png 1\n' >names.txt
expect_ok 'times by name' - "$RELUME" hdr a.png b.png c.png --times names.txt -o again.exr --response curve.txt
expect_ok 'in any order' - "$RELUME" capture --hdr c.png a.png b.png -q --times names.txt -o one.exr --response curve.txt
below 'the same picture' "$("$mkimage" maxdiff again.exr one.exr)" 1e-5 # sums in another order

cp a.png 'my a.png'
printf 'c.png 0.25  # the darkest\r\n\n  b.png , 4\nmy a.png\t1\n' >blanks.txt
expect_ok 'a name with a blank' - "$RELUME" hdr b.png 'my a.png' c.png --times blanks.txt -o blank.exr --response curve.txt
below 'the same picture too' "$("$mkimage" maxdiff again.exr blank.exr)" 1e-5
for t in 1e300 1e-300 1e10 0 -2 nan inf 1/0; do
    printf '1\n%s\n1/4\n' $t >far.txt
    expect_fail "a time of $t s" 1 'far.txt: line 2; expected an exposure time from' out2.exr \
        "$RELUME" hdr a.png b.png c.png --times far.txt --response curve.txt -o out2.exr
done

# ---- held by hand, and something moves
"$made_photo" photo b1.png 240 180 4 0 0 0 0.5 130 110 22
"$made_photo" photo c1.png 240 180 0.25 -3 -8 7 0.5 170 70 22
"$made_photo" photo a1.png 240 180 1 4 9 -6 0.5 90 80 22
"$made_photo" truth truth1.exr 240 180
expect_ok 'blocks' - "$RELUME" hdr a1.png b1.png c1.png --times times.txt -o out.exr --align blocks --ghosts --json
above 'ghosts are found' "$(number ghosts out.txt | sed -n 1p)" 0.02
check 'but not in the anchor' grep -q 'b1.png.*"ghosts": 0}' out.txt
"$made_photo" photo a2.png 240 180 1 4 9 -6 0.5
"$made_photo" photo b2.png 240 180 4 0 0 0 0.5
"$made_photo" photo c2.png 240 180 0.25 -3 -8 7 0.5
for mode in blocks homography; do
    expect_ok "$mode, nothing moves" - "$RELUME" hdr a2.png b2.png c2.png --times times.txt -o out.exr --align $mode
    below "radiance after $mode" "$("$made_photo" logrms out.exr truth1.exr 30)" 0.06 # and interpolation
done

# ---- a curve as the transfer of a capture
awk 'BEGIN { print "relume-response 1"; for (i = 0; i < 256; i++) { e = (i / 255) ^ 2.2; printf "%d %.9g %.9g %.9g\n", i, e, e, e } }' >gamma.txt
for t in gamma.txt gamma:2.2; do
    printf '{"format": "relume-capture", "version": 1, "transfer": "%s", "lights": {"directions": [[0,0,1],[0.5,0,0.8],[0,0.5,0.8]]},
        "views": [{"images": ["a.png", "b.png", "c.png"]}]}' $t >capture.json
    expect_ok "a capture coded by $t" - "$RELUME" encode capture.json -o "$t.exr" --basis table --domain linear --bits half
    "$RELUME" relight "$t.exr" -o "relit-$t.exr" --light 'dir 0.5 0 0.8' 2>err.txt
done
below 'response and gamma agree' "$("$mkimage" maxdiff relit-gamma.txt.exr relit-gamma:2.2.exr)" 2e-3 # half
sed 's/gamma:2.2/nowhere.txt/' capture.json >bad.json
expect_fail 'no such curve' 1 'bad.json: transfer; expected .*response-curve' - "$RELUME" encode bad.json -o x.exr

# ---- refused
fails() { # name, status, pattern, arguments...
    name=$1 want=$2 pattern=$3
    shift 3
    rm -f out.exr
    expect_fail "$name" "$want" "$pattern" out.exr "$RELUME" hdr "$@" -o out.exr
}
fails 'no EXIF' 1 'a.png: no exposure time in its EXIF; expected --times' a.png b.png c.png
printf '1\n4\n0.42\n' >lies.txt
expect_ok 'a time that lies by less' 'a.png: its exposure time is given as 1 s; its brightness fits .*; other times are wrong as well' \
    "$RELUME" hdr a.png b.png c.png --times lies.txt -o lies.exr
printf '1\n1\n1\n' >ones.txt
fails 'one exposure only' 1 'a.png: all 3 exposures .* two different' a.png b.png c.png --times ones.txt
printf '4\n1\n1/16\n' >wrong.txt
fails 'times against the pictures' 1 'a.png: darker than b.png though' a.png b.png c.png --times wrong.txt
fails 'too few times' 1 'times.txt: 3 times; expected one for each of the 2' a.png b.png --times times.txt
printf '1\nsoon\n1\n' >words.txt
fails 'times that are none' 1 'words.txt: line 2; expected' a.png b.png c.png --times words.txt
"$made_photo" photo white.png 160 120 900 0 0 0 0
"$made_photo" photo whiter.png 160 120 1900 0 0 0 0
printf '1\n2\n' >two.txt
fails 'all saturated' 1 'white.png: .*saturated' white.png whiter.png --times two.txt
fails 'all saturated, as it is said of more' 1 'white.png: saturated, as are the other 2' white.png whiter.png white.png --times ones.txt
printf '1\n4\n1/4\n900\n' >five.txt
expect_ok 'one of them white all over' - "$RELUME" hdr a.png b.png c.png white.png --times five.txt -o out.exr
below 'and of no harm' "$("$made_photo" logrms out.exr truth.exr 0)" 0.02
"$made_photo" photo other.png 160 120 1 0 9000 700 0.5
printf '1\n4\n1/4\n1/2\n' >four.txt
fails 'another scene' 1 'other.png: shows another scene' a.png b.png c.png other.png --times four.txt
expect_ok 'it can be left out' 'warning: other.png: shows another scene .*left out' "$RELUME" hdr a.png b.png c.png other.png --times four.txt -o out.exr --skip-bad
below 'and the others are merged' "$("$made_photo" logrms out.exr truth.exr 0)" 0.02
head -c 9000 a.png >torn.png
fails 'a torn file' 1 'torn.png: ' a.png b.png torn.png c.png --times four.txt
printf 'a.png 1\nb.png 4\ntorn.png 1/2\nc.png 1/4\n' >torn.txt
expect_ok 'left out as well' 'warning: torn.png: ' "$RELUME" hdr a.png b.png torn.png c.png --times torn.txt -o again.exr --skip-bad --response curve.txt
fails 'without alignment it is another scene' 1 '[abc]2.png: shows another scene .* or the camera moved' a2.png b2.png c2.png --times times.txt
fails 'other sizes' 1 'b1.png: 240 x 180 pixels; expected 160 x 120' a.png b1.png c.png --times times.txt
head -c 5000 /dev/zero >photo.nef
fails 'RAW that cannot be read' 1 'photo.nef: a RAW photograph' a.png b.png photo.nef --times times.txt
"$mkimage" poke truth.exr nan.exr 3 4 nan
fails 'NaN' 1 'nan.exr: holds NaN' truth.exr nan.exr truth.exr --times times.txt
fails 'a curve that is none' 1 'times.txt: not a response-curve' a.png b.png c.png --times times.txt --response times.txt
fails 'unknown weights' 2 "did you mean 'hat'" a.png b.png --times times.txt --weights hut
fails 'unknown alignment' 2 "did you mean 'blocks'" a.png b.png --times times.txt --align block
fails 'a region outside' 2 'white: .*expected it inside' a.png b.png c.png --times times.txt --white 150,0,20,20
fails 'a flat field of another size' 1 'a1.png: .*expected 160 x 120' a.png b.png c.png --times times.txt --flat a1.png

# ---- the memorial church (Debevec, Malik 1997)
memorial=${RELUME_DATA:-$TOP/../shared/data}/hdr-memorial-brackets
if [ -e "$memorial/memorial.hdr" ]; then
    expect_ok 'memorial church' - "$RELUME" hdr "$memorial"/memorial00*.png --times "$memorial/shutter_times.txt" -o church.exr --save-response film.txt --json
    # the scans have a border of 40 pixels in blue and black
    below 'log RMS against the reference' "$("$made_photo" logrms church.exr "$memorial/memorial.hdr" 40)" 0.10
    check 'its curve is monotone' awk 'NR > 2 { if ($2 < r || $3 < g || $4 < b) exit 1; r = $2; g = $3; b = $4 }' film.txt
    for bias in $(number bias_ev out.txt); do
        case $bias in -*) below "times agree" "${bias#-}" 0.2 ;; *) below "times agree" "$bias" 0.2 ;; esac
    done
else
    skip 'memorial church' 'no ../shared/data/hdr-memorial-brackets'
fi
finish
