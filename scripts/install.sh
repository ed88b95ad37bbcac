#!/bin/sh
# Install a build: install.sh BUILD DESTPREFIX PREFIX [LIBDIR]. Files go below DESTPREFIX; PREFIX is
# where they will be found later (different when a package is made); libraries lie in its LIBDIR.
set -eu
build=$1 dest=$2 prefix=$3 lib=${4:-lib}
here=$(cd "$(dirname "$0")/.." && pwd)
version=$(sed -n 's/^#define RELUME_VERSION "\(.*\)"/\1/p' "$here/include/relume/base.h")
major=${version%%.*}

put() { # mode, file, folder
    install -d "$3"
    install -m "$1" "$2" "$3/"
}
link() { ln -sfn "$1" "$2"; }

put 755 "$build/relume" "$dest/bin"
put 755 "$build/relume-view" "$dest/bin"
[ ! -e "$build/relume-mpi" ] || put 755 "$build/relume-mpi" "$dest/bin"
put 644 "$build/librelume.a" "$dest/$lib"
install -m 755 "$build/librelume.so" "$dest/$lib/librelume.so.$version"
link "librelume.so.$version" "$dest/$lib/librelume.so.$major"
link "librelume.so.$major" "$dest/$lib/librelume.so"
put 755 "$build/librelume-oiio.so.$major" "$dest/$lib"
put 755 "$build/librelume-assimp.so.$major" "$dest/$lib"
put 755 "$build/relume-helper" "$dest/$lib"
[ ! -e "$build/librelume-stitch.so.$major" ] || put 755 "$build/librelume-stitch.so.$major" "$dest/$lib"
(cd "$here/include" && find relume -name '*.h') | while read -r header; do
    put 644 "$here/include/$header" "$dest/include/${header%/*}"
done
put 644 "$here/LICENSE" "$dest/share/doc/relume"

# For desktops: what opens which files, and how it is shown
put 644 "$here/packaging/relume-view.desktop" "$dest/share/applications"
put 644 "$here/packaging/relume.xml" "$dest/share/mime/packages"
put 644 "$here/packaging/org.relume.View.metainfo.xml" "$dest/share/metainfo"
put 644 "$here/packaging/relume.svg" "$dest/share/icons/hicolor/scalable/apps"
install -d "$dest/share/icons/hicolor/128x128/apps"
install -m 644 "$here/packaging/relume-128.png" "$dest/share/icons/hicolor/128x128/apps/relume.png"

# Private: what librelume.so has inside itself, and who links librelume.a must name.
install -d "$dest/$lib/pkgconfig"
cat >"$dest/$lib/pkgconfig/relume.pc" <<PC
prefix=$prefix
includedir=\${prefix}/include
libdir=\${prefix}/$lib

Name: relume
Description: image-based relighting
Version: $version
Requires.private: OpenEXR jansson libjpeg libpng lcms2 aom dav1d zlib
Libs: -L\${libdir} -lrelume
Libs.private: -Wl,-rpath,\${libdir} -lembree3 -lstdc++ -lm -ldl -pthread
Cflags: -I\${includedir}
PC

# From here on the programs speak for themselves.
man=$dest/share/man/man1
install -d "$man"
"$here/scripts/man.sh" "$build/relume" >"$man/relume.1"
"$here/scripts/man.sh" "$build/relume-view" >"$man/relume-view.1"
for command in $("$build/relume" --help | sed -n 's/^  \([a-z]*\) .*/\1/p'); do
    "$here/scripts/man.sh" "$build/relume" "$command" >"$man/relume-$command.1"
    for task in $("$build/relume" "$command" --help | sed -n '/^tasks;/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
        "$here/scripts/man.sh" "$build/relume" "$command $task" >"$man/relume-$command-$task.1"
    done
done
completions=$dest/share/bash-completion/completions
install -d "$completions"
"$here/scripts/completion.sh" "$build/relume" "$build/relume-view" >"$completions/relume"
link relume "$completions/relume-view"
