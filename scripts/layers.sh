#!/bin/sh
# Who may use whom (docs/architecture.md): every quoted include of a folder must name a folder it
# may use, public headers of working folders only where allowed, and external libraries one file each.
# One awk over all includes: tests/cli/test_build.sh runs it ten times.
set -eu
cd "$(dirname "$0")/.."

# folder: private folders it may include | public headers it may include (* = all)
rules="base::base io
math:base:base
image:base math:base io image photograph response
capture:base math image:base image lights capture ball photometric shoot photograph response align views lightfield
coder:base math image:base image capture codebook coder heldout
pack:base image:base image capture codebook coder view pack
exchange:base math image:base image photograph lights codebook coder capture pack relight exchange
relight:base math image:base image coder light relight rig normals enhance relighter
view:base math image:base image light relight view slabs capture
pass:base math image:base image tone eye psf glare
btf:base math image:base image light lights capture btf surface ambient
frame:base math image:base image capture coder pack light relight view slabs frame sight evaluate normals enhance renderer relighter rig
scene:base math image:base image lights capture btf scene
object:base math image scene:base image capture light relight view slabs pack frame sight btf ambient surface object renderer
helper:base image scene:base
cli:cli:*
viewer:viewer:*
samples::*"

# external header: the files it may appear in
external="openexr:src/image/exr.c tests/tools/decode.c
OpenImageIO:src/image/oiio.cpp
dlfcn:src/base/module.c tests/tools/preload/faults.c
opencv:src/capture/stitch.cpp
embree:src/scene/trace.c
assimp:src/scene/mesh_assimp.c
Eigen:src/math/lsq_eigen.cpp
fftw3:src/math/fft.c
kissfft:src/math/fft_kiss.c
jansson:src/base/json.c
jpeglib:src/image/jpeg.c tests/unit/test_picture.c
png:src/image/png.c
lcms2:src/image/profile.c tests/unit/test_photograph.c
cairo:src/cli/plot.c
GLFW:viewer/context_glfw.c
imgui:viewer/panel_parts.h viewer/panel.cpp
panel_parts:$(echo viewer/panel*.cpp)
GL/osmesa:viewer/context_osmesa.c
EGL/:viewer/context_egl.c
immintrin:$(echo src/*/*_avx2.c)"

# Files are opened by base alone, which notes what is read (inputs.h) and replaces nothing else
# (outfile.h, outdir.h). Elsewhere: what base has noted before, what no output could replace, and the
# rows that a sweep appends.
opens="src/image/png.c src/image/picture.c src/scene/mesh_other.c src/exchange/open.c src/pass/subject.c
src/capture/report_picture.c src/cli/main.c src/cli/capture_times.c src/cli/rays.c src/cli/sweep_resume.c
viewer/script.c viewer/settings.c"
found=$(grep -rlE '(^|[^a-z_>.:])(fopen|open|openat|creat|rename|mkstemp|mkostemp|mkdtemp|tmpfile)\(' src viewer --include='*.c' --include='*.cpp' |
    grep -v -e '^src/base/' -e '^src/helper/' | while read -r f; do
        case " $(echo $opens) " in *" $f "*) ;; *) echo "$f" ;; esac
    done)
[ -z "$found" ] || {
    echo "layers: opens or renames files itself; expected base/inputs.h, outfile.h or outdir.h:" $found >&2
    exit 1
}

grep -rE '^#include [<"]' src viewer tests samples --include='*.c' --include='*.h' --include='*.cpp' |
    awk -F : -v rules="$rules" -v external="$external" '
    function complain(what) {
        print "layers: " what >"/dev/stderr"
        bad = 1
    }
    function has(list, word) { return index(" " list " ", " " word " ") }
    BEGIN {
        n = split(rules, line, "\n")
        for (i = 1; i <= n; i++) {
            split(line[i], part, ":")
            private[part[1]] = part[2]
            public[part[1]] = part[3]
        }
        externals = split(external, line, "\n")
        for (i = 1; i <= externals; i++) {
            split(line[i], part, ":")
            pattern[i] = part[1]
            place[i] = part[2]
        }
    }
    {
        file = $1
        split(file, part, "/")
        folder = part[1] == "src" ? part[2] : part[1]
        name = substr($2, 11)
        sub(/[">].*/, "", name)
        known = folder in private
        own = $2 ~ /^#include "/
    }
    own && known && name ~ "/" {
        dir = name
        sub("/.*", "", dir)
        if (dir != folder && !has(private[folder], dir))
            complain(file " includes " name)
    }
    !own && known && name ~ "^relume/" && public[folder] != "*" {
        header = name
        gsub("relume/|[.].*", "", header)
        if (!has(public[folder], header))
            complain(file " includes <" name ">")
    }
    !own {
        for (i = 1; i <= externals; i++)
            if (name ~ "^" pattern[i] && !has(place[i], file))
                complain(file " includes <" pattern[i] "...>; belongs to " place[i])
    }
    END { exit bad }' && echo "layers: fine"
