#!/bin/sh
# What people see of a difference, studies, simplified meshes: from the command line.
. "$(dirname "$0")/lib.sh"

field() { grep -o "\"$2\": [-0-9.e+]*" "$1" | head -1 | sed 's/.*: //'; } # file, name
below() { check "$1" awk -v a="$2" -v b="$3" 'BEGIN { exit !(a != "" && a < b) }'; }

# ---- compare
"$RELUME" synth teapot -q -o s --lights 1 --size 64 --samples 1
picture=$(find s -name 'light*' | head -1)
"$RELUME" compare "$picture" "$picture" --jnd --json >same.json
check 'a picture is itself' grep -q '"jnd_max": 0,' same.json
"$RELUME" compare "$picture" "$picture" --metric vdp -o map.png --json >vdp.json
check 'nothing is seen of no difference' grep -q '"p75": 0, "p95": 0' vdp.json
check 'the map is a picture' test -s map.png
cat >ramp.py <<'END'
import sys
w, h, k = 64, 64, float(sys.argv[2])
body = b''.join(bytes([min(255, int(40 + 120 * (x / w) * k + (x * 7 + y * 13) % 40)), min(255, int(60 + y * k)), 90]) for y in range(h) for x in range(w))
open(sys.argv[1], 'wb').write(b'P6 64 64 255\n' + body)
END
if [ "$python" ]; then
    "$python" ramp.py a.ppm 1.0 && "$python" ramp.py b.ppm 1.05 && "$python" ramp.py c.ppm 1.3
    for p in b c; do "$RELUME" compare a.ppm $p.ppm --jnd --json >$p.json; done
    below 'more difference is seen more' "$(field b.json jnd_mean)" "$(field c.json jnd_mean)"
    "$RELUME" compare a.ppm c.ppm --jnd --fit-colours --json >fit.json
    below 'colours are fitted' "$(field fit.json jnd_mean)" "$(field c.json jnd_mean)"
    "$RELUME" compare a.ppm c.ppm --jnd --reduce 8 --grey --json >grey.json
    check 'reduced and grey' grep -q '"jnd_mean"' grey.json
    printf 'P6 1 1 255\nabc' >dot.ppm
fi
expect_fail 'two metrics' 2 'choose one' - "$RELUME" compare "$picture" "$picture" --jnd --metric vdp
expect_fail 'distance without a metric' 2 'need --metric' - "$RELUME" compare "$picture" "$picture" --pixels-per-degree 30
if [ "$python" ]; then expect_fail 'reduced to nothing' 1 'leaves nothing' - "$RELUME" compare dot.ppm dot.ppm --reduce 64 --jnd; fi

# ---- study
mkdir -p plain glare films/y
for s in x y; do cp "$picture" plain/$s.exr 2>/dev/null || cp "$picture" plain/$s.png; done
cp plain/* glare
cp "$(ls plain/x.* | head -1)" films/
for i in 0 1; do cp "$picture" films/y/$i."${picture##*.}"; done
"$RELUME" study make none=plain static=glare moving=films -o study --question 'Brighter </script>?' --seed 4
check 'the frames of a film' test -s study/moving/y/0001.png
"$RELUME" study run study --subject 1 -o one.html && "$RELUME" study run study --subject 1 -o again.html &&
    "$RELUME" study run study --subject 2 -o two.html
check 'one subject, one order' cmp one.html again.html
check 'another subject, another order' sh -c '! cmp -s one.html two.html'
check 'every pair of every scene' test "$(grep -c 'question: 0, scene' one.html)" -eq 6
check 'a question does not end the script' test "$(grep -c '</script>' one.html)" -eq 1
check 'nothing is loaded' sh -c '! grep -qE "https?://" one.html'
printf 'subject,question,left,right,chosen\n1,q,a,b,a\n2,q,b,a,a\n3,q,a,b,a\n4,q,a,b,b\n' >answers.csv
"$RELUME" study analyse answers.csv --json >answers.json
check 'three of four' grep -q '"wins": \[0, 3, 1, 0\]' answers.json
check 'chi squared of 3 to 1' grep -q '"chi_squared": \[0, 1, 1, 0\]' answers.json
mkdir upper && for s in x y; do cp "$picture" upper/$s."$(printf %s "${picture##*.}" | tr a-z A-Z)"; done
expect_ok 'endings in capitals' - "$RELUME" study make a=plain b=upper -o capitals
check 'both pictures of them' test -s capitals/b/x.png -a -s capitals/b/y.png
expect_fail 'a condition without a scene' 1 "no picture of 'y'" bad sh -c 'rm glare/y.*; exec "$0" study make a=plain b=glare -o bad' "$RELUME"
expect_fail 'no folder' 2 'NAME=FOLDER' bad "$RELUME" study make plain glare -o bad
expect_fail 'no study' 1 'study.json' no.html "$RELUME" study run plain -o no.html
expect_fail 'no answers' 1 'line 1' - "$RELUME" study analyse study/study.json

# ---- mesh simplify
cat >grid.awk <<'END'
BEGIN {
    for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) printf "v %g %g %g\n", i / n, j / n, 0.1 * sin(6 * i / n)
    for (j = 0; j < n; j++) for (i = 1; i <= n; i++) {
        a = j * (n + 1) + i
        printf "f %d %d %d %d\n", a, a + 1, a + n + 2, a + n + 1
    }
}
END
awk -v n=30 -f grid.awk >grid.obj
"$RELUME" mesh simplify grid.obj -o small.ply --error 0.002 --steps steps.csv --json >small.json
below 'fewer triangles' "$(field small.json triangles)" 500
below 'within the error' "$(field small.json error)" 0.0020001
check 'what went where' grep -q '^vertex,onto,error,distance$' steps.csv
"$RELUME" mesh simplify grid.obj -o n.glb --triangles 100 -q && "$RELUME" mesh n.glb -o n.obj --json >n.json
below 'as many as asked for' "$(field n.json triangles)" 101
expect_fail 'unknown format' 2 'no.xyz' no.xyz "$RELUME" mesh simplify grid.obj -o no.xyz --error 0.01
awk -v n=70 -f grid.awk >large.obj
expect_ok 'little memory: in parts' 'in parts of' "$RELUME" mesh simplify large.obj -o parts.ply --error 0.002 --max-memory 900K
expect_fail 'no memory' 1 'max-memory' no.ply "$RELUME" mesh simplify grid.obj -o no.ply --error 0.01 --max-memory 100k
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 1 2\nf 3 3 3\n' >line.obj
expect_fail 'no triangles' 1 'no triangle' no.ply "$RELUME" mesh simplify line.obj -o no.ply --error 0.01
finish
