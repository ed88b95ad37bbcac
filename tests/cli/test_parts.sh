#!/bin/sh
# Encoding shared by machines: all parts joined are the file of one machine byte for byte, whatever the
# order, the storage and the extras; a part that does not belong to the others is one line.
. "$(dirname "$0")/lib.sh"

"$RELUME" synth teapot -o slab --size 40 --views 3x3 --lights 8 --samples 1 -q
"$sphere" masked --size 24 --lights 12 --views 5 --mask --format png || exit 1

encode_parts() { # capture parts options...: into 1.part, 2.part, ...
    capture=$1 parts=$2
    shift 2
    rm -f ./*.part
    for i in $(seq "$parts"); do
        relume encode "$capture" "$@" --part "$i/$parts" -o "$i.part" || return
    done
}
joined() { # name capture parts options...: the parts, backwards, are the file of one machine
    name=$1 capture=$2 parts=$3
    shift 3
    rm -f whole.exr joined.exr
    relume encode "$capture" --shadows no "$@" -o whole.exr
    encode_parts "$capture" "$parts" "$@"
    relume join $(ls -r ./*.part) -o joined.exr
    same "$name" whole.exr joined.exr
}

joined 'by itself' slab 4
joined 'one part' slab 1
joined 'a part for each view' slab 9 --basis sh --coefficients 4
joined 'half floats, zip, without depth' slab 2 --basis pca --bits half --compression zip --no-depth
joined 'masks' masked 3
joined 'floats, rle' masked 2 --basis sh --coefficients 4 --bits float --compression rle
joined 'a codebook for each view' masked 3 --basis sh --coefficients 4 --codebook 7
joined 'one step' masked 2 --basis pca --step common --bits 12
# fewer views than parts: rows of views, 16 or more
"$RELUME" synth bust -o flat --size 70 --lights 12 --samples 1 -q
"$sphere" cut --size 44 --lights 9 --views 2 --mask --format jpg
"$RELUME" synth attic -o room --size 40 --lights 8 --samples 1 -q
joined 'rows, by itself' flat 3 --lossless
joined 'rows, as many as can be' flat 5 --basis sh --coefficients 4
joined 'rows of halves, one step' flat 2 --basis table --bits half --step common
joined 'rows of floats' flat 2 --basis sh --coefficients 4 --bits float --compression zip
joined 'rows, luminance and colour' flat 2 --basis sh --coefficients 4 --colour luminance --bits log
joined 'rows of one of two views, masks' cut 5
joined 'rows of one of two views, one step' cut 3 --basis pca --step common --bits 12
joined 'rows of a panorama' room 2 --lossless
check 'the joined file is whole' relume check joined.exr
# the pyramid of rows is made when they are joined
"$sphere" large --size 150 --lights 9 --hemisphere --mask --format jpg
joined 'rows of a view with a pyramid' large 3 --pyramid yes --basis sh --coefficients 4
joined 'a view with a pyramid, in the display domain' large 2 --pyramid yes --basis ptm --domain display
joined 'a whole view with a pyramid' large 1 --pyramid yes --basis ptm

# ---- threads, and a part that is made again
encode_parts slab 2 --basis pca
cp 2.part before.part
relume encode slab --basis pca --part 2/2 -o 2.part --threads 1
same 'a part made again, by one thread' 2.part before.part
rm before.part

# ---- learning is shared by files: each part reads its share, missing ones are made
shared() { # name capture parts options...: learnt first, then the parts, backwards; against one machine
    name=$1 capture=$2 parts=$3
    shift 3
    rm -rf learnt ./*.part
    relume encode "$capture" --shadows no "$@" -o whole.exr
    for i in $(seq "$parts"); do
        relume encode "$capture" "$@" --part "$i/$parts" --learnt learnt --learn-only -o "$i.part" >out.txt || return
    done
    check "$name: a share each, and no part" [ "$(ls learnt | grep -c samples)" = "$parts" -a ! -e 1.part ]
    for i in $(seq "$parts" -1 1); do
        relume encode "$capture" "$@" --part "$i/$parts" --learnt learnt -o "$i.part" || return
    done
    relume join ./*.part -o joined.exr
    same "$name" whole.exr joined.exr
}
shared 'learnt together, by itself' slab 4
shared 'learnt together, masks' masked 3 --basis pca
shared 'learnt together, rows of JPEGs' cut 5 --basis pca --coefficients 8
shared 'learnt together, rows, by itself' flat 3 --lossless
check 'their steps are learnt, so that join copies rows' grep -q relume.part.stored 1.part
codebook_of_all() { # name options...: nothing was learnt first
    name=$1
    shift
    rm -rf learnt
    encode_parts slab 3 --learnt learnt --share "$@"
    relume encode slab --share "$@" -o whole.exr
    relume join 3.part 1.part 2.part -o joined.exr
    same "$name" whole.exr joined.exr
}
codebook_of_all 'one codebook of all views' --basis sh --coefficients 4 --codebook 40
codebook_of_all 'two stages, dithered' --basis pca --coefficients 6 --codebook 16 --stages 2 --dither 0.5
check 'a part with them is whole' relume check 2.part
nothing_learnt() { # name, options: said, done, and no folder
    name=$1
    shift
    rm -rf none
    "$RELUME" encode slab "$@" --part 1/2 --learnt none --learn-only -o 1.part -q >out.txt 2>err.txt
    check "$name" [ $? = 0 -a ! -e none -a ! -s err.txt -a "$(grep -c '^slab: nothing is learnt before encoding with these options; run the same line without --learn-only$' out.txt)" = 1 ]
}
nothing_learnt 'nothing to learn for a fixed basis' --basis sh --coefficients 4
nothing_learnt 'nor for a table' --basis table --interpolant chord
# parts that find nothing make all shares; one that was killed leaves only that it had begun
rm -rf learnt ./*.part
mkdir learnt learnt/samples.2of3.begun
encode_parts slab 3 --learnt learnt --basis pca
relume encode slab --basis pca -o whole.exr
relume join ./*.part -o joined.exr
same 'without learning first' whole.exr joined.exr
check 'all shares are there' [ "$(ls learnt | grep -c '^samples.[123]of3$')" = 3 ]
# three at once
rm -rf learnt ./*.part
for i in 1 2 3; do
    relume encode slab --basis pca --part $i/3 --learnt learnt -o $i.part &
done
wait
relume join ./*.part -o joined.exr
same 'three at once' whole.exr joined.exr
check 'nothing else is left' [ "$(ls learnt | wc -l)" = 3 ]
not_learnt() { # name pattern options...
    name=$1 pattern=$2
    shift 2
    expect_fail "$name" 1 "$pattern" out.part "$RELUME" encode slab --part 1/3 --learnt learnt -o out.part "$@"
}
not_learnt 'learnt with other options' "learnt/samples.1of3: learnt in other work; expected 'relume .*options --basis pca --bits 12'" --basis pca --bits 12
cp learnt/samples.1of3 good
cp learnt/samples.2of3 learnt/samples.1of3
not_learnt 'a share doubled' "learnt/samples.1of3: expected 'relume-learnt 1 samples.1of3'; found 'relume-learnt 1 samples.2of3'" --basis pca
head -c 2000 good >learnt/samples.1of3
not_learnt 'a damaged share' 'learnt/samples.1of3: damaged; remove it, and it is made again' --basis pca
rm learnt/samples.1of3
relume encode slab --basis pca --part 1/3 --learnt learnt -o again.part
same 'a share made again' 1.part again.part
same 'the same share' good learnt/samples.1of3
rm again.part

# with loss: steps are found on all views, groups of which the parts hold
with_loss() { # name capture parts options...: learnt in rounds, the parts backwards; against one machine
    name=$1 capture=$2 parts=$3 rounds=0
    shift 3
    rm -rf learnt ./*.part
    relume encode "$capture" --shadows no "$@" -o whole.exr
    while [ "$(grep -c 'all is learnt' said.txt)" != "$parts" ] && [ $rounds -lt 12 ]; do
        rounds=$((rounds + 1))
        for i in $(seq "$parts"); do
            "$RELUME" encode "$capture" "$@" --part "$i/$parts" --learnt learnt --learn-only -o "$i.part" -q || return
        done >said.txt 2>err.txt
    done
    check "$name: no part before all is learnt" [ ! -e 1.part ]
    for i in $(seq "$parts" -1 1); do
        relume encode "$capture" "$@" --part "$i/$parts" --learnt learnt -o "$i.part" || return
    done
    relume join ./*.part -o joined.exr
    same "$name" whole.exr joined.exr
}
"$RELUME" synth teapot -o few --size 24 --views 3x3 --lights 5 --samples 1 -q
: >said.txt
with_loss 'a quality in groups' few 2 --basis pca --coefficients 4 --psnr 26
check 'the steps are learnt in rounds' [ $rounds -gt 2 ]
"$RELUME" info 1.part >info.txt
check 'info says that views are in groups' grep -q '^views         [45] of 9, in groups of neighbours$' info.txt
check 'a part with loss is whole' relume check 2.part
encode_parts few 2 --basis pca --coefficients 4 --psnr 26
relume join ./*.part -o joined.exr
same 'a quality, each part by itself' whole.exr joined.exr
: >said.txt
with_loss 'rows of a fixed basis' flat 2 --basis sh --coefficients 4 --bits half
check 'join copies them' grep -q relume.part.stored 1.part
: >said.txt
with_loss 'bytes, masks, a part without views' masked 2 --basis sh --coefficients 4 --bytes-per-pixel 4
# of seven groups of views two are tried first: what they took at that step is not coded again
"$sphere" seven --size 16 --lights 4 --views 7 --format png
: >said.txt
with_loss 'some groups first, then all' seven 7 --basis pca --coefficients 4 --psnr 36
first=$(cd learnt && for f in words.2.*.2of7; do [ -e "words.7${f#words.2}" ] && echo "words.7${f#words.2}"; done | head -n 1)
check 'a group that was tried is not in the trial of all' grep -aq '^1 [0-9a-f]*$' "learnt/$first"
check 'one that was not is' test "$(wc -c <"learnt/${first%.2of7}.1of7")" -gt 1000
rm -rf learnt ./*.part
for i in 1 2; do
    "$RELUME" encode large --basis pca --coefficients 6 --bytes-per-pixel 1 --pyramid yes --part $i/2 --learnt learnt -o $i.part 2>said.$i &
done
wait
relume encode large --basis pca --coefficients 6 --bytes-per-pixel 1 --pyramid yes -o whole.exr
relume join ./*.part -o joined.exr
same 'a pyramid with loss, both parts at once' whole.exr joined.exr
check 'a part without tiles says so' grep -q 'part 1 of 2 holds nothing' said.1

# larger views are shared by their tiles of 512 pixels: here four of a picture, of which one is small
"$sphere" wide --size 1544 --rows 16 --lights 4 --hemisphere --mask --format png
: >said.txt
with_loss 'tiles of one picture' wide 3 --basis sh --coefficients 1 --psnr 10
"$RELUME" info 3.part >info.txt
check 'info says how many tiles' grep -q '^tiles         2 of 4 of these views$' info.txt
"$RELUME" info 1.part --json >info.json
[ "$python" ] && check 'info --json too' "$python" -c 'import json; d = json.load(open("info.json")); assert (d["tiles"], d["all_tiles"]) == (1, 4)'
check 'a part of tiles is whole' relume check 3.part
mkdir tiles && cp ./*.part tiles
not_tiles() { # name, bytes of 2.part that become others of the same length
    LC_ALL=C sed "s/$2/" tiles/2.part >2.part
    expect_fail "$1" 1 "2.part: .*run this part again" out.exr "$RELUME" join 1.part 2.part 3.part -o out.exr
}
not_tiles 'words that are none' 'RLV1/RLV2'
not_tiles 'a group that is another' 'group0000/group0001'
not_tiles 'a view that is another' '^\(.*relume.group.string.....\)0 /\11 '
cp tiles/1.part 2.part
expect_fail 'tiles doubled' 1 '2.part: part 1 of 3, as 1.part is' out.exr "$RELUME" join 1.part 2.part 3.part -o out.exr
expect_fail 'tiles missing' 1 '1.part: part 2 of 3 is missing' out.exr "$RELUME" join 1.part 3.part -o out.exr
cp tiles/2.part 2.part
relume join 3.part 1.part 2.part -o joined.exr
same 'and once more' whole.exr joined.exr
rm -f ./*.part
for i in 1 2 3 4 5 6; do
    "$RELUME" encode wide --basis sh --coefficients 1 --psnr 10 --part $i/6 --learnt learnt -o $i.part
done 2>said.txt
check 'more parts than tiles: two hold nothing' [ "$(grep -c 'holds nothing: planes with loss are coded in 4 tiles here; expected no more than 4 parts' said.txt)" = 2 ]
relume join ./*.part -o joined.exr
same 'more parts than tiles' whole.exr joined.exr
encode_parts wide 2 --basis sh --coefficients 1 --psnr 10
relume join ./*.part -o joined.exr
same 'tiles, each part by itself' whole.exr joined.exr
# a part is killed in the middle of its trials; what it has coded stays
rm -rf learnt ./*.part
"$RELUME" encode wide --basis sh --coefficients 1 --psnr 10 --part 2/2 --learnt learnt -o 2.part 2>/dev/null &
for i in $(seq 600); do
    [ "$(ls learnt 2>/dev/null | grep -c '^words.*of2$')" -gt 0 ] && break
    sleep 0.05
done
kill -9 $! && wait $! 2>/dev/null
kept=$(ls learnt/words.*2of2 | head -n 1)
touch -d 2001-01-01 "$kept"
check 'a part that is killed leaves none' [ ! -e 2.part ]
encode_parts wide 2 --basis sh --coefficients 1 --psnr 10 --learnt learnt
relume join ./*.part -o joined.exr
same 'parts go on where one was killed' whole.exr joined.exr
check 'by what it has coded' [ "$kept" -ot whole.exr ]
head -c -1 "$kept" >short && mv short "$kept"
expect_fail 'tiles that were learnt, damaged' 1 "$kept: damaged; remove it, and it is made again" out.part "$RELUME" encode wide --basis sh --coefficients 1 --psnr 10 --part 1/2 --learnt learnt -o out.part
: >said.txt
with_loss 'tiles for bytes, with a pyramid' wide 3 --basis sh --coefficients 1 --bytes-per-pixel 0.02 --pyramid yes
"$RELUME" synth attic -o hall --size 257 --lights 2 --samples 1 -q
: >said.txt
with_loss 'tiles of a panorama' hall 2 --basis sh --coefficients 1 --psnr 14
"$sphere" pair --size 520 --rows 16 --lights 3 --views 2 --format png
relume encode pair --basis sh --coefficients 1 --bytes-per-pixel 0.05 --shadows no -o whole.exr
rm -rf learnt
encode_parts pair 3 --basis sh --coefficients 1 --bytes-per-pixel 0.05 --learnt learnt
relume join ./*.part -o joined.exr
same 'tiles of neighbours' whole.exr joined.exr

encode_parts slab 2 --basis pca
# ---- the lines for the shell
mkdir 'two words'
"$RELUME" encode slab --basis 'pca' -o "two words/it's.exr" --commands 3 >lines.txt 2>err.txt
below 'a line for each part, and one that joins' "$(wc -l <lines.txt)" 4
sh lines.txt 2>err.txt
relume encode slab --basis pca -o whole.exr
same 'the lines make the file' whole.exr "two words/it's.exr"
check 'what they learn lies beside it' [ -d "two words/it's.learnt" ]

# ---- what a part is
"$RELUME" info 1.part >info.txt
check 'info says which part' grep -q '^part          1 of 2; ' info.txt
check 'info says what was asked for' grep -q '^options       --basis pca$' info.txt
"$RELUME" info 1.part --json >info.json
[ "$python" ] && check 'info --json' "$python" -c 'import json; d = json.load(open("info.json")); assert (d["part"], d["parts"], d["views"], d["all_views"]) == (1, 2, 4, 9)'
"$RELUME" check 1.part >check.txt
check 'check says which part' grep -q '^1.part: whole; part 1 of 2$' check.txt

# ---- parts that do not belong together: one line, status 1, no output
not_joined() { # name pattern part...
    name=$1 pattern=$2
    shift 2
    expect_fail "$name" 1 "$pattern" out.exr "$RELUME" join "$@" -o out.exr
}
not_joined 'a part missing' '1.part: part 2 of 2 is missing' 1.part
not_joined 'a part doubled' '2.part: part 2 of 2, as 2.part is' 1.part 2.part 2.part
relume encode slab --basis pca --bits 8 --part 2/2 -o options.part
not_joined 'other options' "options.part: made with other options than 1.part; expected '--basis pca'; found '--basis pca --bits 8'" 1.part options.part
relume encode slab --basis pca --part 3/3 -o of3.part
not_joined 'of another number' 'of3.part: part 3 of 3; expected one of 2' 1.part of3.part
fresh slab other
"$RELUME" synth teapot -o bright --size 40 --views 3x3 --lights 8 --samples 2 -q
cp bright/view04/light0003.exr other/view04/light0003.exr
relume encode other --basis pca --part 2/2 -o other.part
not_joined 'another capture' 'other.part: a part of another capture than 1.part' 1.part other.part
sed 's/relume 0\./relume 9./' 2.part >version.part
not_joined 'a changed header' 'version.part: damaged header; run this part again' 1.part version.part
if [ "$python" ]; then
    "$python" "$TOP/tests/tools/sums.py" --mend version.part
    not_joined 'another version' 'version.part: made by relume 9' 1.part version.part
fi
not_joined 'a whole file' 'whole.exr: a whole relume file; expected a part' 1.part whole.exr
not_joined 'a picture' 'light0000.exr: an OpenEXR file, but not a part' slab/view00/light0000.exr
not_joined 'no file' 'none.part: ' 1.part none.part
head -c 3000 2.part >short.part
not_joined 'truncated' 'short.part: ' 1.part short.part
expect_fail 'a part is no relume file' 1 "1.part: a part of a relume file; expected the file that 'relume join' makes" x.png "$RELUME" relight 1.part -o x.png

# ---- what cannot be shared
cannot() { # name status pattern options...
    name=$1 want=$2 pattern=$3
    shift 3
    expect_fail "$name" "$want" "$pattern" out.part "$RELUME" encode slab -o out.part "$@"
}
cannot 'more parts than bands of rows' 1 '9 views of 40 rows cannot be shared by 28 parts; expected 16 rows or more' --part 1/28 --basis sh
cannot 'rows of a codebook' 1 'a codebook is learnt from a whole view; expected at most 9 parts for 9 views' --part 1/10 --basis sh --codebook 4
cannot 'one codebook for all' 2 '--share learns one set of codebooks from all views; expected --learnt' --part 1/2 --codebook 4 --share
cannot 'part 0' 2 '--part: expected part I of N' --part 0/2
cannot 'part 3 of 2' 2 '--part: expected part I of N' --part 3/2
cannot 'a part in words' 2 '--part: expected part I of N' --part one
cannot 'learnt by no parts' 2 '--learnt is what parts share; expected --part or --commands' --learnt learnt
cannot 'learnt nowhere' 2 '--learn-only: expected --learnt FOLDER' --learn-only --part 1/2
cannot 'both' 2 'expected one of the two' --part 1/2 --commands 2

# ---- very bright highlights: one machine would have taken halves, a part cannot know
"$sphere" lamp --size 32 --lights 1 --views 3 --hemisphere
for view in lamp/view0?; do
    "$mkimage" poke "$view/light0000.exr" lit.exr 16 16 1000 && mv lit.exr "$view/light0000.exr"
done
encode_parts lamp 2 --basis table
not_joined 'steps that are too coarse' 'very bright highlights: .*; run all parts again with --bits half' 1.part 2.part
joined 'halves, as asked for' lamp 2 --basis table --bits half
finish
