#!/bin/sh
# Check sums: every byte of a relume file, and of a part of one, is in one of them, by a reader that
# knows docs/format.md alone (tests/tools/sums.py); 'check' sees each bit that changes, 'join' takes
# no part with one.
. "$(dirname "$0")/lib.sh"
[ "$python" ] || { skip 'check sums' 'no python3'; exit 0; }
sums() { "$python" "$TOP/tests/tools/sums.py" "$@"; }

"$RELUME" synth teapot -o slab --size 40 --views 3x3 --lights 8 --samples 1 -q
"$sphere" masked --size 40 --lights 12 --hemisphere --mask
"$sphere" large --size 140 --lights 5 --hemisphere --mask
"$RELUME" synth teapot -o few --size 20 --views 2x1 --lights 5 --samples 1 -q
relume encode masked -o lossless.exr --basis sh --coefficients 9
relume encode masked -o none.exr --basis ptm --compression none
relume encode masked -o rle.exr --basis ptm --compression rle --bits 16
relume encode masked -o zip.exr --basis ptm --compression zip --bits half
relume encode masked -o codebook.exr --basis sh --coefficients 9 --codebook 40
relume encode slab -o shared.exr --basis sh --coefficients 4 --codebook 40 --share
relume encode few -o coded.exr --psnr 30
relume encode large -o pyramid.exr --basis ptm --pyramid yes
relume encode large -o pyramid-coded.exr --basis ptm --psnr 30 --pyramid yes
relume encode slab -o whole.exr --basis pca --shadows no
for i in 1 2 3; do relume encode slab --basis pca --part $i/3 -o $i.part; done
relume encode masked --basis pca --part 1/2 -o rows.part
relume encode few --basis sh --coefficients 4 --psnr 30 --part 1/2 -o coded.part
relume join 1.part 2.part 3.part -o joined.exr
same 'joined is what one machine writes' whole.exr joined.exr
for f in *.exr *.part; do check "every byte of $f is in a sum" sums "$f"; done

# ---- what people see
"$RELUME" info joined.exr >info.txt
check 'info says so' grep -qx "check sums    yes; 'relume check' finds any byte that has changed" info.txt
"$RELUME" info 1.part >info.txt
check 'of a part too' grep -qx "check sums    yes; 'relume check' finds any byte that has changed" info.txt
"$RELUME" info joined.exr --json >info.json
check 'as JSON' grep -q '"check_sums": true' info.json
old=$TOP/tests/golden/old-books.exr
"$RELUME" check "$old" >out.txt 2>err.txt
check 'a file of before' [ $? = 0 -a "$(cat out.txt)" = "$old: whole; without check sums, so that not every changed byte is seen" ]
"$RELUME" info "$old" >info.txt
check 'info of it' grep -qx 'check sums    no; made by an earlier version' info.txt
"$RELUME" info slab/view00/light0000.exr >info.txt 2>err.txt
check 'of what is no relume file nothing is said' sh -c '! grep -q "check sums" info.txt'

# ---- one bit changed, at many places
for f in lossless.exr none.exr codebook.exr coded.exr pyramid.exr joined.exr 1.part rows.part coded.part; do
    rm -rf changed
    sums --flip 120 $f changed
    "$RELUME" check changed/* >out.txt 2>err.txt
    check "$f: check sees all of 120 changed bytes" [ "$(grep -c ': whole' out.txt)" = 0 -a "$(ls changed | wc -l)" = 120 ]
done
relume encode masked --basis pca --part 2/2 -o other.part
relume encode few --basis sh --coefficients 4 --psnr 30 --part 2/2 -o second.part
refused() { # part, how many changes, the others: each is refused in one line that names it
    part=$1 changes=$2 taken=0 unsaid=
    shift 2
    rm -rf changed
    sums --flip "$changes" "$part" changed
    for c in changed/*; do
        "$RELUME" join "$c" "$@" -o out.exr -q 2>err.txt
        [ $? = 1 ] || taken=$((taken + 1))
        [ "$(grep -cE "^relume: $c: .*(damaged|missing|not the kind|expected 1 to|header|is bad)" err.txt)" = 1 -a "$(wc -l <err.txt)" = 1 ] || unsaid="$c: $(cat err.txt)"
    done
    check "$part: join takes none of $changes" [ $taken = 0 -a ! -e out.exr ]
    if [ "$unsaid" ]; then not_ok "$part: damaged, in one line" "$unsaid"; else ok "$part: damaged, in one line"; fi
    expect_ok "$part: itself is taken" - "$RELUME" join "$part" "$@" -o out.exr
    rm out.exr
}
refused 1.part 60 2.part 3.part
refused rows.part 20 other.part
refused coded.part 20 second.part
cp rows.part bad.part
printf 'spoiled!' | dd of=bad.part bs=1 seek=$(($(wc -c <bad.part) / 2)) conv=notrunc 2>/dev/null
expect_fail 'rows of a damaged part are not joined' 1 "^relume: bad.part: damaged; run this part again$" out.exr "$RELUME" join bad.part other.part -o out.exr
cp 2.part bad.part
printf 'spoiled!' | dd of=bad.part bs=1 seek=$(($(wc -c <bad.part) / 2)) conv=notrunc 2>/dev/null
expect_fail 'nor its views' 1 "^relume: bad.part: damaged in part 'view000[3-5]', rows [0-9]+ to [0-9]+; run this part again$" out.exr \
    "$RELUME" join 1.part bad.part 3.part -o out.exr

# ---- many bytes: a sector of zeros, two blocks exchanged, something between
size=$(wc -c <lossless.exr)
cp lossless.exr sector.exr
dd if=/dev/zero of=sector.exr bs=512 seek=$((size / 1024)) count=1 conv=notrunc 2>/dev/null
"$RELUME" check sector.exr >out.txt 2>err.txt
check 'a sector of zeros' grep -q "^sector.exr: part 'view0000', rows [0-9]* to [0-9]*: missing or damaged$" out.txt
size=$(wc -c <none.exr)
half=$((size / 2))
row=$((12 + 18 * 40 * 2)) # of a view: 18 planes of 40 halves
{ head -c $half none.exr && tail -c +$((half + row + 1)) none.exr | head -c $row && tail -c +$((half + 1)) none.exr | head -c $row &&
    tail -c +$((half + 2 * row + 1)) none.exr; } >moved.exr
check 'only places differ' [ "$(wc -c <moved.exr)" = "$size" ]
"$RELUME" check moved.exr >out.txt 2>err.txt
check 'rows exchanged' grep -q "^moved.exr: part 'view0000', rows " out.txt
# a header changed: a light's direction, by what is not seen otherwise
at=$(grep -abo relume.lights lossless.exr | cut -d: -f1)
cp lossless.exr light.exr
printf '\001' | dd of=light.exr bs=1 seek=$((at + 40)) conv=notrunc 2>/dev/null
expect_fail 'a light has moved' 1 'light.exr: damaged header: sizes, lights, steps or the places of blocks have changed' - "$RELUME" check light.exr
finish
