# format.sh - sourced by the test_format scripts after lib.sh: the second reader, written from
# docs/format.md alone (tests/tools/decode.c), against the library.
decode="$BUILD/tests/tools/decode"
size=24 lights="1,0.5,1 -0.3,-0.2,0.1 0.2,1,0.05 1,0,-0.3"

# Weights are single precision in the library and double here; the table's codes span [0, 1], the
# coefficients of sh a few units: 2e-6 is 2^-19.
tolerance=2e-6
near() { # numbers, numbers
    awk -v a="$1" -v b="$2" -v tolerance=$tolerance 'BEGIN {
        n = split(a, x, " "); m = split(b, y, " ")
        for (i = 1; i <= n; i++) {
            d = x[i] - y[i]; size = y[i] < 0 ? -y[i] : y[i]
            if (d < 0) d = -d
            if (!(d <= tolerance * (1 + size))) bad = 1
        }
        exit !(n == 3 && m == 3 && !bad) }'
}

# of a slab whose window is 2 x 2: the ray of a camera and a pixel
slab_ray() { awk -v u="$1" -v v="$2" -v x="$3" -v y="$4" -v n=$size 'BEGIN {
    s = -1 + 2 * (x + .5) / n; t = 1 - 2 * (y + .5) / n
    printf "--eye %g,%g,3 --direction %.9f,%.9f,-3", u, v, s - u, t - v }'; }

agree() { # name, file, view, query's eye and direction, x, y
    for light in $lights; do
        light=$(echo $light | tr , " ")
        ours=$("$decode" "$2" "$3" $5 $6 $light 2>&1)
        theirs=$("$RELUME" query "$2" $4 --light "dir $light" -q 2>/dev/null)
        if ! near "$ours" "$theirs"; then
            not_ok "$1" "dir $light: decoded '$ours', the library says '$theirs'"
            return
        fi
    done
    ok "$1"
}

# The ray of a planar file's pixel: the window is [-1, 1] for square images.
planar() { awk -v x="$1" -v y="$2" -v n=$size 'BEGIN {
    printf "--eye %.9f,%.9f,4 --direction 0,0,-1", -1 + 2 * (x + .5) / n, 1 - 2 * (y + .5) / n }'; }

both() { # encode's words; x y
    if "$RELUME" encode $1 -o one.exr -q 2>err.txt; then
        agree "$1" one.exr 0 "$(planar $2)" $2
    else
        not_ok "$1" "$(cat err.txt)"
    fi
}
"$sphere" dome --size $size --lights 30 --hemisphere
"$sphere" all --size $size --lights 40 --intensities --mask
"$sphere" photos --size $size --lights 30 --hemisphere --format png
