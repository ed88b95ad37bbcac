#!/bin/sh
# Debian packages of the tarball of a release: deb.sh DIST FOLDER. DEB_BUILD_OPTIONS as Debian's policy
# has them; without it: no tests, as many jobs as there are processors.
set -eu
cd "$(dirname "$0")/.."
tarball=$(ls "$1"/relume-*.tar.xz)
version=$(basename "$tarball" .tar.xz | sed 's/^relume-//')
rm -rf "$2"
mkdir -p "$2"
cp "$tarball" "$2/relume_$version.orig.tar.xz"
tar -xf "$tarball" -C "$2"
export DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS:-nocheck parallel=$(nproc)}"
(cd "$2/relume-$version" && dpkg-buildpackage -us -uc)
ls "$2"/*.deb
