#!/bin/sh
# The attic's sun in a film: docs/pictures/shadows-attic.jpg and what docs/shadows.md says of it.
# shadows.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
set -eu
relume=$1/relume draw=$1/samples/figures out=$2 pictures=$3
frames=60
rm -rf "$out"
mkdir -p "$out" "$pictures"

# 0.56 high, from left to right
awk -v n=$frames 'BEGIN {
    for (i = 0; i < n; i++) {
        a = i * 1.8 / (n - 1) - 0.9
        printf "%.9f %.9f %.9f\n", sin(a) * 0.83, 0.56, cos(a) * 0.83
    }
}' >"$out/suns.txt"
echo "An attic under 100 lamps, and under $frames suns"
"$relume" synth attic -o "$out/attic" --size 96 --lights 100 -q
"$relume" synth attic -o "$out/suns" --size 96 --lights-from "$out/suns.txt" -q
"$relume" encode "$out/attic" -o "$out/traced.exr" -q
"$relume" encode "$out/attic" -o "$out/faded.exr" --shadows no -q
"$relume" encode "$out/suns" -o "$out/truth.exr" --basis table --bits half --shadows no -q

for film in truth traced faded; do
    mkdir "$out/$film"
    set --
    n=0
    while read -r x y z; do
        n=$((n + 1)) sun="dir $x $y $z"
        "$relume" relight "$out/$film.exr" -o "$out/$film/$n.exr" --view 0 --light "$sun" -q
        case $n in 1 | 13 | 25 | 36 | 48 | 60) ;; *) continue ;; esac
        "$relume" relight "$out/$film.exr" -o "$out/$film/$n.png" --pan 0 --size 144x108 --light "$sun" --exposure 1.5 -q
        set -- "$@" "$out/$film/$n.png"
    done <"$out/suns.txt"
    "$draw" row "$out/$film.png" "$@"
done
"$draw" column "$pictures/shadows-attic.jpg" "$out/truth.png" "$out/traced.png" "$out/faded.png"
echo "  $pictures/shadows-attic.jpg"
for film in traced faded; do "$draw" film "$out/truth" "$out/$film" $frames; done
