#!/bin/sh
# The tables of docs/measurements/synthesis.md, as Markdown.
# Usage: synthesis.sh BUILD FOLDER [SIDE]
# Samples stay in FOLDER and are used again. SIDE is that of the large map, 4096. Other programs are
# measured where they are: G'MIC (Debian: gmic), and image quilting in Python (python3-numpy).
set -eu
relume=$(realpath "$1")/relume tools=$(realpath "$(dirname "$0")/../tools")
mkdir -p "$2"
cd "$2"
side=${3:-4096}
python=python3
/usr/bin/python3 -c 'import numpy' 2>/dev/null && python=/usr/bin/python3

sample() { # material, side: its picture under one light, as a .ppm file
    [ -d "$1$2" ] || "$relume" synth --btf "$1" -o "$1$2" --size "$2" --extent 2 --directions coarse --samples 2 --bounces 0 -q
    "$relume" btf render "$1$2" -o "$1$2.ppm" --light 'dir 1 0.3 1' -q
}
field() { tr ',{}' '\n\n\n' <"$2" | sed -n "s/^ *\"$1\": *\[*//p" | head -1; }
second() { sed -n "s/.*\"$1\": \[[^,]*, \([^]]*\)\].*/\1/p" "$2"; }
synth() { "$relume" btf synth "$@" --json -q >row.json; }

sample corduroy 128
sample corduroy 256
echo '**Waves** of corduroy, 128 x 128 (Tab. 4.1 and 4.2: the means of Y, Cr, Cb are not counted)'
echo
echo '| threshold | waves | RMS left, one by one | fitted together | improvement | analysis s |'
echo '|---|---|---|---|---|---|'
for t in 0.5 1 2 5; do
    synth corduroy128.ppm -o x.npy --size 16x16 --threshold $t
    echo "| $t | $(field waves_found row.json) | $(field rms_found row.json) | $(field rms_fitted row.json) | $(echo "$(field rms_found row.json) $(field rms_fitted row.json)" | awk '{printf "%.1f %%", 100 - 100 * $2 / $1}') | $(field analysis_s row.json) |"
done
echo
echo '**Waves** of weave, 128 x 128 (Tab. 4.3)'
echo
sample weave 128
"$relume" btf synth weave128.ppm -o x.npy --size 16x16 --waves -q | grep -A 12 '^waves'
echo
echo '**k-coherence**, corduroy as a BTF of 64 x 64 texels, three layers (Tab. 4.5)'
echo
sample corduroy 64
echo '| output | k | neighbourhood | CPU s | novelty | repetition |'
echo '|---|---|---|---|---|---|'
for row in '256 1 3' '256 3 3' '256 6 3' '256 6 5' '512 6 3'; do
    set -- $row
    synth corduroy64 -o x.npy --size "$1x$1" --method pixel --alike "$2" --neighbourhood "$3" --layers 3
    echo "| $1 | $2 | $3 | $(field synthesis_cpu_s row.json) | $(field novelty row.json) | $(field repetition row.json) |"
done
echo
echo '**Materials**, 128 x 128 to 512 x 512; repetition and novelty also as texture_judge.py has them'
echo
echo '| material | structure | period | by | repetition | novelty | judge: repetition | novelty | cuts % | CPU s |'
echo '|---|---|---|---|---|---|---|---|---|---|'
judge() { # sample, picture, periods
    $python "$tools/texture_judge.py" "$@" 2>/dev/null || echo '- -'
}
for m in corduroy weave knit wallpaper stone leather aluminium; do
    sample $m 128
    $python - <<'PYTHON'
import array
with open("tiled.npy", "wb") as f:
    head = "{'descr': '<u4', 'fortran_order': False, 'shape': (512, 512), }"
    f.write(b"\x93NUMPY\x01\x00" + (118).to_bytes(2, "little") + head.ljust(117).encode() + b"\n")
    f.write(array.array("I", [y % 128 * 128 + x % 128 for y in range(512) for x in range(512)]).tobytes())
PYTHON
    for by in tiled patch pixel; do
        case $by in
        tiled) synth ${m}128.ppm -o out.ppm --map tiled.npy ;;
        *) synth ${m}128.ppm -o out.ppm --size 512x512 --method $by ;;
        esac
        x=$(field period row.json) y=$(second period row.json)
        set -- $(judge ${m}128.ppm out.ppm "$x" "$y")
        echo "| $m | $(field share row.json) | $x x $y | $by | $(field repetition row.json) | $(field novelty row.json) | $1 | $2 | $(field cuts row.json | awk '{printf "%.1f", 100 * $1}') | $(field synthesis_cpu_s row.json) |"
    done
    for by in quilt gmic; do
        rm -f out.ppm
        case $by in
        quilt) run="$python $tools/quilt.py ${m}128.ppm out.ppm 512 512 40" ;;
        gmic) run="gmic ${m}128.ppm syntexturize_matchpatch 512,512 round -o out.ppm" ;;
        esac
        took=$(bash -c "TIMEFORMAT=%U; time $run >/dev/null 2>&1" 2>&1) || true
        [ -s out.ppm ] || continue
        set -- $(judge ${m}128.ppm out.ppm "$x" "$y")
        echo "| $m | | | $by | | | $1 | $2 | | $took |"
        cp out.ppm "$m-$by.ppm"
    done
done
echo
echo "**Large**: corduroy of 256 x 256 texels (a BTF) to $side x $side"
echo
echo '| by | repetition | at | novelty | worst | coverage | cuts % | CPU s | MB |'
echo '|---|---|---|---|---|---|---|---|---|'
for by in patch pixel; do
    synth corduroy256 -o large-$by.npy --size "${side}x$side" --method $by
    echo "| $by | $(field repetition row.json) | $(field repetition_at row.json), $(second repetition_at row.json) | $(field novelty row.json) | $(field worst row.json) | $(field coverage row.json) | $(field cuts row.json | awk '{printf "%.1f", 100 * $1}') | $(field synthesis_cpu_s row.json) | $(field peak_mb row.json) |"
done
