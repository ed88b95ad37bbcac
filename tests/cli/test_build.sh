#!/bin/sh
# The build itself: nothing is rebuilt when nothing changed, a touched header rebuilds, and the
# layer rules hold for this tree and would notice if they did not.
. "$(dirname "$0")/lib.sh"
unset MAKEFLAGS
CC=${CC:-gcc}
make -s -C "$TOP" config=$config all >make.txt 2>&1 || not_ok "make" "$(tail -n 5 make.txt)"
if make -q -C "$TOP" config=$config all >make.txt 2>&1; then
    ok "nothing is rebuilt when nothing changed"
else
    not_ok "nothing is rebuilt when nothing changed" \
        "$(make -n -C "$TOP" config=$config all 2>&1 | head -n 5)"
fi
# -W: as if the file had just changed
if make -q -W include/relume/pack.h -C "$TOP" config=$config all >make.txt 2>&1; then
    not_ok "a changed header is noticed" "make -q says that all is up to date"
else
    ok "a changed header is noticed"
fi
if make -C "$TOP" config=fast all >make.txt 2>&1; then
    not_ok "an unknown config is refused" "status 0"
else
    check "an unknown config is refused" grep -q "expected release, debug, coverage, asan, tsan, fuzzer or msan" make.txt
fi

# On a fresh machine the compiler comes with make deps, after this file was read.
if [ "$(uname -m)" = x86_64 ]; then
    check "kernels of AVX2 are built where no compiler is yet" sh -c 'make -pn -C "$TOP" CC=nosuch 2>/dev/null | grep -q "^AVX2 := -mavx2"'
fi

# ---------------------------------------------------------------- WebAssembly in the tree
for module in core open; do
    if (cd "$TOP" && scripts/web-sources.sh --check web/$module/relume-$module.wasm) >sums.txt 2>&1; then
        ok "web/$module is made of the sources in the tree"
    else
        not_ok "web/$module is made of the sources in the tree" "run 'make web' and commit what it makes; $(head -n 5 sums.txt)"
    fi
done

# ---------------------------------------------------------------- hardened and reproducible
# reads FILE OPTION PATTERN: `readelf OPTION FILE` has a line that matches
reads() { readelf "$2" "$1" 2>/dev/null | grep -qE -e "$3"; }
for f in relume relume-view librelume.so librelume-oiio.so.0 librelume-assimp.so.0; do
    check "$f: read-only relocations" reads "$BUILD/$f" -lW GNU_RELRO
    check "$f: bound at start" reads "$BUILD/$f" -dW 'NOW'
    if [ $config = release ]; then
        check "$f: guarded stack" reads "$BUILD/$f" -sW '__stack_chk_fail'
        case $f in *.so.*) ;; *) check "$f: checked copies" reads "$BUILD/$f" -sW '__(memcpy|snprintf|fprintf)_chk' ;; esac
    fi
done
# What differs between two builds of one tree is where they were made; no file may show that.
for f in relume relume-view librelume.so librelume.a; do
    if grep -qF "$TOP/" "$BUILD/$f"; then
        not_ok "$f does not depend on where it was built" "it holds $TOP"
    else
        ok "$f does not depend on where it was built"
    fi
done

# ---------------------------------------------------------------- stacks
cp -r "$TOP/Makefile" "$TOP/make" "$TOP/include" "$TOP/scripts" . && mkdir -p src/core/base
for bytes in 90000 100000; do
    echo "int deep(int (*f)(char *)); int deep(int (*f)(char *)) { char room[$bytes]; return f(room) + room[1]; }" >src/core/base/deep$bytes.c
    make -s config=release build/obj/src/core/base/deep$bytes.o >make.txt 2>&1 && echo $bytes >>fits.txt
done
check "a function takes no more than 96 kB of stack" grep -q 'frame-larger-than' make.txt
check "one that takes less is built" grep -qx 90000 fits.txt

# ---------------------------------------------------------------- symbols
nm -D --defined-only "$BUILD/librelume.so" | awk '{ print $3 }' >exported.txt
check "the library exports something" test "$(wc -l <exported.txt)" -gt 300
alien=$(grep -v '^relume_' exported.txt || true)
[ -z "$alien" ] && ok "the library exports names that begin with relume_ alone" ||
    not_ok "the library exports names that begin with relume_ alone" "found: $(echo $alien)"
# what headers declare is exported, and nothing else
cat "$TOP"/include/relume/*.h "$TOP"/include/relume/*/*.h >headers.txt
hidden=$(grep -oE '^relume_[a-z0-9_]+$' exported.txt | while read -r name; do grep -qw "$name" headers.txt || echo "$name"; done)
[ -z "$hidden" ] && ok "what the library exports stands in a public header" ||
    not_ok "what the library exports stands in a public header" "found: $(echo $hidden)"

# ---------------------------------------------------------------- layers
check "layers hold" "$TOP/scripts/layers.sh"
"$TOP/scripts/layers.sh" --table >table.txt
sed -n '/^| wing | rooms/,/^Each external/p' "$TOP/docs/architecture.md" | sed '$d' | sed '$d' >documented.txt
same "docs/architecture.md has the tables of scripts/layers.sh" table.txt documented.txt
mkdir tree
(cd "$TOP" && tar cf - --exclude=__pycache__ src include viewer scripts samples tests Makefile make) |
    (cd tree && tar xf -)
check "layers hold in a copy" tree/scripts/layers.sh

# plant NAME FILE LINE PATTERN: with LINE added to FILE, layers fails and names the file
plant() {
    cp "tree/$2" before
    echo "$3" >>"tree/$2"
    if tree/scripts/layers.sh >layers.txt 2>&1; then
        not_ok "$1" "'$3' in $2 passes"
    elif grep -qE "layers: $2 includes $4" layers.txt; then
        ok "$1"
    else
        not_ok "$1" "layers says: $(head -n 3 layers.txt)"
    fi
    cp before "tree/$2"
}
# symbols NAME CODE OBJECT DEFINES PATTERN: an object of that name made of CODE, beside one that defines what it calls, is refused
symbols() {
    mkdir -p "obj/src/${3%/*}" "obj/src/${4%/*}"
    echo "int other(void); $2" | $CC -x c -c -o "obj/src/$3" -
    echo 'int other(void) { return 1; }' | $CC -x c -c -o "obj/src/$4" -
    if "$TOP/scripts/layers.sh" --symbols "$PWD/obj/src/$3" "$PWD/obj/src/$4" >layers.txt 2>&1; then
        not_ok "$1" "$3 may call $4"
    else
        check "$1" grep -q "$5" layers.txt
    fi
    rm -r obj
}
call='int call(void) { return other(); }'
symbols "a function of a wing above, without its header" "$call" core/math/a.o image/image/b.o \
    '^layers: core/math/a.o needs other of image/image/b.o, a wing above$'
symbols "a function of a program" "$call" site/publish/a.o cli/measure/b.o '^layers: site/publish/a.o needs other of cli/measure/b.o'
plant "a header of a wing above" src/core/math/sh.c '#include "image/image/image.h"' image/image/image.h
mkdir -p obj/src/core/base obj/src/core/math
echo 'int there(void); int back(void) { return 1; } int go(void) { return there(); }' | $CC -x c -c -o obj/src/core/base/a.o -
echo 'int back(void); int there(void) { return back(); }' | $CC -x c -c -o obj/src/core/math/b.o -
check "rooms that call each other" sh -c \
    '! "$TOP/scripts/layers.sh" --symbols "$PWD/obj/src/core/base/a.o" "$PWD/obj/src/core/math/b.o" 2>layers.txt && grep -q "rooms that need each other: core/base, core/math" layers.txt'
check "a function of a wing below is allowed" sh -c \
    'mkdir -p obj/src/image/image && mv obj/src/core/base/a.o obj/src/image/image/a.o &&
     echo "int back(void); int there(void) { return 0; }" | '"$CC"' -x c -c -o obj/src/core/math/b.o - &&
     "$TOP/scripts/layers.sh" --symbols "$PWD/obj/src/image/image/a.o" "$PWD/obj/src/core/math/b.o"'
rm -r obj
plant "a private header of a stranger" src/cli/commands/cmd_info.c '#include "format/pack/format.h"' format/pack/format.h
plant "a private header of the tool in the viewer" viewer/app/app.c '#include "cli/plot.h"' cli/plot.h
plant "a header of a room above" viewer/gl/gl.c '#include "draw/draw.h"' draw/draw.h
plant "a private header in a sample" samples/minimal.c '#include "core/base/log.h"' core/base/log.h
plant "a public header from above" src/format/coder/fit.c '#include <relume/frame.h>' '<relume/frame.h>'
plant "an extension in a core header" include/relume/pack.h '#include <relume/format/coder.h>' '<relume/format/coder.h>, an extension'
plant "an external library out of place" src/format/pack/reader.c '#include <openexr.h>' '<openexr'
plant "linear algebra out of place" src/format/coder/project.c '#include <Eigen/Dense>' '<Eigen'
plant "intrinsics out of place" src/relight/light/relight.c '#include <immintrin.h>' '<immintrin'
cp tree/src/core/base/tree.h before
echo '#include "core/math/hull.h"' >>tree/src/core/base/tree.h
check "rooms that include each other" sh -c '! tree/scripts/layers.sh 2>layers.txt && grep -q "rooms that include each other.*core/base" layers.txt'
cp before tree/src/core/base/tree.h
cp tree/viewer/draw/draw.c before
echo 'void f(const struct app *app);' >>tree/viewer/draw/draw.c
check "a drawer that takes the app" sh -c '! tree/scripts/layers.sh 2>layers.txt && grep -q "expected struct frame_request: viewer/draw/draw.c" layers.txt'
cp before tree/viewer/draw/draw.c
cp tree/src/material/btf/npy.h before
echo '#include "material/btf/btf.h"' >>tree/src/material/btf/npy.h
check "files that include each other" sh -c '! tree/scripts/layers.sh 2>layers.txt && grep -q "include each other.*src/material/btf/npy" layers.txt'
cp before tree/src/material/btf/npy.h
cp tree/src/cli/commands/cmd_info.c before
echo 'void f(void) { fopen("x", "w"); }' >>tree/src/cli/commands/cmd_info.c
check "a file that opens files itself" sh -c '! tree/scripts/layers.sh 2>layers.txt && grep -q "itself; expected core/base/inputs.h.*src/cli/commands/cmd_info.c" layers.txt'
cp before tree/src/cli/commands/cmd_info.c
cp tree/src/core/math/sh.c before
echo 'void f(void *p) { free(p); }' >>tree/src/core/math/sh.c
check "a file that frees by itself" sh -c '! tree/scripts/layers.sh 2>layers.txt && grep -q "frees itself; expected mem_array.*src/core/math/sh.c" layers.txt'
cp before tree/src/core/math/sh.c

# ---------------------------------------------------------------- the sources in numbers
if [ $config = release ]; then
    "$TOP/scripts/metrics.sh" "$BUILD" >house.txt 2>err.txt
    check "make metrics says all it counts" sh -c '! grep -qE "[|] *[|]$" house.txt && [ ! -s err.txt ] && grep -q "^| lines of src and viewer.* | [0-9]* |$" house.txt'
    "$TOP/scripts/metrics.sh" --state "$BUILD" | grep -v '^src/cli/mpi/' >state.txt
    sed '1,/^## State of the process/d' "$TOP/docs/architecture.md" |
        awk -F ' [|] |^[|] ' '/^[|] (src|viewer)/ && $2 !~ /cli.mpi/ {
            n = split($3, name, ", ")
            for (i = 1; i <= n; i++)
                print $2 ": " name[i]
        }' | sed 's/[.]c[p]*: /: /' | LC_ALL=C sort >listed.txt
    LC_ALL=C sort -o state.txt state.txt
    if changed=$(diff listed.txt state.txt); then ok "architecture.md lists all variables that outlive a call"; else
        not_ok "architecture.md lists all variables that outlive a call" "$changed"
    fi
fi
printf '%s\n' 'int twice(int a);' 'int twice(int a)' '{' '    a += 1;' '    a *= 2;' '    return a;' '}' >copied.c
cat copied.c >>tree/src/core/math/sh.c
cat copied.c >>tree/src/core/math/hsh.c
check "a function that stands twice is counted" sh -c 'tree/scripts/metrics.sh --copies | grep -qx "src/core/math/sh.c: twice is src/core/math/hsh.c: twice"'
cat >>tree/src/core/math/sh.c <<'END'
static int small(int a)
{
    return a;
}
int planted(void);
int planted(void)
{
    return small(1);
}
END
check "a small function called once is counted" sh -c 'tree/scripts/metrics.sh --small | grep -qx "src/core/math/sh.c: small"'
sed -i 's/return small(1);/return small(1) + small(2);/' tree/src/core/math/sh.c
check "one called twice is not" sh -c '! tree/scripts/metrics.sh --small | grep -qx "src/core/math/sh.c: small"'
check "layers hold again" tree/scripts/layers.sh
finish
