#!/bin/sh
# The viewer's modules as one classic script, which pages that were opened from a disk can load:
# join-web.sh [--more FILE.js...] -- FILE.js... > relume.js
# Modules import by name alone (`import { a, b } from './x.js';`, on one line or several) and mark
# what they give with `export` before function, const, let, class or async; nothing else. Each comes
# behind those that it imports. Lines that are comments stay behind. Shaders that a module imports
# (`import NAME from '../PATH.glsl';`) come first, as strings, each once.
# Files behind --more are of another script, which loads later (join-web.sh --part FILE.js... > relume-more.js): what they
# import of the first one it hands over as window.relume.shared, and what they give is handed back.
set -eu

imports() {
    tr '\n' ' ' <"$1" | grep -o "import *{[^}]*} *from *'\./[^']*'" | sed "s/.*'\.\/\(.*\)'/\1/" || true
}

# names that files import of other files than these
from_others() {
    for file in "$@"; do
        tr '\n' ' ' <"$file" | grep -o "import *{[^}]*} *from *'\./[^']*'" || true
    done | while read -r line; do
        of=${line##*/}
        case " $(for own in "$@"; do echo "${own##*/}"; done | tr '\n' ' ') " in
        *" ${of%\'} "*) ;;
        *) echo "$line" | sed 's/.*{ *//; s/ *}.*//; s/ *, */\n/g' ;;
        esac
    done | grep . | sort -u | tr '\n' ',' | sed 's/,$//; s/,/, /g'
}

# the shaders that files import, as strings without comments
shaders() {
    cat "$@" | sed -n "s/^import \([A-Z_]*\) from '\(.*\.glsl\)';$/\1 \2/p" | sort -u |
        while read -r name path; do
            [ -e "$folder/$path" ] || { echo "join-web.sh: no $folder/$path" >&2; exit 1; }
            echo "const $name = \`"
            sed 's/^ *//; s/^\/\/.*//; s/  \/\/ .*//; /^$/d' "$folder/$path"
            echo '`;'
        done
}

part=no more=
case $1 in
--part) part=yes && shift ;;
--more)
    shift
    while [ "$1" != -- ]; do more="$more $1" && shift; done
    shift
    ;;
esac
folder=$(dirname "$1")
files=" $(for file in "$@"; do echo "${file##*/}"; done | tr '\n' ' ') "
order=$(for file in "$@"; do
    name=${file##*/}
    echo "$name $name"
    for needs in $(imports "$file"); do
        case $files in *" $needs "*) echo "$needs $name" ;; esac
    done
done | tsort)

if [ $part = yes ]; then
    echo "relume.putMore((shared) => {"
else
    echo "(() => {"
fi
echo "'use strict';"
[ $part = no ] || echo "const { $(from_others "$@") } = shared;"
shaders "$@"
for name in $order; do
    awk '
        /^import [A-Z_]+ from/ { next }
        /^import *\{/ { inside = 1 }
        inside { if (/from *\047/) inside = 0; next }
        /^ *\/\// { next }
        { sub(/^export /, ""); sub(/^ +/, ""); sub(/  \/\/ .*/, ""); print }
    ' "$folder/$name"
done
[ -z "$more" ] || echo "window.relume.shared = { $(from_others $more) };"
if [ $part = yes ]; then
    echo "return { $(cat "$@" | sed -n 's/^export class \([A-Za-z]*\).*/\1/p' | tr '\n' ',' | sed 's/,$//; s/,/, /g') };"
    echo "});"
else
    echo "})();"
fi
