#!/bin/sh
# web-open.sh OUT.wasm: what opens dropped files in pages (web/open/open.c), the library's reader of relume files and, from
# Debian's sources, OpenEXR's C core, zlib and dav1d, compiled to WebAssembly. The sources and what is compiled of them stay in
# build/web/open. Needs emscripten, the headers of the build, and a network for the first time.
set -eu
out=$1
work=build/web/open
flags='-std=gnu11 -D_GNU_SOURCE -DNDEBUG -ffp-contract=off -ffunction-sections -fdata-sections'
sources=$PWD/$work/sources
mkdir -p "$sources/lists/partial"

if ! [ -e "$sources/done" ]; then
    (
        cd "$sources"
        . /etc/os-release
        echo "deb-src http://deb.debian.org/debian $VERSION_CODENAME main" >sources.list
        apt="apt-get -qq -o Dir::Etc::sourcelist=$sources/sources.list -o Dir::Etc::sourceparts=/dev/null -o Dir::State::lists=$sources/lists"
        $apt update
        $apt source --download-only zlib openexr dav1d
        for archive in *.orig.tar.*; do
            case $archive in *.asc) ;; *) tar xf "$archive" ;; esac
        done
        touch done
    )
fi
# dav1d without assembly, threads of its own or messages, for the 8 or 12 bits that planes have
dav1d=$(ls -d "$sources"/dav1d-*/)
dav1d=${dav1d%/}
mkdir -p "$work/dav1d"
cp /usr/include/dav1d/version.h "$work/dav1d"
{
    for zero in ARCH_AARCH64 ARCH_ARM ARCH_PPC64LE ARCH_X86 ARCH_X86_32 ARCH_X86_64 CONFIG_LOG ENDIANNESS_BIG HAVE_ASM; do
        echo "#define $zero 0"
    done
    for one in CONFIG_8BPC CONFIG_16BPC HAVE_CLOCK_GETTIME HAVE_POSIX_MEMALIGN HAVE_UNISTD_H; do
        echo "#define $one 1"
    done
} >"$work/config.new"
if cmp -s "$work/config.new" "$work/config.h"; then
    rm "$work/config.new"
else
    rm -f "$work"/dav1d*.o
    mv "$work/config.new" "$work/config.h"
fi
echo '#define DAV1D_VERSION "1.0.0"' >"$work/vcs_version.h"

exr=$(ls -d "$sources"/openexr-*/)src/lib/OpenEXRCore zlib=$(ls -d "$sources"/zlib-*/)
include="-I$exr -I/usr/include/OpenEXR -I/usr/include/Imath -I$zlib"

# compile FLAGS FILE...: those that are newer than what was made of them; the names of the objects, which end in `depth`
depth=
compile() {
    own=$1
    shift
    for file in "$@"; do
        object=$work/$(echo "${file#"$sources"/}" | tr / _)$depth.o
        [ "$object" -nt "$file" ] || emcc $flags $own $include -c "$file" -o "$object"
        echo "$object"
    done
}
of() { # FOLDER NAME...
    folder=$1
    shift
    for name in "$@"; do
        echo "$folder/$name.c"
    done
}

theirs=$(compile '-O2 -w' $(ls "$exr"/*.c | grep -v '/debug\.c') $(of "$zlib" adler32 compress crc32 deflate inffast inflate inftrees trees uncompr zutil))
theirs="$theirs $(compile "-O2 -w -I$dav1d -I$dav1d/include -I$work -I$work/dav1d" \
    $(ls "$dav1d"/src/*.c | grep -v '_tmpl\.c'))"
for depth in 8 16; do
    theirs="$theirs $(compile "-O2 -w -DBITDEPTH=$depth -I$dav1d -I$dav1d/include -I$work -I$work/dav1d" "$dav1d"/src/*_tmpl.c)"
done
depth=
# our own every time: headers may have changed
rm -f "$work"/src_* "$work"/web_*
own="-O2 -Wall -Wextra -Wno-unused-function -Iinclude -Isrc -DOPENS_FILES -I$dav1d/include -I$work -I$work/dav1d"
parts="web/open/open.c web/open/absent.c web/core/absent.c \
    $(of src/core/base arena beside called context_create cpu infile inputs inventory json_write log memory names printable scratch thread tree) \
    $(of src/core/math base64 gram hsh hull lanczos markup sh) \
    $(of src/image/image exr exr_sums image piz piz_decode response transfer) \
    $(of src/core/kernel dot_c kernels nearest_c psf_c turn_c unpack_c) \
    $(of src/format/coder basis_dct basis_dct_resampled basis_eigen basis_hsh basis_pca basis_ptm basis_sh basis_table codes coefficients \
        coder disc harmonics mesh sums zone) $(ls src/format/coder/interpolant_*.c) \
    $(of src/format/lossy av1_read disparity entropy lossy slopes) \
    $(of src/format/codebook book) $(of src/image/geometry camera geometry print) src/exchange/foreign/source.c \
    $(of src/format/pack format functions learnt read_books read_coded read_halved read_header read_mask read_parts read_slabs read_view reader words) \
    $(of src/site/publish functions layers levels published_json text)"
ours=$(compile "$own" $parts)
echo 'mergeInto(LibraryManager.library, { page_read: function () {} });' >"$work/page.js"
emcc -O2 $ours $theirs --js-library "$work/page.js" --no-entry -s STANDALONE_WASM=1 -s ALLOW_MEMORY_GROWTH=1 \
    -s INITIAL_MEMORY=16777216 -s TOTAL_STACK=1048576 -o "$out"
chmod 644 "$out"
emcc -MM $flags $own $include $parts | scripts/web-sources.sh "$out" scripts/web-open.sh
