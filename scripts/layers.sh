#!/bin/sh
# Who may use whom (docs/architecture.md): a wing of src may use itself and the wings before it, by quoted includes and by
# public headers; rooms of one wing include each other in one direction; programs stand beside each other by a table; external
# libraries are known to one file each; no file may need itself by way of others.
# layers.sh --symbols OBJECT... asks the same of objects: each undefined symbol (nm) is looked up in the object that defines it,
# whose wing must not have a larger number; rooms of one wing need each other in one direction. The build runs it.
# One awk over all includes: tests/cli/test_build.sh runs it ten times.
# layers.sh --table prints the rules as docs/architecture.md shows them.
set -eu
cd "$(dirname "$0")/.."

# wing: the headers of the public core that are its own (extensions: relume/WING/*.h); it may use what stands above it
wings="core:base context
image:image camera
capture:capture
format:pack
relight:light rig frame renderer evaluate
material:
encode:encode
exchange:exchange
shape:
world:
site:publish"

# folder of a program: private folders it may include beside its own | public headers it may include (* = all)
rules="cli/program:core/base:base image exchange/notes pack relight/slab_set
cli/helper:core/base format/lossy image/image shape/mesh:base
cli/measure:core/base core/math core/kernel image/image shape/mesh world/stage:*
cli:core/base cli/program:*
cli/mpi:cli core/math:context format/team
cli/materials:cli cli/program:*
cli/studies:cli cli/program:*
cli/commands:cli cli/materials cli/program cli/measure core/math:*
cli/meshes:cli cli/program:*
viewer/common::base core/vec
viewer/app:common cli/program:*
viewer/gl:common cli/program:base image
viewer/relit:common cli/program app gl core/base:*
viewer/glare:common cli/program app gl:base image relight/eye relight/psf relight/glare
viewer/transport:common cli/program app gl:*
viewer/draw:common cli/program app gl relit glare transport:*
viewer/panel:common cli/program app gl:*
viewer/window:common cli/program app gl:base
viewer/session:common cli/program app gl relit glare transport draw panel window:*
samples::*"

if [ "${1:-}" = --table ]; then
    commas() { sed 's/ $//; s/ /, /g; s/^$/-/'; }
    echo "| wing | rooms | headers of the core | extensions |"
    echo "|---|---|---|---|"
    echo "$wings" | while IFS=: read -r wing headers; do
        echo "| $wing | $(ls "src/$wing" | tr '\n' ' ' | commas) | $(echo "$headers" | commas) |" \
            "$(ls "include/relume/$wing" 2>/dev/null | sed 's/[.]h$//' | tr '\n' ' ' | commas) |"
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

# Objects instead of sources: BUILD/obj/src/WING/ROOM/NAME.o
if [ "${1:-}" = --symbols ]; then
    shift
    nm -A -P "$@" | awk -v wings="$wings" '
    function complain(what) {
        print "layers: " what >"/dev/stderr"
        bad = 1
    }
    # Marks what a room of a wing reaches from `at` on.
    function reach(start, at,    i, n, to) {
        n = split(onward[at], to, " ")
        for (i = 1; i <= n; i++)
            if (!((start, to[i]) in reached)) {
                reached[start, to[i]] = 1
                reach(start, to[i])
            }
    }
    BEGIN {
        n = split(wings, line, "\n")
        for (i = 1; i <= n; i++) {
            sub(/:.*/, "", line[i])
            number[line[i]] = i
        }
    }
    {
        object = $1
        sub(/.*obj\/src\//, "", object)
        sub(/:$/, "", object)
        if ($3 == "U")
            wanted[object] = wanted[object] " " $2
        else if ($3 ~ /^[A-Z]$/) {
            defined[$2] = object
            count[$2]++
        }
        split(object, part, "/")
        wing[object] = $1 ~ /obj\/src\// ? part[1] : ""
        room[object] = part[1] "/" part[2]
    }
    END {
        for (object in wanted) {
            n = split(wanted[object], name, " ")
            for (i = 1; i <= n; i++) {
                from = defined[name[i]]
                if (count[name[i]] != 1 || !(wing[object] in number) || wing[from] == "")  # files that are embedded
                    continue
                if (!(wing[from] in number) || number[wing[from]] > number[wing[object]])
                    complain(object " needs " name[i] " of " from ", a wing above")
                if (wing[from] == wing[object] && room[from] != room[object] && !((room[object], room[from]) in known)) {
                    known[room[object], room[from]] = object " needs " name[i]
                    onward[room[object]] = onward[room[object]] " " room[from]
                }
            }
        }
        for (r in onward)
            reach(r, r)
        for (pair in known) {
            split(pair, end, SUBSEP)
            if ((end[2], end[1]) in reached)
                complain("rooms that need each other: " end[1] ", " end[2] ": " known[pair])
        }
        exit bad
    }'
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
jpeglib:src/image/image/jpeg.c tests/unit/test_picture.c tests/unit/test_jpeg_model.c
png:src/image/image/png.c
aom/:src/format/lossy/av1_write.c tests/tools/preload/msan.c
dav1d:src/format/lossy/av1_read.c tests/tools/preload/msan.c
zlib:src/image/image/exr_sums.c src/image/image/png_rows.c src/format/lossy/lossy.c src/format/lossy/disparity.c src/shape/volume/unpack.c tests/unit/test_png_rows.c tests/unit/test_volume.c tests/fuzz/fuzz_volume.c
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
opens="src/image/image/png.c src/image/image/picture.c src/shape/mesh/mesh_other.c src/relight/eye/subject.c
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
    awk -F : -v rules="$rules" -v wings="$wings" -v external="$external" '
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
        if (!own && name ~ "/.*/") {
            wing = name
            gsub("^relume/|/[^/]*$", "", wing)
        }
        above = !own && name in wing_of ? wing_of[name] : wing in number ? number[wing] : 99
        if (above > number[folder])
            complain(file " includes " (own ? name : "<" name ">"))
    }
    # the viewer is linked with the static library, and may look inside
    own && folder ~ "^viewer" && wing in number { next }
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

# A core header includes core headers only: the core is read without the extensions.
cores="$(echo "$wings" | sed 's/^[^:]*://' | tr ' ' '\n' | sed '/^$/d; s|.*|include/relume/&.h|')"
! grep -HE '^#include <relume/.*/' $cores | sed 's/^/layers: /; s/:#include/ includes/; s/$/, an extension/' | grep . >&2 || exit 1

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
