#!/bin/sh
# Table 7.1 of Meseth (2008) in its form: billboards and texels of meshes for a given error, by
# clusters and by votes, and how their pictures differ from those of the mesh.
#
#     tests/bench/billboards.sh MESH.obj ... > table.md
set -eu
relume=${RELUME:-build/relume}
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

describe() { # mesh, error or 0
    billboards=""
    [ "$2" = 0 ] || billboards="\"billboards\": $2, "
    printf '{"format": "relume-objects", "version": 1, "objects": [{"mesh": "%s", %s"parts": [{"material": {"diffuse": [0.8, 0.5, 0.3]}}]}]}\n' \
        "$(realpath "$1")" "$billboards"
}

# NAME.SIZE.png under one lamp, NAME.SIZE.pfm under six, which leave nothing black.
render() { # description, name, eye
    for size in 256 64; do
        "$relume" btf render "$1" -o "$work/$2.$size.png" --eye "$3" --picture ${size}x$size --light 'dir -0.6 0.9 0.9' -q 2>/dev/null
        "$relume" btf render "$1" -o "$work/$2.$size.pfm" --eye "$3" --picture ${size}x$size --no-shadows --samples 1 --light 'dir 1 0 0' \
            --light 'dir -1 0 0' --light 'dir 0 1 0' --light 'dir 0 -1 0' --light 'dir 0 0 1' --light 'dir 0 0 -1' -q 2>/dev/null
    done
}

# The pixels that both show, of those that one shows, in percent.
outline() { # size
    python3 -c '
import array, sys
def shown(name):
    f = open(name, "rb")
    f.readline(), f.readline(), f.readline()
    v = array.array("f", f.read())
    return [any(v[i:i + 3]) for i in range(0, len(v), 3)]
a, b = shown(sys.argv[1]), shown(sys.argv[2])
print("%.1f" % (100 * sum(x and y for x, y in zip(a, b)) / sum(x or y for x, y in zip(a, b))))' "$work/mesh.$1.pfm" "$work/cloud.$1.pfm"
}

field() { sed -n "s/.*\"$1\": \([-0-9.e+]*\).*/\1/p" "$2"; }
psnr() { "$relume" compare "$1" "$2" | awk '$1 == "psnr_db" { printf "%.1f", $2 }'; }

echo '| mesh | error % | clusters | texels | s | greedy | texels | s | dB, 256 px | outline % | dB, 64 px | outline % |'
echo '|---|---|---|---|---|---|---|---|---|---|---|---|'
for mesh; do
    describe "$mesh" 0 >"$work/mesh.json"
    # from beside and above, far enough for any of the models
    eye=$(awk '$1 == "v" { for (i = 2; i < 5; i++) { if (!n || $i < low[i]) low[i] = $i; if (!n || $i > high[i]) high[i] = $i } n = 1 }
        END { for (i = 2; i < 5; i++) if (high[i] - low[i] > s) s = high[i] - low[i]
            printf "%g,%g,%g", (low[2] + high[2]) / 2 - 2 * s, (low[3] + high[3]) / 2 + s, (low[4] + high[4]) / 2 + 3 * s }' "$mesh")
    render "$work/mesh.json" mesh "$eye"
    for error in 0.04 0.02 0.01 0.005; do
        for method in clusters greedy; do
            "$relume" mesh billboards "$mesh" --error $error --method $method -o "$work/$method.obj" --json -q >"$work/$method.json" 2>/dev/null
        done
        describe "$mesh" $error >"$work/cloud.json"
        render "$work/cloud.json" cloud "$eye"
        c="$work/clusters.json" g="$work/greedy.json"
        printf '| %s | %s | %s | %s | %.1f | %s | %s | %.1f | %s | %s | %s | %s |\n' "$(basename "$mesh" .obj)" \
            "$(awk "BEGIN { print 100 * $error }")" "$(field billboards "$c")" "$(field texels "$c")" "$(field seconds "$c")" \
            "$(field billboards "$g")" "$(field texels "$g")" "$(field seconds "$g")" \
            "$(psnr "$work/mesh.256.png" "$work/cloud.256.png")" "$(outline 256)" "$(psnr "$work/mesh.64.png" "$work/cloud.64.png")" "$(outline 64)"
    done
done
