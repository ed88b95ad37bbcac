#!/bin/sh
# relume check: whole files are whole, and damage is found where it was done.
. "$(dirname "$0")/lib.sh"
relume() { "$RELUME" "$@"; }
"$sphere" cap --size 40 --lights 9 --hemisphere || exit 1
relume encode cap -o zip.exr --basis ptm --compression zip 2>/dev/null
relume encode cap -o piz.exr --basis ptm 2>/dev/null
relume encode cap -o book.exr --basis ptm --codebook 16 2>/dev/null
size=$(wc -c <zip.exr)

# damage FILE OFFSET: a copy of zip.exr with 8 bytes of it overwritten
damage() {
    cp zip.exr "$1"
    printf 'spoiled!' | dd of="$1" bs=1 seek="$2" conv=notrunc 2>/dev/null
}
# check_says NAME STATUS PATTERN FILE...: lines of stdout that match PATTERN, and the status
check_says() {
    name=$1 want=$2 pattern=$3
    shift 3
    relume check "$@" >out.txt 2>err.txt
    status=$?
    if [ $status -eq "$want" ] && grep -qE -e "$pattern" out.txt; then
        ok "$name"
    else
        not_ok "$name" "status $status; $(cat out.txt err.txt)"
    fi
}

for f in zip piz book; do
    check_says "$f.exr is whole" 0 "^$f.exr: whole$" $f.exr; done
damage middle.exr $((size / 2))
check_says "eight bytes in the middle" 1 "^middle.exr: part '.*', rows [0-9]+ to [0-9]+: " middle.exr
below "they spoil one block of zip, 16 rows" "$(awk '{ print $6 - $4 + 1 }' out.txt | tr -d :)" 16
below "one block alone" "$(wc -l <out.txt)" 1
# piz: of codes that end too early OpenEXR says that memory is short
for k in 4 5 6 7; do
    for bytes in 'spoiled!' '\0\0\0\0\0\0\0\0' '\377\377\377\377\377\377\377\377'; do
        cp piz.exr odd.exr
        printf "$bytes" | dd of=odd.exr bs=1 seek=$(($(wc -c <piz.exr) * k / 8)) conv=notrunc 2>/dev/null
        check_says "piz: $bytes at $k eighths" 1 "^odd.exr: part 'view0000', rows [0-9]+ to [0-9]+: missing or damaged" odd.exr
    done
done
expect_fail 'relight says so too' 1 'odd.exr: .*damaged' x.png "$RELUME" relight odd.exr -o x.png
damage last.exr $((size - 8))
check_says "the last bytes are the check sums" 1 "part 'sums', rows 0 to 0: missing or damaged" last.exr
damage rows.exr $((size - 66)) # 14 words and the beginning of their row
check_says "those before are the last rows" 1 "part 'view0000.depth', rows 32 to 39: missing or damaged" rows.exr
head -c $((size - 30)) zip.exr >sumless.exr
check_says "cut off in the check sums" 1 "part 'sums', rows 0 to 0: missing or damaged" sumless.exr
expect_fail "a picture is refused then" 1 "sumless.exr: truncated or damaged in part 3" x.png "$RELUME" relight sumless.exr -o x.png
relume relight zip.exr -o whole.png 2>/dev/null
check "damaged ones are not needed for it" relume relight last.exr -o last.png
same "and it is as it was" whole.png last.png
head -c $((size * 3 / 4)) zip.exr >cut.exr
check_says "what a cut file lacks ends with the last row" 1 "rows [0-9]+ to 39: missing" cut.exr
expect_fail "a damaged header" 1 "cannot be read as OpenEXR" - "$RELUME" check "$TOP/README.md"
check_says "all files are looked at" 1 "piz.exr: whole" middle.exr piz.exr
relume check middle.exr zip.exr --json >out.txt 2>/dev/null
check "as JSON" grep -q '"whole": false}, {"file": "zip.exr", "damaged": \[\], "check_sums": true, "whole": true}\]}' out.txt
# Reduced levels, in tiles
"$sphere" large --size 200 --lights 9 --hemisphere --mask || exit 1
relume encode large -o large.exr --basis ptm --compression zip --pyramid yes 2>/dev/null
check_says "a pyramid is whole" 0 "^large.exr: whole$" large.exr
relume info large.exr >out.txt
check "what it is" grep -q '^pyramid *1 smaller level, tiles of 128 pixels$' out.txt
size=$(wc -c <large.exr)
cp large.exr tile.exr
printf 'spoiled!' | dd of=tile.exr bs=1 seek=$((size / 2)) conv=notrunc 2>/dev/null
check_says "a tile of it" 1 "^tile.exr: part 'view0000', tile in column [01], row [01] \(pixels " tile.exr
below "one tile alone" "$(wc -l <out.txt)" 1
head -c $((size - 300)) large.exr >cut.exr
expect_fail "a pyramid that is cut off" 1 "cut.exr: truncated or damaged in part" x.png "$RELUME" relight cut.exr -o x.png --size 90
expect_fail "no pyramid for luminance" 1 "luminance coefficients cannot have a pyramid" x.exr "$RELUME" encode large -o x.exr --colour luminance --basis ptm --pyramid yes
# Blocks that decode, to values that are no codes: 0xffff is NaN. With check sums that fit they are
# those of another program.
relume encode cap -o none.exr --basis ptm --compression none 2>/dev/null
size=$(wc -c <none.exr)
cp none.exr wrong.exr
printf '\377\377\377\377' | dd of=wrong.exr bs=1 seek=$((size / 2)) conv=notrunc 2>/dev/null
check_says "without compression too" 1 "^wrong.exr: part 'view0000', rows [0-9]+ to [0-9]+: missing or damaged" wrong.exr
if [ "$python" ]; then
    "$python" "$TOP/tests/tools/sums.py" --mend wrong.exr
    relume check wrong.exr >out.txt 2>err.txt
    check "values that are no codes" grep -q "wrong.exr: .*expected" err.txt
else
    skip "values that are no codes" "no python3"
fi
finish
