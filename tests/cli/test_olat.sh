#!/bin/sh
# Light stages: an EXR with a layer for every light, out and in; folders of one light at a time; weights of an
# environment
. "$(dirname "$0")/lib.sh"
"$sphere" cap --size 48 --lights 24 >/dev/null || exit 1
expect_ok 'a table' - "$RELUME" encode cap -o t.exr --basis table --bits half -q
expect_ok 'layers' 'stage.exr: 24 layers' "$RELUME" export t.exr --to olat -o stage.exr
expect_ok 'on one thread' '24 layers' "$RELUME" export t.exr --to olat -o one.exr --threads 1
same 'equal bytes for any threads' stage.exr one.exr
expect_ok 'layers become a file' - "$RELUME" encode stage.exr -o back.exr --basis table --bits half -q
# half floats of half floats: nothing is lost
for f in t back; do expect_ok "relight $f" - "$RELUME" relight $f.exr -o $f-lit.exr --light 'dir 0.3 0.2 1'; done
below 'nothing is lost' "$("$mkimage" maxdiff t-lit.exr back-lit.exr)" 1e-6
expect_ok 'layers are shown' - "$RELUME" relight stage.exr -o lit.exr --light 'dir 0.3 0.2 1'

# ---- all that encode decides: highlights are learnt from some of the lights, then from all
"$sphere" big --size 64 --lights 24 >/dev/null && "$RELUME" encode big -o big.exr --basis table --bits half -q || exit 1
expect_ok 'layers of 64 pixels' '24 layers' "$RELUME" export big.exr --to olat -o big-olat.exr
expect_ok 'layers, highlights and all' 'highlights move' "$RELUME" encode big-olat.exr -o by-layers.exr
expect_ok 'the photographs of these' 'highlights move' "$RELUME" encode big/dirs.lp -o by-files.exr
expect_ok 'layers are judged' - "$RELUME" eval by-layers.exr big-olat.exr
for light in 3 14; do
    set -- $(sed -n "$((light + 2))p" big/dirs.lp)
    for by in layers files; do
        "$RELUME" relight by-$by.exr -o lit.exr --light "dir $2 $3 $4" -q
        "$RELUME" compare lit.exr "big/$1" | sed -n 's/^psnr_db *//p' >$by.txt
    done
    # 47.1 and 38.9 dB; the layers are halves of 32-bit photographs
    below "light $light: layers do as photographs do" "$(awk 'NR == FNR { a = $1; next } { d = a - $1; print d < 0 ? -d : d }' layers.txt files.txt)" 0.5
    check "light $light: and well" test "$(sed 's/[.].*//' layers.txt)" -ge 37
done
head -c -1000 big-olat.exr >cut.exr
expect_fail 'layers cut short' 1 'cut.exr: truncated or damaged' no.exr "$RELUME" encode cut.exr -o no.exr
"$sphere" masked --size 64 --lights 24 --mask >/dev/null && "$RELUME" encode masked -o masked.exr -q || exit 1
expect_ok 'layers of a masked capture' '24 layers' "$RELUME" export masked.exr --to olat -o masked-olat.exr
expect_ok 'become a file' - "$RELUME" encode masked-olat.exr -o by-layers.exr -q

# ---- weights: the pictures under the captured lights add up to that under the environment
printf 'P6 8 4 255 ' >sky.ppm
awk 'BEGIN { for (i = 0; i < 32; i++) printf "%c%c%c", 40 + i * 5, 60 + i % 8 * 20, 90 + i * 2 }' | LC_ALL=C tr -d '\0' >>sky.ppm
for from in stage.exr t.exr cap; do
    expect_ok "weights of $from" - "$RELUME" lights "$from" --environment sky.ppm --csv w.csv
    awk -F, 'NR > 1 { printf "--light\ndir %s %s %s rgb %s %s %s\n", $2, $3, $4, $5, $6, $7 }' w.csv >lights.txt
    check "$from: a weight for each" test "$(wc -l <lights.txt)" -eq 48
    xargs -d '\n' "$RELUME" relight t.exr -o sum.exr <lights.txt
    "$RELUME" relight t.exr -o env.exr --light 'env sky.ppm'
    below "$from: they add up" "$("$mkimage" maxdiff sum.exr env.exr)" 1e-5 # the same sum in floats
done
expect_ok 'Nuke' - "$RELUME" lights stage.exr --environment 'sky.ppm 90' --recipe nuke
check 'an expression for each colour' test "$(grep -c '^ expr[012] "[-0-9.e]*\*light0000\.[a-z]* + .*light0023\.[a-z]*"$' out.txt)" -eq 3
# what the recipes say, computed without these programs, is the picture in that light
if [ "$python" ]; then
    "$RELUME" relight t.exr -o env.pfm --light 'env sky.ppm' -q || exit 1
    LC_ALL=C sed 's/light00/1st-a_0/g' stage.exr >other.exr  # names of another program, as long
    for given in 'nuke stage' 'natron stage' 'nuke other'; do
        "$RELUME" lights "${given#* }.exr" --environment sky.ppm --recipe ${given% *} >recipe.txt 2>err.txt
        below "${given% *}: its recipe makes the picture" "$("$python" "$TOP/tests/tools/recipe.py" ${given% *} recipe.txt "${given#* }.exr" env.pfm 2>&1)" 5e-7
    done
else
    skip 'recipes make the picture' 'no python3'
fi
for program in natron blender; do
    expect_ok "$program" - "$RELUME" lights stage.exr --environment sky.ppm --recipe $program
    [ -z "$python" ] || check "$program gets Python" "$python" -c 'import ast; ast.parse(open("out.txt").read())'
done
expect_ok 'JSON' - "$RELUME" lights stage.exr --environment sky.ppm --json
[ -z "$python" ] || check 'which it is' "$python" -m json.tool out.txt /dev/null

# ---- folders: light_dirs.txt, .csv with a header, .json; pictures beside or in olat
mkdir -p stage/olat && i=0
for f in cap/view00/light*.exr; do
    cp "$f" "stage/olat/dir_$i.exr" # dir_10 after dir_9
    i=$((i + 1))
done
sed -n 's/^[^ ]*\.exr //p' cap/*.lp >stage/light_dirs.txt
cp stage/light_dirs.txt places.txt
expect_ok 'a stage' - "$RELUME" encode stage -o a.exr --basis table --bits half -q
expect_ok 'from the capture' - "$RELUME" encode cap -o c.exr --basis table --bits half -q
for f in a c; do "$RELUME" relight $f.exr -o $f-lit.exr --light 'dir 0.3 0.2 1'; done
below 'is the capture' "$("$mkimage" maxdiff a-lit.exr c-lit.exr)" 1e-6
awk 'BEGIN { print "name,x,y,z" } { printf "l%d,%s,%s,%s\n", NR, $1, $2, $3 }' stage/light_dirs.txt >lights.csv
awk 'BEGIN { printf "[" } { printf "%s[%s, %s, %s]", (NR > 1 ? ", " : ""), $1, $2, $3 } END { print "]" }' stage/light_dirs.txt >lights.json
for list in lights.csv lights.json; do
    rm -f stage/*.*
    cp $list stage/
    expect_ok "a stage with $list" - "$RELUME" encode stage -o b.exr --basis table --bits half -q
    same "$list says the same" a.exr b.exr
done

# lists that name their pictures, in another order; with a name that is none
rm -f stage/*.*
awk '{ line[NR] = sprintf("dir_%d,%s,%s,%s", NR - 1, $1, $2, $3) } END { print "name,x,y,z"; for (i = NR; i > 0; i--) print line[i] }' places.txt >stage/lights.csv
expect_ok 'a table by name' - "$RELUME" encode stage -o b.exr --basis table --bits half -q
same 'a table says the same in any order' a.exr b.exr
rm -f stage/*.*
awk '{ line[NR] = sprintf("{\"name\": \"dir_%d.exr\", \"direction\": [%s, %s, %s]}", NR - 1, $1, $2, $3) } END { printf "["; for (i = NR; i > 0; i--) printf "%s%s", line[i], (i > 1 ? ", " : "]\n") }' places.txt >stage/lights.json
expect_ok 'a list by name' - "$RELUME" encode stage -o b.exr --basis table --bits half -q
same 'says the same in any order' a.exr b.exr
sed -i 's/dir_7\./dir_77./' stage/lights.json
expect_fail 'a picture without a light' 1 "names no light 'dir_7.exr'" no "$RELUME" encode stage -o no
rm -f stage/*.*
cp lights.json stage/

# ---- photographs of kinds that OpenImageIO reads by plugins
for kind in webp avif; do
    mkdir -p $kind && rm -f only.txt
    for i in 0 1 2 3; do "$RELUME" relight t.exr -o $kind/$i.$kind --light "dir 0.$i 0.1 1" -q 2>>only.txt; done
    printf '0 .1 1\n.1 .1 1\n.2 .1 1\n.3 .1 1\n' >$kind/lights.txt
    if [ ! -s $kind/3.$kind ]; then skip "photographs in .$kind" "OpenImageIO has no writer"; continue; fi
    "$RELUME" encode $kind -o $kind.exr --basis table -q 2>err.txt
    "$RELUME" relight $kind.exr -o $kind.png --light 'dir .3 .1 1' 2>err.txt
    "$RELUME" relight t.exr -o want.png --light 'dir .3 .1 1'
    check ".$kind is read" test "$("$RELUME" compare $kind.png want.png | sed -n 's/^psnr_db *\([0-9]*\).*/\1/p')" -ge 30
done

# ---- what is refused
cp stage.exr bare.exr && sed -i 's/olat\.directions/olat.direction_/' bare.exr
rm -f light*.*
expect_fail 'no directions' 1 'bare.exr: 24 layers, but no directions' no "$RELUME" encode bare.exr -o no
printf '1 0 1\n0 1 1\n' >bare.txt
expect_fail 'too few directions' 1 'bare.txt: 2 lights; expected 24' no "$RELUME" encode bare.exr -o no
awk '{ printf "light%04d %s %s %s\n", 23 - (NR - 1), $1, $2, $3 }' places.txt >bare.txt
"$RELUME" encode bare.exr -o turned.exr --basis table -q
tac bare.txt >bare.new && mv bare.new bare.txt
expect_ok 'lines by name' - "$RELUME" encode bare.exr -o bare-lit.exr --basis table -q
same 'lines of layers in any order' turned.exr bare-lit.exr
sed -i 's/light0004/light0099/' bare.txt
expect_fail 'a layer without a light' 1 "names no light 'light0004'" no "$RELUME" encode bare.exr -o no
rm bare.txt
head -c 20000 stage.exr >short.exr
expect_fail 'a truncated file' 1 'short.exr' no "$RELUME" encode short.exr -o no
rm stage/olat/dir_3.exr
expect_fail 'a picture is missing' 1 '24 lights, but 23 pictures' no "$RELUME" encode stage -o no
printf '[[1,0,0],[0,0,0]]' >stage/lights.json
expect_fail 'no direction' 1 'light 1; expected three numbers' no "$RELUME" encode stage -o no
expect_fail 'a folder' 2 '\-\-to olat writes an .exr' no "$RELUME" export t.exr --to olat -o no
expect_fail 'with a size' 2 'bytes-per-pixel: --to olat' no.exr "$RELUME" export t.exr --to olat -o no.exr --bytes-per-pixel 1
expect_fail 'a recipe alone' 2 'recipe needs --environment' - "$RELUME" lights --recipe nuke
expect_fail 'no file' 2 'needs a FILE' - "$RELUME" lights --environment sky.ppm
expect_fail 'no such map' 1 'gone.hdr' - "$RELUME" lights stage.exr --environment gone.hdr
finish
