#!/bin/sh
# relume bench: its form, never its times.
. "$(dirname "$0")/lib.sh"
if [ "$config" != release ]; then
    skip "relume bench" "sanitizers take a minute for it"
    finish
    exit
fi
expect_ok 'one round' - "$RELUME" bench --rounds 1 --threads 2
"$RELUME" bench --rounds 1 --threads 2 >text.txt
check 'says version, threads and instructions' grep -qE '^relume [0-9.]+, 2 threads, (avx512|avx2|neon|plain)' text.txt
for loop in read 'multiply and add' relight copy look-up apply 'nearest code' resampling 'glare FFT' \
    'web-plane trellis' "eye's pattern" glare; do
    check "$loop has a row" grep -qE "^$loop +[0-9.]+ +[0-9.]+ - [0-9.]+ " text.txt
done
check 'compares with reading and memcpy' grep -qE '^Relighting reaches [0-9.]+ of the speed of reading' text.txt
check 'an empty RELUME_CPU asks for nothing' env RELUME_CPU= "$RELUME" bench --rounds 1 --json
check 'RELUME_CPU is obeyed' sh -c 'RELUME_CPU=plain "$0" bench --rounds 1 | grep -q ", plain"' "$RELUME"
if [ "$python" ]; then
    "$RELUME" bench --rounds 1 --json >out.json
    check 'one JSON object' "$python" - out.json <<'EOF'
import json, math, sys
b = json.load(open(sys.argv[1]))
for name in "version processor instructions threads read_gb_s gflop_s relight_of_reading look_up_of_memcpy loops".split():
    assert name in b, name
assert len({l["name"] for l in b["loops"]}) == len(b["loops"]) == 12
for l in b["loops"]:
    assert l["runs"] == 1 and l["least_seconds"] <= l["seconds"] <= l["most_seconds"], l
    for name in "seconds bytes flops gb_s gflop_s share readme_seconds".split():
        assert l[name] is None or math.isfinite(l[name]) and l[name] >= 0, (l["name"], name)
    # what a loop needs at least, over its time, is its speed
    if l["bytes"]:
        assert abs(l["gb_s"] * l["seconds"] * 1e9 / l["bytes"] - 1) < 1e-6, l
    else:
        assert l["gb_s"] is None, l
read, sums = b["loops"][0], b["loops"][1]
assert abs(read["share"] - 1) < 1e-6 and abs(sums["share"] - 1) < 1e-6
EOF
fi
expect_fail 'no input' 2 'bench: expected' - "$RELUME" bench x.exr
expect_fail 'no rounds' 2 'rounds' - "$RELUME" bench --rounds 0
expect_fail 'instructions that nobody has' 2 'RELUME_CPU: expected plain.*found sse9' - env RELUME_CPU=sse9 "$RELUME" bench
finish
