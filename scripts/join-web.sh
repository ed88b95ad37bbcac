#!/bin/sh
# The viewer's modules as one classic script, which pages that were opened from a disk can load:
# join-web.sh FILE.js... > relume.js
# Modules import by name alone (`import { a, b } from './x.js';`, on one line or several) and mark
# what they give with `export` before function, const, let, class or async; nothing else. Each comes
# behind those that it imports. Lines that are comments stay behind.
set -eu

imports() {
    tr '\n' ' ' <"$1" | grep -o "import *{[^}]*} *from *'\./[^']*'" | sed "s/.*'\.\/\(.*\)'/\1/" || true
}

folder=$(dirname "$1")
order=$(for file in "$@"; do
    name=${file##*/}
    echo "$name $name"
    for needs in $(imports "$file"); do
        echo "$needs $name"
    done
done | tsort)

echo "(() => {"
echo "'use strict';"
for name in $order; do
    awk '
        /^import *\{/ { inside = 1 }
        inside { if (/from *\047/) inside = 0; next }
        /^ *\/\// { next }
        { sub(/^export /, ""); sub(/^ +/, ""); sub(/  \/\/ .*/, ""); print }
    ' "$folder/$name"
done
echo "})();"
