#!/bin/sh
# Make sure the packages that relume is built from are there; on Debian and Ubuntu install what is
# missing. Usage: deps.sh [web | stitch | mpi | docs | python]   (web: the browser for the tests of exported
# pages and models, and npm, by which make deps-web gets three.js, gltf-validator, axe and two IIIF viewers; stitch: OpenCV, for panoramas out of photographs; mpi: OpenMPI, for relume-mpi; docs: Doxygen, for the reference of the
# library; python: what the Python module needs)
set -eu

packages="gcc g++ make pkg-config libc6-dev libopenexr-dev libopenimageio-dev libembree-dev
libeigen3-dev libfftw3-dev libkissfft-dev libjansson-dev libjpeg-dev libpng-dev liblcms2-dev libaom-dev libdav1d-dev zlib1g-dev
libassimp-dev libcmocka-dev libcairo2-dev libglfw3-dev libosmesa6-dev
libegl-dev libegl-mesa0 libimgui-dev fonts-dejavu-core libstb-dev xvfb xdotool"
[ "${1:-}" = web ] && packages="chromium"
[ "${1:-}" != web ] || command -v npm >/dev/null 2>&1 || packages="chromium nodejs npm"
[ "${1:-}" = stitch ] && packages="libopencv-stitching-dev"
[ "${1:-}" = mpi ] && packages="openmpi-bin libopenmpi-dev"
[ "${1:-}" = docs ] && packages="doxygen"
[ "${1:-}" = python ] && packages="python3-numpy python3-setuptools python3-wheel python3-venv"

missing=
for p in $packages; do
    state=$(dpkg-query -W -f '${Status}' "$p" 2>/dev/null || true)
    [ "$state" = "install ok installed" ] || missing="$missing $p"
done
[ -z "$missing" ] && exit 0

if ! command -v apt-get >/dev/null 2>&1; then
    echo "relume needs these Debian packages or their equivalents:" $packages >&2
    exit 1
fi
as_root=
[ "$(id -u)" = 0 ] || as_root=sudo
echo "installing:$missing"
$as_root apt-get update -q
DEBIAN_FRONTEND=noninteractive $as_root apt-get install -q -y --no-install-recommends $missing
