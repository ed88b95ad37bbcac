#!/bin/sh
# Who may use whom (docs/architecture.md): a wing of src may use itself and the wings before it, by quoted includes and by
# public headers; rooms of one wing include each other in one direction; programs stand beside each other by a table; external
# libraries are known to one file each; no file may need itself by way of others. What objects ask of each other is looked at by
# symbols (nm), which takes a build: not here.
# One awk over all includes: tests/cli/test_build.sh runs it ten times.
# layers.sh --table prints the rules as docs/architecture.md shows them.
set -eu
cd "$(dirname "$0")/.."

# wing: the public headers whose functions it has; it may use what stands above it
wings="core:base context core/vec
image:image camera image/photograph image/response image/jnd image/directions
capture:capture capture/align capture/acquire capture/ball capture/chart capture/ingest capture/photometric capture/slab_depth
format:pack format/coder format/codebook format/team
relight:light rig frame renderer evaluate relight/relight relight/relighter relight/shadow relight/normals relight/enhance relight/view relight/slab_set relight/viewport relight/tone relight/psf relight/eye relight/glare
material:material/btf material/btf_environment material/edit material/surface material/synthesis material/maps material/change
encode:encode/heldout
exchange:exchange exchange/notes
shape:shape/mesh shape/simplify shape/billboards shape/volume shape/fusion
world:world/transport world/points world/object world/reflection world/bake world/scene world/tableau
site:publish site/study"

# What points up still, FILE>HEADER: to be mended, and never to grow
still="shape/atlas/atlas.h>world/baked/baked.h shape/atlas/charts.h>world/baked/baked.h
format/pack/learnt.h>relume/relight/shadow.h format/pack/read_view.c>relume/relight/shadow.h
shape/mesh/tangents.h>relume/world/object.h"

# folder of a program: private folders it may include beside its own | public headers it may include (* = all)
rules="cli/program:core/base:base image exchange/notes pack relight/slab_set
cli/helper:core/base image/image shape/mesh:base
cli/measure:core/base core/math core/kernel image/image:*
cli:cli/program:*
cli/mpi:cli:context format/team
cli/materials:cli cli/program:*
cli/studies:cli cli/program:*
cli/commands:cli cli/materials cli/program cli/measure:*
cli/meshes:cli cli/program:*
viewer/common::base core/vec
viewer/app:common cli/program:*
viewer/gl:common cli/program:base image
viewer/relit:common cli/program app gl:*
viewer/glare:common cli/program app gl:base image relight/eye relight/psf relight/glare
viewer/transport:common cli/program app gl:*
viewer/draw:common cli/program app gl relit glare transport:*
viewer/panel:common cli/program app gl:*
viewer/window:common cli/program app gl:base
viewer/session:common cli/program app gl relit glare transport draw panel window:*
samples::*"

if [ "${1:-}" = --table ]; then
    echo "| wing | rooms | public headers |"
    echo "|---|---|---|"
    echo "$wings" | while IFS=: read -r wing headers; do
        echo "| $wing | $(ls "src/$wing" | tr '\n' ' ' | sed 's/ $//; s/ /, /g') | $(echo "$headers" | sed 's/ /, /g') |"
    done
    echo
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
external="openexr:src/image/image/exr.c tests/tools/decode.c tests/unit/test_piz.c
OpenImageIO:src/image/image/oiio.cpp
dlfcn:src/core/base/module.c tests/tools/preload/faults.c tests/bench/bench_simplify.c tests/tools/core_weights.c
opencv:src/capture/multiview/stitch.cpp
embree:src/shape/mesh/trace.c tests/tools/preload/msan.c
assimp:src/shape/mesh/mesh_assimp.c
Eigen:src/core/kernel/lsq_eigen.cpp
fftw3:src/core/math/fft.c
kissfft:src/core/math/fft_kiss.c
jansson:src/core/base/json.c
jpeglib:src/image/image/jpeg.c tests/unit/test_picture.c
png:src/image/image/png.c
aom/:src/format/lossy/av1_write.c tests/tools/preload/msan.c
dav1d:src/format/lossy/av1_read.c tests/tools/preload/msan.c
zlib:src/image/image/exr_sums.c src/format/lossy/lossy.c src/format/lossy/disparity.c src/shape/volume/unpack.c tests/unit/test_volume.c tests/fuzz/fuzz_volume.c
lcms2:src/image/image/profile.c tests/unit/test_photograph.c
cairo:src/cli/plot.c
mpi[.]h:src/cli/mpi/relume_mpi.c
GLFW:viewer/window/context_glfw.c samples/viewer.c
imgui:viewer/panel/panel_parts.h viewer/panel/panel.cpp viewer/panel/panel_font.cpp
panel/panel_parts:$(echo viewer/panel/panel*.cpp)
GL/osmesa:viewer/window/context_osmesa.c
EGL/:viewer/window/context_egl.c
immintrin:$(echo src/core/kernel/*_avx*.c)
arm_neon:src/core/kernel/kernels_neon.c"

# Files are opened by base alone, which notes what is read (inputs.h) and replaces nothing else
# (outfile.h, outdir.h). Elsewhere: what base has noted before, what no output could replace, the
# rows that a sweep appends, and the marks of a team, which are new.
opens="src/image/image/png.c src/image/image/picture.c src/shape/mesh/mesh_other.c src/exchange/formats/open.c src/relight/eye/subject.c
src/capture/acquire/report_picture.c src/cli/main.c src/cli/commands/capture_times.c src/cli/rays.c src/cli/commands/sweep_resume.c
src/format/team/folder.c viewer/app/script.c viewer/session/settings.c"
found=$(grep -rlE '(^|[^a-z_>.:])(fopen|open|openat|creat|rename|mkstemp|mkostemp|mkdtemp|tmpfile)\(' src viewer --include='*.c' --include='*.cpp' |
    grep -v -e '^src/core/base/' -e '^src/cli/helper/' | while read -r f; do
        case " $(echo $opens) " in *" $f "*) ;; *) echo "$f" ;; esac
    done)
[ -z "$found" ] || {
    echo "layers: opens or renames files itself; expected core/base/inputs.h, outfile.h or outdir.h:" $found >&2
    exit 1
}

# All memory of the library comes from one place, which an application may replace (context.h); the
# programs are its callers.
found=$(grep -rlE '(^|[^a-z_>.])(malloc|calloc|realloc|reallocarray|free|strdup|strndup|v?asprintf|aligned_alloc|posix_memalign)\(' src --include='*.[ch]' --include='*.cpp' |
    awk '!/^src.core.base.memory[.]c$/ && !/^src.cli/ || /^src.cli.(helper|measure)/')
[ -z "$found" ] || {
    echo "layers: allocates or frees itself; expected mem_array, mem_free (core/base/memory.h):" $found >&2
    exit 1
}

grep -rE '^#include [<"]' src viewer tests samples --include='*.c' --include='*.h' --include='*.cpp' |
    awk -F : -v rules="$rules" -v wings="$wings" -v still="$still" -v external="$external" '
    function complain(what) {
        print "layers: " what >"/dev/stderr"
        bad = 1
    }
    # the folder that a rule is for; of src the wing alone, but for programs
    function folder_of(file) {
        sub("^src/", "", file)
        if (file !~ "^(cli|viewer)/")
            sub("/.*", "", file)
        sub("/[^/]*$", "", file)
        return file
    }
    function has(list, word) { return index(" " list " ", " " word " ") }
    BEGIN {
        n = split(rules, line, "\n")
        for (i = 1; i <= n; i++) {
            split(line[i], part, ":")
            private[part[1]] = part[2]
            public[part[1]] = part[3]
        }
        n = split(wings, line, "\n")
        for (i = 1; i <= n; i++) {
            split(line[i], part, ":")
            number[part[1]] = i
            m = split(part[2], headers, " ")
            for (k = 1; k <= m; k++)
                wing_of["relume/" headers[k] ".h"] = i
        }
        gsub("\n", " ", still)
        externals = split(external, line, "\n")
        for (i = 1; i <= externals; i++) {
            split(line[i], part, ":")
            pattern[i] = part[1]
            place[i] = part[2]
        }
    }
    {
        file = $1
        folder = folder_of(file)
        name = substr($2, 11)
        sub(/[">].*/, "", name)
        own = $2 ~ /^#include "/
        dir = name
        sub("/[^/]*$", "", dir)
        wing = name
        sub("/.*", "", wing)
    }
    folder in number && name ~ "/" && (own || name ~ "^relume/") {
        above = own ? (wing in number ? number[wing] : 99) : name in wing_of ? wing_of[name] : 99
        if (above > number[folder] && !has(still, substr(file, 5) ">" name))
            complain(file " includes " (own ? name : "<" name ">"))
    }
    own && folder in private && name ~ "/" && dir != folder && "viewer/" dir != folder && !has(private[folder], dir) {
        complain(file " includes " name)
    }
    !own && folder in private && name ~ "^relume/" && public[folder] != "*" {
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

# Files need each other in one direction only: x.c and x.h are one node, tsort finds the loops. So do rooms of a wing.
needs=$(grep -rE '^#include "' src viewer --include='*.c' --include='*.h' --include='*.cpp' |
    awk -F '[:"]' '{
        from = folder = $1
        sub("/[^/]*$", "/", folder)
        to = ($3 !~ "/" ? folder : $1 ~ "^viewer/" ? "viewer/" : "src/") $3
        sub(/[.][a-z]*$/, "", from)
        sub(/[.][a-z]*$/, "", to)
        if (from != to)
            print from, to
    }')
loops() { tsort 2>&1 >/dev/null | sed 's/^tsort: //' | tr '\n' ' '; }
loops=$(echo "$needs" | loops)
[ -z "$loops" ] || {
    echo "layers: files that include each other, x.c and x.h taken as one: $loops" >&2
    exit 1
}
loops=$(echo "$needs" | awk '{
        split($1, a, "/")
        split($2, b, "/")
        if (a[1] == "src" && b[1] == "src" && a[2] == b[2] && a[3] != b[3] && a[2] != "cli")
            print a[2] "/" a[3], b[2] "/" b[3]
    }' | sort -u | loops)
[ -z "$loops" ] || {
    echo "layers: rooms that include each other: $loops" >&2
    exit 1
}
echo "layers: fine"
