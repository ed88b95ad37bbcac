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
awk 'BEGIN { print "name,x,y,z" } { printf "dir_%d,%s,%s,%s\n", NR - 1, $1, $2, $3 }' stage/light_dirs.txt >lights.csv
awk 'BEGIN { printf "[" } { printf "%s[%s, %s, %s]", (NR > 1 ? ", " : ""), $1, $2, $3 } END { print "]" }' stage/light_dirs.txt >lights.json
for list in lights.csv lights.json; do
    rm -f stage/*.*
    cp $list stage/
    expect_ok "a stage with $list" - "$RELUME" encode stage -o b.exr --basis table --bits half -q
    same "$list says the same" a.exr b.exr
done

# Tables that name their pictures, in another order; that name others
rm -f stage/*.*
{ head -n 1 lights.csv; sed 1d lights.csv | sort -r; } >stage/lights.csv
expect_ok 'a table by name' - "$RELUME" encode stage -o b.exr --basis table --bits half -q
same 'its order does not matter' a.exr b.exr
sed 's/dir_/l/' lights.csv >stage/lights.csv
expect_ok 'a table of other names' 'warning: stage/lights.csv: none of the listed images exists' "$RELUME" encode stage -o b.exr --basis table --bits half
same 'its lights are taken in order' a.exr b.exr

# JSON that names its pictures, in another order; with a name that is none
rm -f stage/*.*
awk '{ line[NR] = sprintf("{\"name\": \"dir_%d.exr\", \"direction\": [%s, %s, %s]}", NR - 1, $1, $2, $3) } END { printf "["; for (i = NR; i > 0; i--) printf "%s%s", line[i], (i > 1 ? ", " : "]\n") }' places.txt >stage/lights.json
expect_ok 'a list by name' - "$RELUME" encode stage -o b.exr --basis table --bits half -q
same 'says the same in any order' a.exr b.exr
sed -i 's/dir_7\./dir_77./' stage/lights.json
expect_fail 'a picture without a light' 1 "names no light for 'dir_7.exr', and no photograph is 'dir_77.exr'; --skip-missing" no "$RELUME" encode stage -o no
expect_ok 'is left out when that is allowed' 'warning: stage/lights.json: left out: 1 photographs without a light, 1 lights without a photograph' "$RELUME" encode stage -o b.exr --basis table --skip-missing --force
below 'the others are kept' "$("$RELUME" info b.exr --json >info.json && field lights info.json)" 23
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
head -c 20000 stage.exr >short.exr
expect_fail 'a truncated file' 1 'short.exr' no "$RELUME" encode short.exr -o no
rm stage/olat/dir_3.exr
expect_fail 'a picture is missing' 1 '24 lights; expected 23' no "$RELUME" encode stage -o no
printf '[[1,0,0],[0,0,0]]' >stage/lights.json
expect_fail 'no direction' 1 'light 1; expected three numbers' no "$RELUME" encode stage -o no
expect_fail 'a folder' 2 '\-\-to olat writes an .exr' no "$RELUME" export t.exr --to olat -o no
expect_fail 'with a size' 2 'bytes-per-pixel: --to olat' no.exr "$RELUME" export t.exr --to olat -o no.exr --bytes-per-pixel 1
expect_fail 'a recipe alone' 2 'recipe needs --environment' - "$RELUME" lights --recipe nuke
expect_fail 'no file' 2 'needs a FILE' - "$RELUME" lights --environment sky.ppm
expect_fail 'no such map' 1 'gone.hdr' - "$RELUME" lights stage.exr --environment gone.hdr
finish
