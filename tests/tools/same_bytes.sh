#!/bin/bash
# same_bytes.sh OLD NEW - two relume programs give the same bytes: some forty calls of encode, relight, query,
# eval, export, sweep and btf over small captures; each difference is named. Ends with 1 where there is one.
set -u
old=$1 new=$2 keep=${3:-}
dir=${keep:-$(mktemp -d)}
mkdir -p "$dir"
[ -n "$keep" ] || trap 'rm -rf "$dir"' EXIT
here=$(cd "$(dirname "$0")" && pwd)

make_captures() {
    "$old" synth box -q -o "$dir/plain" --size 48 --lights 30 --hemisphere --samples 2
    "$old" synth teapot -q -o "$dir/slab" --size 32 --views 3x3 --lights 20 --samples 1
    "$old" synth attic -q -o "$dir/room" --size 32 --lights 40 --samples 1
    "$old" synth bust -q -o "$dir/ring" --size 24 --slabs 4 --views 3x3 --lights 16 --samples 1
    local data=$here/../../../shared/tools/rti_dataset.py
    if [ -f "$data" ] && python3 "$data" "$dir/dome" --size 128 --lights 33 >"$dir/dome.log" 2>&1; then
        dome=$dir/dome/capture
    else
        dome=$dir/plain
    fi
}

# calls PROGRAM: what is compared; each line is NAME: arguments, written to $o
calls() {
    local p=$1 o=$2 i=$2/in
    mkdir -p "$o" "$i"
    one() { local name=$1; shift; timeout 300 "$p" "$@" -q >"$o/$name.out" 2>"$o/$name.err" || echo "status $?" >>"$o/$name.out"; }
    one encode-auto encode "$dome" -o "$i/auto.exr"
    one encode-pca encode "$dir/plain" -o "$i/pca.exr" --basis pca --coefficients 9
    one encode-table encode "$dir/plain" -o "$i/table.exr" --basis table --bits 12 --compression zip
    one encode-sh encode "$dir/plain" -o "$i/sh.exr" --basis sh --coefficients 16 --bits half
    one encode-hsh encode "$dome" -o "$i/hsh.exr" --basis hsh --domain display --bits 10 --robust
    one encode-ptm encode "$dome" -o "$i/ptm.exr" --basis ptm --colour luminance --bits 16
    one encode-dct encode "$dir/room" -o "$i/dct.exr" --basis dct --bits log --step common
    one encode-float encode "$dir/plain" -o "$i/float.exr" --basis pca --coefficients 6 --bits float
    one encode-resampled encode "$dir/room" -o "$i/resampled.exr" --basis dct-resampled
    one encode-book encode "$dir/plain" -o "$i/book.exr" --basis sh --coefficients 9 --codebook 64
    one encode-split encode "$dome" -o "$i/split.exr" --basis pca --coefficients 9 --codebook 64 --stages 2 --split product:3 --bits 16
    one encode-luma encode "$dome" -o "$i/luma.exr" --basis ptm --codebook 64 --split luma
    one encode-slab encode "$dir/slab" -o "$i/slab.exr" --basis pca --coefficients 9
    one encode-shared encode "$dir/slab" -o "$i/shared.exr" --basis sh --coefficients 9 --codebook 64 --share
    one encode-room encode "$dir/room" -o "$i/room.exr" --basis sh --coefficients 16
    one encode-ring encode "$dir/ring" -o "$i/ring.exr" --basis sh --coefficients 9
    for f in auto pca table sh hsh ptm dct float resampled book split luma; do
        one "relight-$f" relight "$i/$f.exr" -o "$o/relight-$f.exr" --light "dir 1 0.3 0.7" --light "dir -1 0 1 rgb 0.3 0.2 0.1"
    done
    for f in auto pca hsh ptm book split float dct; do
        one "near-$f" relight "$i/$f.exr" -o "$o/near-$f.exr" --assume-depth 4 --light "point 1 1 1" --light "spot -1 0 2 0.5 0 -1 30 rgb 1 0.5 0.2"
    done
    one env-hsh relight "$i/hsh.exr" -o "$o/env-hsh.exr" --light "env $dir/sky.pfm"
    one env-book relight "$i/book.exr" -o "$o/env-book.exr" --light "env $dir/sky.pfm"
    one env-slab relight "$i/slab.exr" -o "$o/env-slab.exr" --light "env $dir/sky.pfm"
    one area relight "$i/slab.exr" -o "$o/area.exr" --light "area 0 0 3 0 1 0 1 0 0"
    for c in normals specular diffuse-gain unsharp; do
        one "pass-$c" relight "$i/auto.exr" -o "$o/pass-$c.png" --pass $c --light "dir 1 0.3 0.7"
    done
    one png relight "$i/auto.exr" -o "$o/png.png" --light "dir 1 0.3 0.7" --tone filmic
    one slab relight "$i/slab.exr" -o "$o/slab.exr" --eye 0.1,0.2,3 --light "dir 1 0.3 0.7"
    one slab-linear relight "$i/slab.exr" -o "$o/slab-linear.exr" --eye 0.1,0.2,2.5 --interpolate linear
    one slab-lens relight "$i/slab.exr" -o "$o/slab-lens.exr" --eye 0.1,0.2,3 --aperture 0.2 --focus 0
    one shared relight "$i/shared.exr" -o "$o/shared.exr" --eye 0.1,0.2,3
    one room relight "$i/room.exr" -o "$o/room.exr" --pan 30 --tilt 10 --size 64x48
    one planet relight "$i/room.exr" -o "$o/planet.exr" --projection planet --size 64
    one ring relight "$i/ring.exr" -o "$o/ring.exr" --eye 2,0.5,2
    one query-slab query "$i/slab.exr" --eye 0.1,0.2,3 --direction 0,0,-1 --json
    one query-linear query "$i/slab.exr" --eye 0.13,0.21,3 --direction 0,-0.1,-1 --interpolate linear --json --light "point 1 1 2"
    one query-nearest query "$i/slab.exr" --eye 0.13,0.21,3 --direction 0,-0.1,-1 --interpolate constant --json
    one query-shared query "$i/shared.exr" --eye 0.13,0.21,3 --direction 0,-0.1,-1 --json
    one query-room query "$i/room.exr" --eye 0,0,0 --direction 0.3,0.1,-1 --json
    one query-pca query "$i/pca.exr" --eye 0.1,0.2,4 --direction 0,0,-1 --json --light "env $dir/sky.pfm"
    one query-ring query "$i/ring.exr" --eye 2,0.5,2 --direction -2,-0.5,-2 --json
    one query-rays query "$i/slab.exr" --rays "$dir/rays.txt"
    one query-rays-room query "$i/room.exr" --rays "$dir/rays0.txt"
    one query-rays-ring query "$i/ring.exr" --rays "$dir/rays.txt"
    one eval-pca eval "$i/pca.exr" "$dir/plain" --json
    one eval-hsh eval "$i/hsh.exr" "$dome" --json
    one export-relight export "$i/auto.exr" --to relight -o "$o/web"
    one export-rbf export "$i/pca.exr" --to relight --type rbf --colorspace mycc -o "$o/web-rbf"
    one export-ptm export "$i/ptm.exr" -o "$o/export.ptm"
    one export-rti export "$i/hsh.exr" -o "$o/export.rti"
    one export-tiles export "$i/auto.exr" --to deepzoom --type hsh -o "$o/tiles"
    one export-float export "$i/float.exr" -o "$o/float.rti"
    one import import "$o/export.ptm" -o "$i/import.exr"
    one import-web import "$o/web" -o "$i/import-web.exr"
    one sweep sweep "$dir/plain" --basis pca,hsh,sh --bits 8,12,half --leave-out 10 --json
    one sweep-books sweep "$dir/plain" --basis sh --codebook 0,32 --leave-out 15 --json
    one sweep-log sweep "$dome" --basis ptm --bits 10,half --step common --leave-out 16 --json
    for m in rfp rfnl rfnlc vpca lpca cmf fmf qmf laf; do
        one "btf-$m" btf fit corduroy --size 8 --directions coarse --model $m --clusters 4 --components 2 -o "$o/btf-$m"
        one "btf-render-$m" btf render "$o/btf-$m" -o "$o/render-$m.exr" --eye 0.3,0.2,1 --light "dir 1 0 1"
    done
    one btf-compare btf compare corduroy --size 8 --directions coarse --models rfnl,vpca --leave-out 5 --json
    one btf-tile btf tile corduroy --size 32 --directions coarse --model rfp --tile 16 --tiles 4 --matrix 4x4 -o "$o/surface"
    one btf-render btf render "$o/surface" -o "$o/surface.exr" --camera 0,-2,2 --picture 64x48
    for f in "$i"/*.exr; do
        "$p" info "$f" >"$o/info-$(basename "$f" .exr).out" 2>&1
    done
}

hashes() {
    # times are not the same twice
    sed -i -E 's/"([a-z_]*seconds|[a-z_]*per_second)": [-+.e0-9]+//g' "$1"/*.out
    (cd "$1" && find . -type f ! -name '*.err' | LC_ALL=C sort | xargs sha256sum | sed "s|$1||")
}

if [ ! -d "$dir/plain" ]; then
    make_captures
    python3 - "$dir" <<'PY' 2>/dev/null || exit 3
import struct, sys, math, random
d = sys.argv[1]
with open(d + "/sky.pfm", "wb") as f:
    f.write(b"PF\n16 8\n-1.0\n")
    for y in range(8):
        for x in range(16):
            f.write(struct.pack("<3f", 0.2 + y / 8.0, 0.3 + x / 32.0, 0.5 + (4.0 if (x, y) == (5, 6) else 0.0)))
random.seed(1)
def rays(name, eye):
    with open(d + "/" + name, "w") as f:
        for i in range(200):
            e = [random.uniform(-.4, .4), random.uniform(-.4, .4), 3.0] if eye else [0, 0, 0]
            t = [random.uniform(-1, 1) for _ in range(3)]
            v = [t[0] - e[0], t[1] - e[1], -e[2]] if eye else t
            f.write(" ".join("%.6f" % q for q in e + v) + "\n")
rays("rays.txt", True)
rays("rays0.txt", False)
PY
fi
[ -d "$dir/dome/capture" ] && dome=$dir/dome/capture || dome=$dir/plain
# the same paths in both runs: names stand in messages
run() {
    rm -rf "$dir/out"
    calls "$1" "$dir/out"
    hashes "$dir/out" >"$dir/$2.sums"
    rm -rf "$dir/was-$2"
    mv "$dir/out" "$dir/was-$2"
}
[ -n "$keep" ] && [ -f "$dir/old.sums" ] || run "$old" old
run "$new" new
failed=$(grep -ls '^status' "$dir"/was-old/*.out | xargs -rn1 basename)
[ -z "$failed" ] || echo "calls that fail with both: $failed"
if diff "$dir/old.sums" "$dir/new.sums" >"$dir/differences"; then
    echo "$(wc -l <"$dir/old.sums") outputs are the same"
else
    grep '^[<>]' "$dir/differences" | awk '{print $3}' | sort -u | sed 's/^/differs: /'
    exit 1
fi
