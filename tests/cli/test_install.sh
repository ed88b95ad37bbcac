#!/bin/sh
# What `make install` leaves is complete: a program builds against it by pkg-config and runs, every
# header stands alone, every command has a manual page and an example.
. "$(dirname "$0")/lib.sh"
prefix=$work/prefix
case $BUILD in
*/asan) sanitizer=-fsanitize=address,undefined ;;
*/tsan) sanitizer=-fsanitize=thread ;;
*) sanitizer= ;;
esac
CC=${CC:-gcc} CXX=${CXX:-g++}

if ! make -s -C "$TOP" config=$config install PREFIX="$prefix" >install.txt 2>&1; then
    not_ok install "$(tail -n 5 install.txt)"
    exit 1
fi
version=$(sed -n 's/^#define RELUME_VERSION "\(.*\)"/\1/p' "$TOP/include/relume/base.h")
for file in bin/relume bin/relume-view lib/librelume.a lib/librelume.so lib/librelume.so.${version%%.*} \
    lib/pkgconfig/relume.pc share/doc/relume/LICENSE share/bash-completion/completions/relume \
    share/applications/relume-view.desktop share/mime/packages/relume.xml share/icons/hicolor/scalable/apps/relume.svg \
    share/icons/hicolor/128x128/apps/relume.png share/metainfo/org.relume.View.metainfo.xml; do
    check "installs $file" test -s "$prefix/$file"
done
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig"
check "pkg-config knows the version" test "$(pkg-config --modversion relume)" = "$version"
check "the module for images is installed" test -s "$prefix/lib/librelume-oiio.so.${version%%.*}"
check "the module for models is installed" test -s "$prefix/lib/librelume-assimp.so.${version%%.*}"
check "the helper is installed" test -x "$prefix/lib/relume-helper"
check "the installed tool runs" test "$("$prefix/bin/relume" --version)" = "relume $version"

# ---------------------------------------------------------------- a program of the library's user
"$RELUME" synth box -o box --size 32 --lights 9 --samples 1 -q &&
    "$RELUME" encode box -o box.exr -q || not_ok "a small file" "cannot be made"

build_and_run() { # name, libraries
    if why=$($CC -std=c11 -Wall -Wextra -Werror $sanitizer "$TOP/samples/minimal.c" \
        $(pkg-config --cflags relume) $2 -o "$1" 2>&1); then
        ok "minimal.c builds, $1"
        check "minimal.c runs, $1" env LD_LIBRARY_PATH="$prefix/lib" "./$1" box.exr "$1.png"
        check "minimal.c writes its picture, $1" test -s "$1.png"
    else
        not_ok "minimal.c builds, $1" "$why"
    fi
}
build_and_run shared "$(pkg-config --libs relume)"
build_and_run static "$(pkg-config --static --libs relume | sed 's/-lrelume/-l:librelume.a/')"
same "shared and static give one picture" shared.png static.png
"$RELUME" relight box.exr -o tool.png --light "dir 1 0.5 1" -q
same "minimal.c does what relight does" shared.png tool.png
if ldd shared | grep -q "librelume.so.${version%%.*} =>"; then
    ok "programs ask for the versioned library"
else
    not_ok "programs ask for the versioned library" "$(ldd shared | grep relume)"
fi
if LD_LIBRARY_PATH="$prefix/lib" ./shared nothing.exr out.png 2>err.txt; then
    not_ok "minimal.c says what is wrong" "status 0"
else
    check "minimal.c says what is wrong" grep -q "nothing.exr: no such file" err.txt
fi

if why=$($CC -std=c11 -Wall -Wextra -Werror $sanitizer "$TOP/samples/memory.c" \
    $(pkg-config --cflags --libs relume) -lm -o memory 2>&1); then
    said=$(cd / && env LD_LIBRARY_PATH="$prefix/lib" "$work/memory") || said="status $?: $said"
    # four harmonics, fitted to lights above the table alone, are 0.1 % of white off there
    if echo "$said" | awk '/^[0-9]+ bytes encoded, a PNG of [0-9]+ bytes, an RTI of [0-9]+; the middle is / {
        got = $16 + 0; want = $NF + 0; good = want > 0.5 && got - want < 0.01 && want - got < 0.01 }
        END { exit !good }'; then
        ok "memory.c relights without a file"
    else
        not_ok "memory.c relights without a file" "$said"
    fi
else
    not_ok "memory.c builds" "$why"
fi

sample() { # name, libraries
    if why=$($CC -std=c11 -Wall -Wextra -Werror $sanitizer "$TOP/samples/$1.c" \
        $(pkg-config --cflags --libs relume) ${2:-} -o "$1" 2>&1); then ok "$1.c builds"; else not_ok "$1.c builds" "$why"; fi
}
sample batch
cp box.exr second.exr
check "batch.c relights every file" env LD_LIBRARY_PATH="$prefix/lib" ./batch lit 1 0.5 1 box.exr second.exr
same "batch.c does what relight does" second-lit.png tool.png
says() { # name, status, words, command...: a sample ends so and says so
    name=$1 status=$2 words=$3
    shift 3
    LD_LIBRARY_PATH="$prefix/lib" "$@" >said.txt 2>&1 && got=0 || got=$?
    if [ $got = "$status" ] && grep -q "$words" said.txt; then ok "$name"; else not_ok "$name" "status $got, $(cat said.txt)"; fi
}
says "batch.c goes on after a file that is none" 1 'box-lit.png' ./batch lit 1 0.5 1 none.exr box.exr
says "batch.c says which file is none" 1 'none.exr: no such file' ./batch lit 1 0.5 1 none.exr box.exr
sample ten_calls
"$RELUME" synth box -o capture --size 32 --lights 20 --hemisphere --samples 1 -q
says "ten_calls.c does ten jobs" 0 '20 lights, PSNR [3-9][0-9]' ./ten_calls capture out
for made in out.exr out.png out.rti out-site/index.html; do check "ten_calls.c makes $made" test -s $made; done
"$RELUME" encode capture -o plain.exr -q
same "ten_calls.c encodes as the tool does" out.exr plain.exr
"$RELUME" relight plain.exr -o plain.png --light "dir 1 0.5 1 rgb 1 0.9 0.8" -q
same "ten_calls.c draws as the tool does" out.png plain.png
says "ten_calls.c says what is wrong" 1 'nothing: cannot be opened' ./ten_calls nothing out
check "ten_calls.c needs the core alone" test "$(grep -c '#include <relume/' "$TOP/samples/ten_calls.c") $(grep -c '#include <relume/relume.h>' "$TOP/samples/ten_calls.c")" = "1 1"
sed -n '/^```c$/,/^```$/p' "$TOP/docs/api-in-ten-calls.md" | sed '1d;$d' >shown.c
same "api-in-ten-calls.md shows ten_calls.c" shown.c "$TOP/samples/ten_calls.c"
if pkg-config --exists glfw3 gl; then
    sample viewer "$(pkg-config --libs glfw3 gl) -lm"
    if [ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
        says "viewer.c without a display says so" 3 'no window can be opened' ./viewer box.exr
    fi
else
    echo "skipped: viewer.c (no GLFW or OpenGL)"
fi

# ---------------------------------------------------------------- the helper, and none
printf 'P6 2 2 255 abcdefabcdef' >small.ppm
check "the installed tool finds its helper" "$prefix/bin/relume" compare small.ppm small.ppm
mkdir alone && cp "$RELUME" alone/
check "a tool without its module shows relume files" alone/relume relight box.exr -o alone.png
expect_fail "a tool without its helper says so" 3 'relume-helper is missing beside the library' - \
    alone/relume compare small.ppm small.ppm
expect_fail "a tool without its module says so" 3 'module for image formats cannot be loaded' none.jpg \
    alone/relume relight box.exr -o none.jpg

# ---------------------------------------------------------------- headers
for name in $(cd "$prefix/include/relume" && find . -name '*.h' | sed 's|^./||' | LC_ALL=C sort); do
    echo "#include <relume/$name>" >alone.c
    cp alone.c alone.cpp
    check "$name alone, C11" $CC -std=c11 -Wall -Wextra -Wpedantic -Werror -fsyntax-only \
        "-I$prefix/include" alone.c
    check "$name alone, C++17" $CXX -std=c++17 -Wall -Wextra -Wpedantic -Werror -fsyntax-only \
        "-I$prefix/include" alone.cpp
done

# ---------------------------------------------------------------- manual pages, help, completion
man=$prefix/share/man/man1
commands=$("$RELUME" --help | sed -n 's/^  \([a-z]*\) .*/\1/p')
[ "$(echo "$commands" | wc -w)" -ge 8 ] || not_ok "the overview lists commands" "$commands"
has_sections() { # page
    for section in NAME SYNOPSIS DESCRIPTION OPTIONS EXAMPLE "EXIT STATUS"; do
        grep -q "^.SH $section" "$1" || { echo "no $section"; return 1; }
    done
}
has_example() { "$@" --help | sed -n '/^example:/,$p' | grep -q "^  relume"; }
tasks=$("$RELUME" btf --help | sed -n '/^tasks;/,/^$/s/^  \([a-z]*\) .*/\1/p')
[ "$(echo "$tasks" | wc -w)" -eq 11 ] || not_ok "btf lists its tasks" "$tasks"
for page in relume relume-view $(for c in $commands; do echo "relume-$c"; done) $(for t in $tasks; do echo "relume-btf-$t"; done); do
    check "$page.1 has every section" has_sections "$man/$page.1"
done
for c in $commands; do
    check "$c --help has an example" has_example "$RELUME" "$c"
done
for t in $tasks; do
    check "btf $t --help has an example" has_example "$RELUME" btf "$t"
done
check "relume-view --help has an example" has_example "$VIEWER"
for option in $("$RELUME" encode --help | sed -n 's/^  \(--[a-z-]*\).*/\1/p'); do
    check "relume-encode.1 has $option" grep -q -- "$(echo "$option" | sed 's/-/\\\\-/g')" \
        "$man/relume-encode.1"
done
if command -v mandoc >/dev/null; then
    check "manual pages are well formed" mandoc -Tlint -W warning "$man"/*.1
else
    skip "manual pages are well formed" "mandoc is not installed"
fi

complete_words() { # words...: what completion offers after them
    bash -c '. "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
        "$(complete -p "$1" | sed "s/.*-F \([^ ]*\).*/\1/")"; echo "${COMPREPLY[*]}"' \
        bash "$prefix/share/bash-completion/completions/relume" "$@"
}
offers() { # expected, words...
    expected=$1
    shift
    found=$(complete_words "$@")
    [ "$found" = "$expected" ] || { echo "offers '$found', expected '$expected'"; return 1; }
}
if command -v bash >/dev/null; then
    check "completion of commands" offers "encode eval export" relume e
    check "completion of options" offers "--compression --coefficients --colour --codebook --codebook-start --commands" relume encode --co
    check "completion of values" offers "8 10 12 16 half log float" relume encode --bits ""
    check "completion of tasks" offers "render" relume btf re
    check "completion of a task's options" offers "--tiles --tile" relume btf tile --til
    check "completion of scenes" offers "teapot" relume synth te
    check "completion of the viewer" offers "--offscreen" relume-view --off
else
    skip completion "bash is not installed"
fi
finish
