#!/bin/sh
# relume bench: its form, never its times.
. "$(dirname "$0")/lib.sh"
if [ "$config" != release ]; then
    skip "relume bench" "sanitizers take a minute for it"
    finish
    exit
fi
expect_ok 'one round' - "$RELUME" bench --rounds 1 --threads 2
mv out.txt text.txt
check 'says version, threads and instructions' grep -qE '^relume [0-9.]+, 2 threads, (avx512|avx2|neon|plain)' text.txt
for loop in read 'multiply and add' relight copy look-up apply 'nearest code' resampling 'glare FFT' \
    'web-plane trellis' "eye's pattern" glare; do
    check "$loop has a row" grep -qE "^$loop +[0-9.]+ +[0-9.]+ - [0-9.]+ " text.txt
done
check 'compares with reading and memcpy' grep -qE '^Relighting reaches [0-9.]+ of the speed of reading' text.txt
check 'an empty RELUME_CPU asks for nothing' sh -c 'RELUME_CPU= "$0" bench --rounds 1 --json >out.json' "$RELUME"
check 'RELUME_CPU is obeyed' sh -c 'RELUME_CPU=plain "$0" bench --rounds 1 | grep -q ", plain"' "$RELUME"
if [ "$python" ]; then
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
expect_fail 'no mesh' 1 'missing.ply' - "$RELUME" bench reflections missing.ply
awk -v n=12 -f "$TOP/scripts/ball.awk" >ball.obj
"$RELUME" bench reflections ball.obj >text.txt
for method in 'Bezier patch' '4 x 4 x 2 triangles' '64 x 64 x 2 triangles'; do
    check "$method has a row" grep -qE "^$method +[0-9.]+ +[0-9.-]+ +[0-9.]+e-[0-9]+ +20000$" text.txt
done
check 'the mesh is named' grep -qE '^200000 rays off a mirror ball to ball.obj, [0-9]+ triangles$' text.txt
check 'the ray tracer has a row' grep -qE '^ray tracer, exact +[0-9.]+ +-( +[0-9.]+){4} +- +-$' text.txt
check 'an octree has a row' grep -qE '^octree of depth 9, cone +[0-9.]+ +[0-9]+( +[0-9.]+){5} +0.[0-9]+$' text.txt
check 'help names the task' sh -c '"$0" bench --help | grep -q "^  reflections "' "$RELUME"
if [ "$python" ]; then
    "$RELUME" bench reflections --json >out.json
    check 'one JSON object of reflections' "$python" - out.json <<'EOF'
import json, sys
b = json.load(open(sys.argv[1]))
patch, *triangles = b["mirror"]
assert patch["method"] == "patch" and patch["error"] < 1e-9 and 1 < patch["iterations"] < 32
assert [t["triangles"] for t in triangles] == [32, 512, 8192]
for coarse, fine in zip(triangles, triangles[1:]):  # four times as fine: the error falls by about 16
    assert 8 < coarse["error"] / fine["error"] < 32, (coarse, fine)
assert all(m["found"] == b["positions"] == 20000 and m["seconds"] > 0 for m in b["mirror"])
(mesh,) = b["meshes"]
tracer, *octrees = mesh["tracing"]
assert mesh["name"] == "teapot" and mesh["triangles"] == 16384
assert tracer["method"] == "tracer" and tracer["error"] is None
assert [(o["depth"], o["cone"]) for o in octrees] == [(d, c) for d in (7, 8, 9) for c in (False, True)]
full = [o for o in octrees if not o["cone"]]
for coarse, fine in zip(full, full[1:]):  # cells of half the side
    assert 1.5 < coarse["error"] / fine["error"] < 2.5 and fine["bytes"] > 2 * coarse["bytes"], (coarse, fine)
assert all(o["one_only"] < 0.01 and o["rays_per_second"] > 0 for o in octrees)
EOF
fi
expect_fail 'no input' 2 'bench: expected' - "$RELUME" bench x.exr
expect_fail 'no rounds' 2 'rounds' - "$RELUME" bench --rounds 0
expect_fail 'instructions that nobody has' 2 'RELUME_CPU: expected plain.*found sse9' - env RELUME_CPU=sse9 "$RELUME" bench
finish
