#!/bin/sh
# Who may use whom (docs/architecture.md): every quoted include of a folder must name a folder it
# may use, public headers of working folders only where allowed, and external libraries one file each.
set -eu
cd "$(dirname "$0")/.."
bad=0

# folder: private folders it may include | public headers it may include (* = all)
rules="base::base
math:base:base
image:base math:base image photograph response
capture:base math image:base image lights capture ball photometric shoot photograph response align views lightfield
coder:base math image:base image capture codebook coder heldout
pack:base image:base image capture codebook coder view pack
exchange:base math image:base image lights codebook coder capture pack relight exchange
relight:base math image:base image coder light relight rig normals enhance
view:base math image:base image light relight view slabs capture
pass:base math image:base image light tone eye psf glare
btf:base math image:base image light lights capture btf surface ambient
frame:base math:base image capture coder pack light relight view slabs frame evaluate normals enhance
scene:base math image:base image lights capture btf scene
object:base math image scene:base image capture light relight view slabs pack frame btf ambient surface object
cli:cli:*
viewer:viewer:*
samples::*"

folder_files() {
    case $1 in viewer | samples) find "$1" -name '*.c' -o -name '*.h' -o -name '*.cpp' ;;
    *) find "src/$1" -name '*.c' -o -name '*.h' -o -name '*.cpp' ;; esac
}

complain() { echo "layers: $*" >&2; bad=1; }

while IFS=: read -r folder private public; do
    for f in $(folder_files "$folder" 2>/dev/null); do
        for inc in $(sed -n 's/^#include "\([^"]*\)".*/\1/p' "$f"); do
            case $inc in */*) dir=${inc%%/*} ;; *) dir=$folder ;; esac
            [ "$dir" = "$folder" ] && continue
            case " $private " in *" $dir "*) ;; *) complain "$f includes $inc" ;; esac
        done
        [ "$public" = '*' ] && continue
        for inc in $(sed -n 's/^#include <relume\/\([^.>]*\)\.h>.*/\1/p' "$f"); do
            case " $public " in *" $inc "*) ;; *) complain "$f includes <relume/$inc.h>" ;; esac
        done
    done
done <<RULES
$rules
RULES

only_in() { # pattern file...: an external header appears in these files only
    pattern=$1; shift
    for f in $(grep -rlE "^#include <$pattern" src viewer tests samples 2>/dev/null || true); do
        case " $* " in *" $f "*) ;; *) complain "$f includes <$pattern...>; belongs to $*" ;; esac
    done
}
only_in 'openexr' src/image/exr.c tests/tools/decode.c
only_in 'OpenImageIO' src/image/oiio.cpp
only_in 'dlfcn' src/base/module.c
only_in 'opencv' src/capture/stitch.cpp
only_in 'embree' src/scene/trace.c
only_in 'assimp' src/scene/mesh_assimp.c
only_in '(cblas|lapacke)' src/math/lsq.c
only_in 'fftw3' src/math/fft.c
only_in 'kissfft' src/math/fft_kiss.c
only_in 'jansson' src/base/json.c
only_in 'jpeglib' src/image/jpeg.c
only_in 'lcms2' src/image/profile.c tests/unit/test_photograph.c
only_in 'cairo' src/cli/plot.c
only_in 'GLFW' viewer/context_glfw.c
only_in 'imgui' viewer/panel.cpp
only_in 'GL/osmesa' viewer/context_osmesa.c
only_in 'EGL/' viewer/context_egl.c
only_in 'immintrin' src/*/*_avx2.c
[ $bad = 0 ] && echo "layers: fine"
exit $bad
