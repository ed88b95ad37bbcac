#!/bin/sh
# Lists of lights beside photographs: names decide in any order and spelling, for encode and capture.
. "$(dirname "$0")/lib.sh"
"$sphere" ball --size 48 --lights 12 --hemisphere --shade lambert --format png || exit 1
basis='--basis table --bits half'
mkdir photos && i=1
for name in left top right bottom 'north west' IMG_2 IMG_10 h8 h9 k1 k2 k3; do
    cp "$(ls ball/view00/*.png | sed -n ${i}p)" "photos/$name.png"
    sed -n "$((i + 1))p" ball/dirs.lp | sed "s|^[^ ]*|$name.png|" >>named.txt
    i=$((i + 1))
done
sed 's/.*png //' named.txt >bare.txt
sort -r named.txt >reverse.txt
lights() { sed 1d "$1/lights.lp"; } # of a capture
capture() { # name, pattern, list, options...
    case=$1 pattern=$2 given=$3
    shift 3
    rm -rf cap
    expect_ok "$case" "$pattern" "$RELUME" capture "$@" --lights "$given" -o cap
}
capture 'a list in order' - named.txt photos
mv cap want
for list in reverse named; do
    for change in 's/$//' 's/\.png/.JPG/' 's/^/C:\\jobs\\/' 's/\.png / /' 's/$/ 800/' 's/.*/\U&/'; do
        sed "$change" $list.txt >list.txt
        capture "$list: $change" - list.txt photos
        lights cap >got.txt && lights want >want.txt
        same 'each photograph has its light' got.txt want.txt
    done
done
sed 's/\(.*\)\.png \(.*\) \(.*\) \(.*\)/\4;"\1.png";\3;\2/; s/\./,/g; s/,png/.png/' reverse.txt | sed '1i z;file;y;x' >list.csv
capture 'a table of a spreadsheet' - list.csv photos
lights cap >got.txt
same 'each photograph has its light' got.txt want.txt
iconv -f UTF-8 -t UTF-16 reverse.txt >wide.txt 2>/dev/null && {
    capture 'UTF-16' - wide.txt photos
    lights cap >got.txt
    same 'each photograph has its light' got.txt want.txt
}

# ---- encode: a .lp file, a folder with a list
cp -r photos lp && cp reverse.txt lp/all.lp
cp -r photos folder && cp reverse.txt folder/light_dirs.txt
cp -r photos table && cp list.csv table/lights.csv
for input in lp lp/all.lp folder table; do
    expect_ok "encode $input" - "$RELUME" encode $input -o got.exr $basis -q --force
    "$RELUME" encode lp -o first.exr $basis -q --force 2>err.txt
    for f in got first; do "$RELUME" relight $f.exr -o $f.pfm --light 'dir 0.3 0.2 1' -q 2>err.txt; done
    below 'the same picture' "$("$mkimage" maxdiff got.pfm first.pfm)" 1e-6
    expect_ok 'its photographs come back' - "$RELUME" eval got.exr $input --json
    above 'under their lights' "$(field psnr_db out.txt)" 60
done
"$RELUME" eval first.exr folder --json >a.json 2>err.txt
above 'folders agree with .lp files' "$(field psnr_db a.json)" 60

# ---- photographs beside their list
for list in all.lp lights.csv light_directions.txt; do
    cp -r photos beside
    case $list in *.csv) cp list.csv beside/$list ;; *) cp reverse.txt beside/$list ;; esac
    rm -rf cap
    expect_ok "beside: $list" "beside/$list: light directions are taken from this file" "$RELUME" capture beside -o cap
    lights cap >got.txt
    same 'each photograph has its light' got.txt want.txt
    rm -r beside
done

# ---- lists without names
set -- photos/left.png photos/top.png photos/right.png photos/bottom.png 'photos/north west.png' \
    photos/IMG_2.png photos/IMG_10.png photos/h8.png photos/h9.png \
    photos/k1.png photos/k2.png photos/k3.png
capture 'photographs in an order of their own' \
    "bare.txt: its lights are taken in the order in which photographs were given: light 1 is that of 'left.png', light 12, the last, that of 'k3.png'" \
    bare.txt "$@"
lights cap >got.txt
same 'keep it' got.txt want.txt
ls photos | sed 's|.*|photos/&|' | LC_ALL=C sort -V >order.txt
while read -r photo; do grep "^${photo#photos/} " named.txt; done <order.txt | sed 's/.*png //' >sorted.txt
capture 'a folder in the order of numbers' - sorted.txt photos
lights cap >got.txt
same 'IMG_2 before IMG_10' got.txt want.txt
capture 'as a shell sorts them' "in the order of the photographs' names: light 1 is that of 'IMG_2.png'" sorted.txt photos/*
lights cap >got.txt
same 'is the order of numbers too' got.txt want.txt
sed 's/\.png/-x.png/' named.txt >others.txt
capture 'names of others' "warning: others.txt: none of the listed images exists \('left-x.png'\)" others.txt "$@"
awk '{ print 900 * $1, 900 * $2, 900 * $3 }' sorted.txt >mm.txt
capture 'millimetres' 'mm.txt: is read as light directions; add --near where it holds the positions' mm.txt photos
lights cap | cut -d' ' -f2- | paste -d' ' - want.txt | awk '{ print ($1 - $5) ^ 2 + ($2 - $6) ^ 2 + ($3 - $7) ^ 2 }' | sort -g | tail -n 1 >far.txt
below 'have the same directions' "$(cat far.txt)" 1e-9
capture 'balls beside a list' 'warning: --lights is given, so --ball is not used' sorted.txt photos --ball 24,24,9

# ---- what does not match
bad() { # name, pattern, list, photographs...
    case=$1 pattern=$2 list=$3
    shift 3
    expect_fail "$case" 1 "$pattern" out "$RELUME" capture "$@" --lights "$list" -o out
}
sed 's/^top/roof/' named.txt >some.txt
bad 'a photograph without a light' "some.txt: names no light for 'top.png', and no photograph is 'roof.png'; --skip-bad" some.txt photos
capture 'is left out when that is allowed' 'top.png: left out: some.txt names no light for it' some.txt photos --skip-bad
sed 's/^top/left/' named.txt >twice.txt
bad 'a name twice' "twice.txt: 'left.png' is listed in lines 1 and 2; 'top.png' is never listed" twice.txt photos
head -n 5 bare.txt >few.txt
bad 'too few lights' 'few.txt: 5 lights; expected 12' few.txt photos
head -n 1 bare.txt >one.txt
bad 'one line' 'one.txt: 1 light; expected 12' one.txt photos
sed 's/$/ 0/; s/[^ ]*png//' named.txt | awk '{ print 0, 0, 1, 0 }' >either.txt
bad 'two layouts' 'either.txt: its lines hold more than three numbers, and numbers 1 to 3 fit' either.txt photos
bad 'a picture' 'left.png: not a text file; expected a list of lights' photos/left.png photos
cp twice.txt lp/all.lp
not_encoded 'a name twice, .lp' "lp/all.lp: 'left.png' is listed in lines 1 and 2; 'top.png' is never listed" lp
cp some.txt lp/all.lp
not_encoded 'a missing photograph, .lp' "image 'roof.png' does not exist; 1 of 12 images is missing; --skip-missing continues without it; no line lists 'top.png'" lp
rm lp/all.lp && cp some.txt folder/light_dirs.txt
not_encoded 'some names, folder' "light_dirs.txt: names no light for 'top.png', and no photograph is 'roof.png'; --skip-missing" folder
cp sorted.txt lp/bare.lp
expect_ok 'a .lp file without names' 'bare.lp: names no photographs; the 12 images of the folder are taken in the order' "$RELUME" encode lp -o bare.exr $basis
"$RELUME" relight bare.exr -o bare.pfm --light 'dir 0.3 0.2 1' -q 2>err.txt
below 'has the order of names' "$("$mkimage" maxdiff bare.pfm first.pfm)" 1e-6
finish
