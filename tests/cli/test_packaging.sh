#!/bin/sh
# What packages need: a tarball of the same bytes wherever it is made, files for desktops that their own
# tools accept, and lists of packages that agree with each other.
. "$(dirname "$0")/lib.sh"
version=$(sed -n 's/^#define RELUME_VERSION "\(.*\)"/\1/p' "$TOP/include/relume/base.h")
have() { command -v "$1" >/dev/null 2>&1; }

# ---------------------------------------------------------------- make dist, of a small tree
if have git && have xz; then
    mkdir -p tree/scripts tree/include/relume 'tree/a folder'
    cp "$TOP/scripts/dist.sh" tree/scripts/
    cp "$TOP/include/relume/base.h" tree/include/relume/
    echo text >'tree/a folder/a file'
    git -C tree init -q
    git -C tree add -A
    GIT_AUTHOR_DATE='2026-01-02T03:04:05Z' GIT_COMMITTER_DATE='2026-01-02T03:04:05Z' \
        git -C tree -c user.name=test -c user.email=test@test.example -c commit.gpgsign=false commit -qm made
    git clone -q tree other
    touch -d '2001-01-01' other/include/relume/base.h
    echo 'not of the commit' >other/new
    tree/scripts/dist.sh "$work/one" >said.txt 2>&1 || not_ok "make dist" "$(cat said.txt)"
    TZ=Asia/Tokyo LC_ALL=C other/scripts/dist.sh "$work/two" >said.txt 2>&1 || not_ok "make dist" "$(cat said.txt)"
    for file in relume-$version.tar.xz relume-$version.spdx SHA256SUMS; do
        same "$file has the same bytes elsewhere" one/$file two/$file
    done
    check "check sums hold" sh -c 'cd one && sha256sum -c SHA256SUMS'
    xz -dc one/relume-$version.tar.xz | tar tf - | grep -v '/$' | sed "s|^relume-$version/|./|" | LC_ALL=C sort >inside.txt
    sed -n 's/^FileName: //p' one/relume-$version.spdx | LC_ALL=C sort >listed.txt
    same "the SPDX list has every file of the tarball" inside.txt listed.txt
    sum=$(sha256sum 'tree/a folder/a file' | cut -c1-64)
    check "and its sum" sh -c "grep -A3 '^FileName: ./a folder/a file' one/relume-$version.spdx | grep -q 'SHA256: $sum'"
    rm -rf other/.git
    if other/scripts/dist.sh "$work/three" >said.txt 2>&1; then not_ok "dist without git says so" "status 0"; else
        check "dist without git says so" grep -q 'dist: no commit' said.txt
    fi
else
    skip "make dist" "no git or xz"
fi

# ---------------------------------------------------------------- desktops
if have desktop-file-validate; then
    check "the desktop file is valid" desktop-file-validate "$TOP/packaging/relume-view.desktop"
else
    skip "the desktop file is valid" "no desktop-file-validate"
fi
if have appstreamcli; then
    check "the AppStream metadata are valid" appstreamcli validate --no-net "$TOP/packaging/org.relume.View.metainfo.xml"
else
    skip "the AppStream metadata are valid" "no appstreamcli"
fi
check "AppStream knows this version" grep -q "<release version=\"$version\"" "$TOP/packaging/org.relume.View.metainfo.xml"
if have update-mime-database; then
    mkdir -p mime/packages && cp "$TOP/packaging/relume.xml" mime/packages/
    # that of the system must be there as well for image/x-exr, of which a relume file is one
    update-mime-database mime >said.txt 2>&1 || not_ok "the types of files are valid" "$(cat said.txt)"
    check "the types of files are valid" grep -q 'image/x-relume:\*.relume.exr' mime/globs
    check "a relume file is an OpenEXR file" grep -q 'image/x-relume image/x-exr' mime/subclasses
else
    skip "the types of files are valid" "no update-mime-database"
fi
# The magic of relume.xml: the first four bytes, and the attribute within the first 4096.
"$RELUME" synth box -o box --size 32 --lights 9 --samples 1 -q && "$RELUME" encode box -o box.exr -q
check "a file begins as its type says" sh -c "head -c 4096 box.exr | grep -qa 'relume.format' && head -c 4 box.exr | od -An -tx1 | grep -q '76 2f 31 01'"
for type in $(sed -n 's/^MimeType=//p' "$TOP/packaging/relume-view.desktop" | tr ';' ' '); do
    [ $type = image/x-exr ] || check "$type is described" grep -q "mime-type type=\"$type\"" "$TOP/packaging/relume.xml"
done

# ---------------------------------------------------------------- lists of packages
check "the Debian package has this version" grep -q "^relume ($version-[0-9]" "$TOP/debian/changelog"
sed -n '/^packages=/,/"$/p' "$TOP/scripts/deps.sh" | tr ' "=' '\n\n\n' | grep . | sort >deps.txt
sed -n '/^Build-Depends/,/^Standards/p' "$TOP/debian/control" | grep -o 'lib[a-z0-9.+-]*-dev\|zlib1g-dev' | sort >built.txt
missing=$(comm -13 deps.txt built.txt)
if [ -s built.txt ] && [ -z "$missing" ]; then ok "debian/control needs what scripts/deps.sh installs"; else
    not_ok "debian/control needs what scripts/deps.sh installs" "$missing"
fi
# what the build links, the image of the container has
words() { tr -d '\\' <"$TOP/Containerfile" | tr ' ' '\n'; }
for library in aom dav1d embree3 jansson jpeg lcms2 openexr openimageio assimp fftw3 cairo glfw osmesa png egl stb; do
    words | grep -q "^lib$library" || not_ok "the container has lib$library" "not in Containerfile"
done
if awk '/\\$/ { joined = 1; next } joined { joined = 0; next } /^#/ || /^$/ { next }
    !/^(FROM|COPY|WORKDIR|RUN|USER|ENTRYPOINT|CMD) / { exit 1 }' "$TOP/Containerfile"; then
    ok "the Containerfile has instructions alone"
else
    not_ok "the Containerfile has instructions alone" "another line"
fi
finish
