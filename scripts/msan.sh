#!/bin/sh
# msan.sh [CONFIG-FOLDER]: the C libraries that relume reads files with, built for clang's MemorySanitizer from Debian's
# sources into build/msan/lib; then `make config=msan fuzzers` links the fuzz targets with them. Needs clang, cmake and a network.
# Nothing of the machine's own packages or lists is changed.
set -eu
out=$(realpath -m "${1:-build/msan}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out/lib" "$work/lists/partial"
cd "$work"
. /etc/os-release
echo "deb-src http://deb.debian.org/debian $VERSION_CODENAME main" >sources.list
apt="apt-get -qq -o Dir::Etc::sourcelist=$work/sources.list -o Dir::Etc::sourceparts=/dev/null -o Dir::State::lists=$work/lists"
$apt update
$apt source --download-only zlib jansson libpng1.6 libjpeg-turbo lcms2 openexr
for archive in *.orig.tar.*; do
    case $archive in *.asc) ;; *) tar xf "$archive" ;; esac
done

flags='-O1 -g1 -fPIC -w -fsanitize=memory -fsanitize-memory-track-origins -fno-omit-frame-pointer'
# library NAME FOLDER FLAGS FILE...
library() {
    name=$1 folder=$2 own=$3
    shift 3
    (cd "$folder" && for f in "$@"; do clang $flags $own -c "$f" -o "$(basename "$f" .c).o"; done && ar rcs "$out/lib/$name" ./*.o)
}
set_up() { (mkdir -p "$1/b" && cd "$1/b" && shift && cmake -DCMAKE_C_COMPILER=clang "$@" .. >/dev/null); }

zlib=$(echo zlib-*) png=$(echo libpng*-*/) jansson=$(echo jansson-*) lcms=$(ls -d lcms2-*/ Little-CMS-*/ 2>/dev/null | head -1)
exr=$(ls -d openexr-*/)src/lib/OpenEXRCore jpeg=$(ls -d libjpeg-turbo-*/)
library libz.a "$zlib" '-DHAVE_UNISTD_H -D_LARGEFILE64_SOURCE' $(cd "$zlib" && ls ./*.c | grep -v 'example\|minigzip')
cp "$png/scripts/pnglibconf.h.prebuilt" "$png/pnglibconf.h"
library libpng.a "$png" '-DPNG_HARDWARE_OPTIMIZATIONS=0 -DPNG_INTEL_SSE_OPT=0' $(cd "$png" && ls png*.c | grep -v pngtest)
set_up "$jansson" -DJANSSON_BUILD_DOCS=OFF -DJANSSON_EXAMPLES=OFF -DJANSSON_WITHOUT_TESTS=ON
library libjansson.a "$jansson/src" '-DHAVE_CONFIG_H -I../b/private_include -I../b/include' $(cd "$jansson/src" && ls ./*.c)
library liblcms2.a "$lcms" '-Iinclude -Isrc' $(cd "$lcms" && ls src/*.c)
library libOpenEXRCore.a "$exr" '-I. -I/usr/include/OpenEXR -I/usr/include/Imath' $(cd "$exr" && ls ./*.c)
set_up "$jpeg" -DWITH_SIMD=0 -DENABLE_SHARED=0
make -s -C "$jpeg/b" jpeg-static C_FLAGS="$flags" >/dev/null
cp "$jpeg/b/libjpeg.a" "$out/lib"
echo "built for MSan: $(ls "$out/lib" | tr '\n' ' ')"
