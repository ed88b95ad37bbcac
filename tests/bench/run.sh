#!/bin/sh
# `make bench`: ratios measured in one run on one machine. Prints, never judges.
set -eu
uname -sm
grep -m1 'model name' /proc/cpuinfo || true
for b in "$1"/tests/bench/bench_*; do
    [ -x "$b" ] && [ -f "$b" ] && "$b"
done
python=$(command -v /usr/bin/python3 || command -v python3 || true)
if [ "$python" ]; then "$python" "$(dirname "$0")/bench_codebook.py" "$1"; else echo 'skipped: bench_codebook.py: no python3'; fi
