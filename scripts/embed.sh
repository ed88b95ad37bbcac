#!/bin/sh
# Turn shader files into one C file: embed.sh FOLDER FILE.glsl... > shaders.c
# A line `#include "room/other.glsl"` is replaced by that file below FOLDER, and so on in there,
# so that every text in the program is complete; FOLDER/room/name.frag.glsl is "room_name.frag" to the program. Strings are
# split by lines: a compiler promises only 4095 characters each.
set -eu

expand() {
    awk -v folder="$folder" -v first="$1" '
        function put(file,    line, got) {
            while ((got = (getline line < file)) > 0)
                if (line ~ /^#include "/) {
                    sub(/^#include "/, "", line)
                    sub(/".*/, "", line)
                    put(folder "/" line)
                } else
                    print line
            if (got < 0) { print "embed.sh: cannot read " file > "/dev/stderr"; exit 1 }
            close(file)
        }
        BEGIN { put(first) }'
}

folder=$1
shift
echo '#include "gl/shaders.h"'
names=
for file in "$@"; do
    case $file in *.frag.glsl | *.vert.glsl | *.comp.glsl) ;; *) continue ;; esac
    name=${file#"$folder"/}
    name=$(echo "${name%.glsl}" | tr / _)
    symbol=$(echo "$name" | tr -c 'A-Za-z0-9\n' '_')
    names="$names $name:$symbol"
    text=$(expand "$file")
    echo "static const char *const ${symbol}_lines[] = {"
    printf '%s\n' "$text" | sed -e 's/\\/\\\\/g' -e 's/"/\\"/g' -e 's/^/    "/' -e 's/$/\\n",/'
    echo '};'
done
echo 'const struct shader_source shader_sources[] = {'
for pair in $names; do
    echo "    {\"${pair%%:*}\", ${pair#*:}_lines,"
    echo "     sizeof ${pair#*:}_lines / sizeof *${pair#*:}_lines},"
done
echo '    {0, 0, 0},'
echo '};'
