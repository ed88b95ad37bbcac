#!/bin/sh
# Files that are made to do harm: each ends in one line and status 1, whatever the library that reads
# it does, within a time and with a bound on addresses; the next file goes on.
. "$(dirname "$0")/lib.sh"
mkhostile="$BUILD/tests/tools/mkhostile"

# 3 GB of addresses: the helper with OpenImageIO takes 0.6 of them before it reads anything.
printf '#!/bin/sh\nulimit -v ${KB:-3000000}\nexec "$@"\n' >bounded
chmod +x bounded
refused() { # name, pattern, command...: status 1 and one line
    name=$1 pattern=$2
    shift 2
    expect_fail "$name" 1 "$pattern" out.bad ./bounded "$@"
}

# ---------------------------------------------------------------- what is no photograph
make_file() { "$mkhostile" "$1" "$2" || not_ok "$2" "cannot be made"; }
make_file iff evil.jpg
make_file video film.png
make_file fits sky.tif
make_file softimage old.pic
make_file psd big.psd
make_file dpx big.dpx
printf 'hello' >a.null
printf '%%PDF-1.4\n' >doc.jpg
printf 'GIF89a\1\0\1\0\0\0\0;' >a.gif
printf 'PK\3\4zip' >all.tif
for case in 'evil.jpg:an IFF image' 'film.png:a video' 'sky.tif:a FITS file' 'old.pic:a Softimage picture' \
    'big.psd:a Photoshop document' 'big.dpx:a DPX frame' 'doc.jpg:a PDF document' 'a.gif:a GIF image' \
    'all.tif:a ZIP archive'; do
    file=${case%%:*} what=${case#*:}
    refused "$file is not read" "$file: not a readable image but $what.*; expected a photograph" \
        "$RELUME" compare "$file" "$file"
done
refused "a.null is not read" 'a.null: not a readable image; expected .*--any-format' \
    "$RELUME" compare a.null a.null
expect_fail "a folder is no picture" 1 'empty file or folder' - "$RELUME" compare . .
mkfifo pipe
expect_fail "a pipe is not waited for" 1 'empty file or folder' - timeout 10 "$RELUME" compare pipe pipe

# ---------------------------------------------------------------- read all the same, in the helper
refused "Softimage crashes its reader, not relume" 'old.pic: its reader crashed' \
    "$RELUME" compare old.pic old.pic --any-format
refused "IFF by any format" 'evil.jpg: ' "$RELUME" compare evil.jpg evil.jpg --any-format
refused "FITS by any format" 'sky.tif: ' "$RELUME" compare sky.tif sky.tif --any-format
refused "a video by any format" 'film.png: ' "$RELUME" compare film.png film.png --any-format
refused "a.null by any format" 'a.null: .*no format' "$RELUME" compare a.null a.null --any-format
refused "PSD of 626 bytes" 'claims 30000 x 30000 .*in 626 bytes' "$RELUME" compare big.psd big.psd --any-format
refused "DPX of 7 kB" 'claims 30000 x 30000' "$RELUME" compare big.dpx big.dpx --any-format

# ---------------------------------------------------------------- headers that promise too much
make_file jpeg big.jpg
"$mkimage" bigpng big.png 30000 30000
"$mkimage" bigexr big.exr 30000 30000
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20000 +X 20000\n' >big.hdr
printf 'P6\n20000 20000\n255\n' >big.ppm
for file in big.jpg big.png big.exr big.hdr big.ppm; do
    refused "$file" "$file: (claims [0-9]+ x [0-9]+ .*fill memory|not a readable image|truncated)" "$RELUME" compare "$file" "$file"
done

# ---------------------------------------------------------------- limits that people give
"$sphere" cap --size 64 --lights 9 || not_ok "a capture" "cannot be made"
image=$(find cap -name "*.exr" | head -n 1)
expect_fail "--max-pixels" 1 "in all \\(--max-pixels\\)" - "$RELUME" compare "$image" "$image" --max-pixels 1000
expect_fail "--max-memory" 1 "max-memory" - "$RELUME" compare "$image" "$image" --max-memory 1k
expect_fail "a size that is none" 2 "--max-memory: expected a size" - \
    "$RELUME" compare "$image" "$image" --max-memory lots
expect_fail "limits reach captures" 1 "in all \\(--max-pixels\\)" c.exr "$RELUME" encode cap -o c.exr --max-pixels 1000
"$RELUME" encode cap -o c.exr -q || not_ok "a file" "cannot be made"
expect_fail "limits reach relume files" 1 "in all \\(--max-pixels\\)" - "$RELUME" info c.exr --max-pixels 1000
expect_fail "memory of relume files" 1 "max-memory" - "$RELUME" info c.exr --max-memory 1k
expect_ok "limits that fit" - "$RELUME" compare "$image" "$image" --max-pixels 1M --max-memory 100M

# ---------------------------------------------------------------- tiles by rows
# 6 pictures of 16 megapixels: as floats of whole pictures 1.2 GB beside what encoding takes.
make_file tiles tile.tif
lp() { # a capture of the file, six times
    echo 6
    for place in '0 0 1' '.5 0 .9' '0 .5 .9' '-.5 0 .9' '0 -.5 .9' '.4 .4 .8'; do
        echo "tile$((n = n + 1)).tif $place"
        ln -sf tile.tif "tile$n.tif"
    done
}
n=0
lp >tiles.lp
expect_ok "tiles are read by rows" 'are the same photograph' env KB=1200000 ./bounded "$RELUME" encode tiles.lp -o tiles.exr --basis ptm -q --threads 2

# ---------------------------------------------------------------- channels that are no colour
for case in 'exr-z:Z' 'exr-rg:R, G' 'exr-xyz:X, Y, Z' 'exr-100:c00, .*100 channels.'; do
    make_file "${case%%:*}" odd.exr
    refused "channels ${case%%:*}" "odd.exr: has no colour channels, only ${case#*:}; expected R, G, B or Y" \
        "$RELUME" compare odd.exr odd.exr
done

# ---------------------------------------------------------------- models
make_file collada round.dae
make_file gltf many.gltf
make_file far far.obj
refused "COLLADA that goes round" 'round.dae: .*its reader crashed' \
    "$RELUME" synth bust -o out.bad --size 16 --lights 4 -q --mesh round.dae
refused "glTF of 20 million vertices in 88 kB" 'many.gltf: .*memory' \
    "$RELUME" synth bust -o out.bad --size 16 --lights 4 -q --max-memory 700M --mesh many.gltf
refused "a vertex farther than Embree can see" 'far.obj: a vertex .*1e18' \
    "$RELUME" synth bust -o out.bad --size 16 --lights 4 -q --mesh far.obj

# ---------------------------------------------------------------- the next one goes on
# The lights' pictures are opened one after the other: the reader of the third crashes.
"$mkimage" tiff 8 3 . "$image" && mv "$(basename "$image")" good.tif
expect_ok "a good file" - ./bounded "$RELUME" compare good.tif good.tif
cp old.pic bad.tif
refused "a good file, then a bad one" 'bad.tif: its reader crashed' \
    "$RELUME" compare good.tif bad.tif --any-format
helpers_of_mark() { # how many helpers run that have our mark in their environment
    for p in /proc/[0-9]*; do
        [ "$(tr '\0' ' ' <"$p/cmdline" 2>/dev/null)" = "relume-helper " ] &&
            grep -q "RELUME_TEST_MARK=$$" "$p/environ" && echo x
    done 2>/dev/null | wc -l
}
RELUME_TEST_MARK=$$ "$RELUME" compare good.tif good.tif >out.txt
for _ in 1 2 3 4 5 6 7 8 9 10; do
    [ "$(helpers_of_mark)" = 0 ] && break
    sleep 0.2
done
check "helpers end with the tool" test "$(helpers_of_mark)" = 0

# ---------------------------------------------------------------- readers that misbehave
# A module in place of OpenImageIO does what the file's name says. Files share a process with those
# that are open beside them, and blame goes to the right one. Time: ulimit -t bounds what the helper
# allows itself, which would be ten seconds.
mkdir odd odd/lib && cp good.tif odd/good.tif
for name in loop rows sleep nap hide crash memory; do cp good.tif odd/$name.tif; done
if why=$(${CC:-gcc} -std=c11 -shared -fPIC -I"$TOP/include" -I"$TOP/src" -o odd/lib/librelume-oiio.so.0 \
    "$TOP/tests/tools/preload/odd_reader.c" 2>&1); then
    odd() { # status, pattern, command...
        status=$1 pattern=$2
        shift 2
        expect_fail "odd reader: $pattern" "$status" "$pattern" out.bad \
            env LD_LIBRARY_PATH="$PWD/odd/lib" timeout -k 1 20 "$@"
    }
    # A program that never answers, not even what it is asked before it reads; sleep takes no processor time.
    mkdir deaf && cp "$RELUME" deaf/ && printf '#!/bin/sh\nexec sleep 300\n' >deaf/relume-helper && chmod +x deaf/relume-helper
    { status=0
      timeout -k 1 50 sh -c 'ulimit -t 1; exec "$@"' sh deaf/relume compare good.tif good.tif || status=$?
      echo $status; } >deaf.txt 2>&1 &
    # By the clock nobody waits longer than ten times the processor time that there is.
    asleep() { # name
        status=0
        { LD_LIBRARY_PATH="$PWD/odd/lib" timeout -k 1 50 \
            sh -c 'ulimit -t 1; exec "$@"' sh "$RELUME" compare odd/good.tif odd/$1.tif || status=$?; } >$1.txt 2>&1
        echo $status >>$1.txt
    }
    case $BUILD in
    *asan* | *tsan*) skip 'readers that sleep' 'sanitizers take time of their own' ;;
    *)
        for name in sleep nap hide; do asleep $name & done
        ;;
    esac
    expect_ok "the odd reader reads" - env LD_LIBRARY_PATH="$PWD/odd/lib" \
        "$RELUME" compare odd/good.tif odd/good.tif
    odd 1 'odd/crash.tif: its reader crashed' "$RELUME" compare odd/good.tif odd/crash.tif
    # more lights than processes: the one that crashes shares its process with others
    n=0
    {
        echo 6
        for light in good crash good good good good; do
            n=$((n + 1))
            cp odd/$light.tif "odd/$light-$n.tif"
            echo "$light-$n.tif $(echo '0 0 1:.5 0 .9:0 .5 .9:-.5 0 .9:0 -.5 .9:.4 .4 .8' | cut -d : -f $n)"
        done
    } >odd/crash.lp
    odd 1 'crash-2.tif.*: its reader crashed' "$RELUME" encode odd/crash.lp -o out.exr --basis ptm
    case $BUILD in
    *asan* | *tsan*) skip 'readers that take memory and time' 'sanitizers take their own' ;;
    *)
        odd 1 'odd/loop.tif: reading it takes too long' \
            sh -c "ulimit -t 2; exec \"\$@\"" sh "$RELUME" compare odd/good.tif odd/loop.tif
        odd 1 'odd/rows.tif: .*reading it takes too long' \
            sh -c "ulimit -t 2; exec \"\$@\"" sh "$RELUME" compare odd/good.tif odd/rows.tif
        odd 1 'odd/memory.tif: its reader needs more memory than a file of its size should' \
            "$RELUME" compare odd/memory.tif odd/good.tif
        odd 1 'odd/memory.tif: its reader needs more memory than it may have .--max-memory' \
            "$RELUME" compare odd/memory.tif odd/good.tif --max-memory 64M
        odd 3 'out of memory' \
            sh -c "ulimit -v 300000; exec \"\$@\"" sh "$RELUME" compare odd/memory.tif odd/good.tif
        wait
        for name in sleep nap hide; do
            case $name in hide) why='reader crashed (no answer)' ;; *) why='reader does not answer' ;; esac
            check "odd reader: $name" test "$(grep -c "odd/$name.tif: .*its $why" $name.txt) $(cat $name.txt | wc -l) $(tail -n 1 $name.txt)" = '1 2 1'
        done
        ;;
    esac
else
    not_ok 'the odd reader' "$why"
fi

wait
check "a helper that never answers is given up" grep -q 'good.tif: the module for image formats cannot be loaded; relume-helper does not answer' deaf.txt
check "as the machine's fault" test "$(tail -n 1 deaf.txt)" = 3

# ---------------------------------------------------------------- work that asks nobody
# A helper that never answers acts as any loop of a library: SIGTERM must do, without SIGKILL.
mkdir stuck && cp "$RELUME" "$VIEWER" stuck/
printf '#!/bin/sh\nexec sleep 20\n' >stuck/relume-helper
chmod +x stuck/relume-helper
timeout --foreground -k 10 1 stuck/relume compare good.tif good.tif >out.txt 2>err.txt
check "SIGTERM ends what waits for ever" test $? = 124
check "it says so" grep -qx 'relume: interrupted' err.txt
timeout --foreground -k 10 1 stuck/relume-view good.tif --offscreen out.png >out.txt 2>err.txt
check "SIGTERM ends a viewer that waits for ever" test $? = 124
check "the viewer says so" grep -qx 'relume-view: interrupted' err.txt
finish
