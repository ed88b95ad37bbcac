#!/bin/sh
# Who may use whom (docs/architecture.md): every quoted include of a folder must name a folder it
# may use, public headers of working folders only where allowed, and external libraries one file
# each; no file may need itself by way of others.
# One awk over all includes: tests/cli/test_build.sh runs it ten times.
# layers.sh --table prints the rules as docs/architecture.md shows them.
set -eu
cd "$(dirname "$0")/.."

# folder: private folders it may include | public headers it may include (* = all)
rules="base::base io context
kernel:base:base
math:base kernel:base vec
geometry:base math:base capture
image:base math kernel:base io image photograph response
compare:base math image:base image jnd
study:base math:base image study
chart:base math image compare:base image photograph chart
capture:base math geometry image:base image photograph directions capture response
hdr:base math image:base image photograph response align
multiview:base math image capture:base image capture photograph ingest slab_depth
stereo:base math:base
acquire:base math image capture multiview stereo:base image directions capture ball photometric acquire photograph align chart
change:base math image capture compare appearance:base image capture align pack change
appearance:base math image capture:base image capture photometric light relight pack maps
coder:base math kernel image:base image capture coder
codebook:base math kernel image coder team:base coder codebook team
team:base math:base io team
selection:base math image coder compare:base image capture coder codebook heldout team tone
lossy:base math:base image coder
shadow:base math image:base image capture coder light maps shadow
encode:base math image coder codebook lossy team:base image capture codebook coder light relight pack team shadow
pack:base math geometry image coder lossy:base image capture codebook coder pack shadow
foreign:base math image:base image directions coder relight
block:base:base
exchange:base math image foreign block:base io image photograph directions codebook coder capture pack relight exchange
publish:base math geometry image lossy foreign exchange baked:base io image capture coder pack relight light frame tone exchange notes object bake mesh shadow publish vec
relight:base math kernel image:base image capture coder light relight rig relighter shadow
analysis:base math stereo:base image coder light relight normals enhance
view:base math image:base image light relight view slab_set capture
post:base math kernel image:base image tone eye psf glare
frame:base math image:base image capture coder pack light relight shadow view slab_set frame viewport evaluate jnd normals enhance renderer relighter rig
btf:base math image:base image directions capture btf
gbrdf:base math image btf:base image directions btf
edit:base math image gbrdf:base image edit maps
btf_model:base math image btf gbrdf edit:base image light directions btf btf_environment edit
synthesis:base math image:base image synthesis
notes:base:base image notes
surface:base math synthesis btf btf_model:base image btf btf_environment surface synthesis
mesh:base math geometry:base io image object mesh jnd simplify billboards
volume:base image:base image photograph volume
isosurface:base volume:base mesh volume
fusion:base math geometry volume mesh baked:base image light relight pack frame view slab_set renderer capture mesh volume fusion
distance:base math:base image mesh billboards
reflect:base math kernel:base reflection
scene:base math image geometry mesh:base image directions capture btf scene
transport:base math mesh:base image capture view viewport transport
baked:base math geometry image:base coder codebook directions light bake
object:base math mesh transport frame baked:base image capture light relight view slab_set pack frame viewport btf btf_environment surface reflection transport points object renderer bake mesh billboards simplify exchange
bake:base math mesh baked object:base light surface btf object bake
tableau:base math geometry mesh transport frame object:base image light relight view slab_set pack frame viewport object renderer exchange rig tableau
helper:base image mesh:base
measure:base math kernel image:*
program:base:base image notes pack slab_set
cli:program:*
mpi::io team
cli/materials:materials program:*
cli/studies:studies program:*
cli/commands:commands materials program measure:*
cli/meshes:meshes program:*
viewer/common::base vec
viewer/app:common program:*
viewer/gl:common program:base image
viewer/relit:common program app gl:*
viewer/glare:common program app gl:base image eye psf glare
viewer/transport:common program app gl:*
viewer/draw:common program app gl relit glare transport:*
viewer/panel:common program app gl:*
viewer/window:common program app gl:base
viewer/session:common program app gl relit glare transport draw panel window:*
samples::*"

if [ "${1:-}" = --table ]; then
    echo "$rules" | awk -F : '
        function commas(list, none) {
            gsub(" ", ", ", list)
            return list == "" ? none : list == "*" ? "all" : list
        }
        BEGIN { print "| folder | private | public headers |\n|---|---|---|" }
        { print "| " $1 " | " commas($2, "-") " | " commas($3, "-") " |" }'
    exit
fi

# external header: the files it may appear in
external="openexr:src/image/exr.c tests/tools/decode.c tests/unit/test_piz.c
OpenImageIO:src/image/oiio.cpp
dlfcn:src/base/module.c tests/tools/preload/faults.c tests/bench/bench_simplify.c tests/tools/core_weights.c
opencv:src/multiview/stitch.cpp
embree:src/mesh/trace.c tests/tools/preload/msan.c
assimp:src/mesh/mesh_assimp.c
Eigen:src/kernel/lsq_eigen.cpp
fftw3:src/math/fft.c
kissfft:src/math/fft_kiss.c
jansson:src/base/json.c
jpeglib:src/image/jpeg.c tests/unit/test_picture.c
png:src/image/png.c
aom/:src/lossy/av1_write.c tests/tools/preload/msan.c
dav1d:src/lossy/av1_read.c tests/tools/preload/msan.c
zlib:src/image/exr_sums.c src/lossy/lossy.c src/lossy/disparity.c src/volume/unpack.c tests/unit/test_volume.c tests/fuzz/fuzz_volume.c
lcms2:src/image/profile.c tests/unit/test_photograph.c
cairo:src/cli/plot.c
mpi[.]h:src/mpi/relume_mpi.c
GLFW:viewer/window/context_glfw.c samples/viewer.c
imgui:viewer/panel/panel_parts.h viewer/panel/panel.cpp viewer/panel/panel_font.cpp
panel/panel_parts:$(echo viewer/panel/panel*.cpp)
GL/osmesa:viewer/window/context_osmesa.c
EGL/:viewer/window/context_egl.c
immintrin:$(echo src/kernel/*_avx*.c)
arm_neon:src/kernel/kernels_neon.c"

# Files are opened by base alone, which notes what is read (inputs.h) and replaces nothing else
# (outfile.h, outdir.h). Elsewhere: what base has noted before, what no output could replace, the
# rows that a sweep appends, and the marks of a team, which are new.
opens="src/image/png.c src/image/picture.c src/mesh/mesh_other.c src/exchange/open.c src/post/subject.c
src/acquire/report_picture.c src/cli/main.c src/cli/commands/capture_times.c src/cli/rays.c src/cli/commands/sweep_resume.c
src/team/folder.c viewer/app/script.c viewer/session/settings.c"
found=$(grep -rlE '(^|[^a-z_>.:])(fopen|open|openat|creat|rename|mkstemp|mkostemp|mkdtemp|tmpfile)\(' src viewer --include='*.c' --include='*.cpp' |
    grep -v -e '^src/base/' -e '^src/helper/' | while read -r f; do
        case " $(echo $opens) " in *" $f "*) ;; *) echo "$f" ;; esac
    done)
[ -z "$found" ] || {
    echo "layers: opens or renames files itself; expected base/inputs.h, outfile.h or outdir.h:" $found >&2
    exit 1
}

# All memory of the library comes from one place, which an application may replace (context.h); the
# programs are its callers.
found=$(grep -rlE '(^|[^a-z_>.])(malloc|calloc|realloc|reallocarray|free|strdup|strndup|v?asprintf|aligned_alloc|posix_memalign)\(' src --include='*.[ch]' --include='*.cpp' |
    grep -v -e '^src/base/memory.c$' -e '^src/cli/' -e '^src/mpi/' -e '^src/program/' || true)
[ -z "$found" ] || {
    echo "layers: allocates or frees itself; expected mem_array, mem_free (base/memory.h):" $found >&2
    exit 1
}

grep -rE '^#include [<"]' src viewer tests samples --include='*.c' --include='*.h' --include='*.cpp' |
    awk -F : -v rules="$rules" -v external="$external" '
    function complain(what) {
        print "layers: " what >"/dev/stderr"
        bad = 1
    }
    # src/ROOM, src/cli/ROOM and viewer/ROOM hold files of their own rule
    function room(part) {
        if (part[1] == "viewer")
            return part[1] "/" part[2]
        if (part[1] != "src")
            return part[1]
        return part[3] ~ /[.]/ ? part[2] : part[2] "/" part[3]
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
        folder = room(part)
        name = substr($2, 11)
        sub(/[">].*/, "", name)
        known = folder in private
        own = $2 ~ /^#include "/
    }
    own && known && name ~ "/" {
        dir = name
        sub("/.*", "", dir)
        if (dir != folder && "viewer/" dir != folder && !has(private[folder], dir))
            complain(file " includes " name)
    }
    !own && known && name ~ "^relume/" && public[folder] != "*" {
        header = name
        gsub("relume/|[.].*", "", header)
        if (!has(public[folder], header))
            complain(file " includes <" name ">")
    }
    !own || name ~ "/" {
        for (i = 1; i <= externals; i++)
            if (name ~ "^" pattern[i] && !has(place[i], file))
                complain(file " includes <" pattern[i] "...>; belongs to " place[i])
    }
    END { exit bad }'

# What draws gets a frame_request, which holds what to show, and does not see the state that events change.
drawn=$(grep -rlE 'struct app\b[^_]' viewer/gl viewer/relit viewer/glare viewer/draw || true)
[ -z "$drawn" ] || {
    echo "layers: uses struct app; expected struct frame_request:" $drawn >&2
    exit 1
}

# Files need each other in one direction only: x.c and x.h are one node, tsort finds the loops.
loops=$(grep -rE '^#include "' src viewer --include='*.c' --include='*.h' --include='*.cpp' |
    awk -F '[:"]' '
    {
        split($1, part, "/")
        root = part[1] == "viewer" ? "viewer/" : part[2] == "cli" ? "src/cli/" : "src/"
        from = $1
        to = root $3
        sub(/[.][a-z]*$/, "", from)
        sub(/[.][a-z]*$/, "", to)
        if (from != to)
            print from, to
    }' | tsort 2>&1 >/dev/null | sed 's/^tsort: //' | tr '\n' ' ')
[ -z "$loops" ] || {
    echo "layers: files that include each other, x.c and x.h taken as one: $loops" >&2
    exit 1
}
echo "layers: fine"
