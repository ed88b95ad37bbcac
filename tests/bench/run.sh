#!/bin/sh
# `make bench`: ratios measured in one run on one machine. Prints, never judges.
set -eu
uname -sm
grep -m1 'model name' /proc/cpuinfo || true
"$1/relume" bench
RELUME_CPU=plain "$1/relume" bench
for b in "$1"/tests/bench/bench_*; do
    [ -x "$b" ] && [ -f "$b" ] && "$b"
done

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

# a view of a megapixel relit again
"$1/relume" synth box -q -o "$dir/box" --lights 25 --hemisphere --size 1024 --samples 1
"$1/relume" encode -q "$dir/box" -o "$dir/box.exr" --basis sh --coefficients 25
"$1/tests/bench/bench_renderer" "$dir/box.exr"

# from the name of a slab to its first picture
"$1/relume" synth teapot -q -o "$dir/teapot" --views 4x4 --lights 12 --size 96 --samples 1
"$1/relume" encode -q "$dir/teapot" -o "$dir/teapot.exr" --codebook 256 --share --coefficients 9
"$1/tests/bench/bench_viewer" open "$dir/teapot.exr"

python=$(command -v /usr/bin/python3 || command -v python3 || true)
if [ "$python" ]; then "$python" "$(dirname "$0")/bench_codebook.py" "$1"; else echo 'skipped: bench_codebook.py: no python3'; fi
