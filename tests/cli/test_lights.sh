#!/bin/sh
# Every kind of light on the command line, on a sphere and a slab whose pixels are known; rigs; what
# is refused.
. "$(dirname "$0")/lib.sh"
diff() { "$mkimage" maxdiff "$1" "$2"; }
at() { # eye x, eye y, options...: r g b of a planar file there
    x=$1 y=$2
    shift 2
    "$RELUME" query full.exr --eye "$x,$y,4" --direction 0,0,-1 "$@" 2>err.txt
}
green() { at "$@" | cut -d' ' -f2; }
picture() { # NAME: a PNG of the PPM on stdin
    cat >"ppm/$1" && "$mkimage" png 8 3 . "ppm/$1"
}
mkdir ppm

"$sphere" full --size 32 --lights 60 --hemisphere || exit 1
relume encode full -o full.exr --basis sh --coefficients 9 --bits 16
cat >lamp.ies <<'IES'
IESNA:LM-63-1995
[TEST] a narrow lamp
TILT=NONE
1 1000 1 3 1 1 2 0 0 0
1 1 10
0 10 20
0
100 50 0
IES

# ---- a light far away is a distant one
relume relight full.exr -o dir.exr --light "dir 1 2 3"
relume relight full.exr -o far.exr --light "point 1000 2000 3000 nofall"
below 'point from afar is dir' "$(diff dir.exr far.exr)" 2e-3 # 1e-3 each: parallax, weight grid
relume relight full.exr -o far.exr --light "point 1000 2000 3000 rgb 14000000 14000000 14000000"
below 'its value falls with the square' "$(diff dir.exr far.exr)" 5e-3
# the ellipse has pi |u x v| = pi 11.225; its distance is sqrt 140000: radiance 12472 gives 1
relume relight full.exr -o far.exr --light "area 100 200 300 0 3 -2 3 0 -1 disc rgb 12472 12472 12472"
below 'area from afar is dir' "$(diff dir.exr far.exr)" 5e-3
relume relight full.exr -o sum.exr --light "dir 1 2 3" --light "spot 0 0 3 0 0 -1 15"
above 'two lights are more than one' "$(diff dir.exr sum.exr)" 0.05

# ---- where it shines
nothing() { # name, three numbers
    check "$1" test "$2" = '0 0 0'
}
nothing 'an area turned round' "$(at 0 0 --light "area 100 200 300 3 0 -1 0 3 -2 rgb 12472 12472 12472")"
expect_ok 'which is said' 'light 2 shines away from all that is seen; exchange the two half edges' \
    "$RELUME" relight full.exr -o away.exr --light "dir 1 2 3" --light "area 0 0 2 1 0 0 0 1 0"
expect_ok 'as it should be' - "$RELUME" relight full.exr -o away.exr --light "area 0 0 2 0 1 0 1 0 0"
nothing 'outside the cone nothing' "$(at 0.9 0.9 --light "spot 0 0 3 0 0 -1 15")"
above 'inside there is' "$(green 0.05 0.05 --light "spot 0 0 3 0 0 -1 15")" 0.01
above 'ies along its axis' "$(green 0 0 --light "ies 0 0 3 0 0 -1 lamp.ies")" 0.01
nothing 'ies beside it' "$(at 0.95 0.9 --light "ies 0 0 2 0 0 -1 lamp.ies")"
printf 'P3\n2 1\n255\n255 0 0 0 255 0\n' | picture 'a slide.png'
slide="slide 0 0 3 0 0 -1 20 'a slide.png'"
at -0.5 0.1 --light "$slide" >left.txt
at 0.5 0.1 --light "$slide" >right.txt
check 'slide: red is left' awk '{ exit !($1 > 0.01 && $2 < $1 / 20) }' left.txt
check 'slide: green is right' awk '{ exit !($2 > 0.01 && $1 < $2 / 20) }' right.txt
# six faces +x -x +y -y +z -z, white (1) where the point light shall be the same; only the last is ahead
printf 'P3\n6 1\n255\n%s\n' "$(yes '255 255 255' | head -n 6)" | picture ball.png
printf 'P3\n6 1\n255\n%s\n255 255 255\n' "$(yes '0 0 0' | head -n 5)" | picture ahead.png
relume relight full.exr -o point.exr --light "point 0 0 3"
relume relight full.exr -o gonio.exr --light "gonio 0 0 3 1 2 3 ball.png"
below 'gonio: all directions alike' "$(diff point.exr gonio.exr)" 1e-6
above 'gonio: ahead' "$(green 0 0 --light "gonio 0 0 3 0 0 -1 ahead.png")" 0.01
nothing 'gonio: behind' "$(at 0 0 --light "gonio 0 0 3 0 0 1 ahead.png")"

# ---- environments: white in the half of +x; turned by 90 degrees it is that of +z
"$sphere" lambert --size 32 --lights 100 --hemisphere --shade lambert
relume encode lambert -o full.exr --basis sh --coefficients 16 --bits 16
{ echo P3 48 24 255; yes "$(printf '0 0 0 %.0s' $(seq 24))$(printf '255 255 255 %.0s' $(seq 24))" | head -n 24; } | picture half.png
{ echo P3 48 24 255; yes "$(printf '255 255 255 %.0s' $(seq 48))" | head -n 24; } | picture white.png
ratio() { # light, light, x, y: how much brighter the first is
    echo "$(green "$3" "$4" --light "$1") $(green "$3" "$4" --light "$2")" | awk '{ print $1 / $2 }'
}
near() { # name, number, expected, tolerance
    below "$1" "$(awk -v a="$2" -v b="$3" 'BEGIN { d = a - b; print d < 0 ? -d : d }')" "$4"
}
near 'a white sky is 1 where the surface faces the pole' "$(ratio 'env white.png' 'dir 0 0 1' 0 0)" 1 0.02
near 'so is the half of +z' "$(ratio 'env half.png 90' 'dir 0 0 1' 0 0)" 1 0.02
near 'half a sky is half' "$(ratio 'env half.png' 'env white.png' 0 0)" 0.5 0.02
above 'light from the right' "$(ratio 'env half.png' 'env half.png 180' 0.3 0)" 2
above 'turned it comes from the left' "$(ratio 'env half.png 180' 'env half.png' -0.3 0)" 2
nothing 'behind the surface there is none' "$(at 0 0 --light 'env half.png -90')"
relume encode lambert -o shown.exr --basis sh --coefficients 16 --bits 16 --domain display
relume relight full.exr -o a.exr --light 'env half.png 30 rgb 0.5 0.6 0.7' --light 'dir 0 1 1'
relume relight shown.exr -o b.exr --light 'env half.png 30 rgb 0.5 0.6 0.7' --light 'dir 0 1 1'
below 'display and linear files agree' "$(diff a.exr b.exr)" 0.1 # sh 16 of a cosine, twice
printf 'P3\n3 1\n255\n9 9 9 9 9 9 9 9 9\n' | picture odd.png
expect_ok 'a map that is not 2:1' 'odd.png: 3 x 1 pixels; expected a map twice as wide' \
    "$RELUME" relight full.exr -o b.exr --light 'env odd.png'

# ---- 10,000 lights, any number of threads
awk 'BEGIN { print "{ \"format\": \"relume-rig\", \"version\": 1, \"lights\": [";
    for (i = 0; i < 10000; i++) printf "%s{ \"light\": \"dir %g %g 1\", \"intensity\": 1e-4 }\n",
        i ? "," : "", cos(i) / 2, sin(i) / 2; print "] }" }' >many.json
relume relight full.exr -o many.exr --rig many.json
relume relight full.exr -o one.exr --light 'dir 0.5 0 1'
above '10,000 lights' "$(diff one.exr many.exr)" 0.05
below 'are about one of each' "$(diff one.exr many.exr)" 2
for threads in 1 3; do
    "$RELUME" relight full.exr -o "t$threads.exr" --threads $threads --light "$slide" --light 'env half.png' \
        --light 'area 0 0 2 0 1 0 1 0 0'
done
same 'the same bytes from 1 and 3 threads' t1.exr t3.exr

# ---- rigs
mkdir -p sub
relume relight full.exr -o a.exr --light "$slide" --light 'dir 1 0 1 rgb 1 .5 .25' --save-rig sub/rig.json
relume relight full.exr -o b.exr --rig sub/rig.json
same 'a rig gives the same picture' a.exr b.exr
check 'its files are relative to it' grep -qF '../a slide.png' sub/rig.json
relume relight full.exr -o b.exr --rig sub/rig.json --light 'dir 0 0 1'
above '--light adds to it' "$(diff a.exr b.exr)" 0.1

# ---- depth: a slab has its surfaces, or is given them, or refuses
"$sphere" slab --size 24 --lights 20 --views 3 --hemisphere
relume encode slab -o slab.exr --basis sh --coefficients 4
relume encode slab -o flat.exr --basis sh --coefficients 4 --no-depth
relume relight slab.exr -o a.exr --light 'point 0.3 0.3 2'
expect_fail 'near light, no depth' 1 'flat.exr: a near light \(spot\) needs to know how far the surface is; use a file with depth, or --assume-depth' x.exr \
    "$RELUME" relight flat.exr -o x.exr --light 'spot 0.3 0.3 2 0 0 -1 30'
relume relight flat.exr -o b.exr --light 'point 0.3 0.3 2' --assume-depth 3
relume relight flat.exr -o c.exr --light 'point 0.3 0.3 2' --assume-depth 2.5
differ 'the depth that is assumed matters' b.exr c.exr
relume relight slab.exr -o c.exr --light 'point 0.3 0.3 2' --assume-depth 2.5
same 'and does not where there is depth' a.exr c.exr
# ---- refusals
printf 'P3\n3 1\n255\n%s\n' "$(yes '0 0 0' | head -n 3)" | picture wide.png
bad() { # name, status, pattern, light
    expect_fail "$1" "$2" "$3" x.exr "$RELUME" relight full.exr -o x.exr --light "$4"
}
bad 'unknown kind' 2 "unknown kind, did you mean 'spot'" 'spott 0 0 3 0 0 -1 15'
bad 'half angle of 90' 2 'half angle between 0 and 90' 'spot 0 0 3 0 0 -1 90'
bad 'no slide' 1 'none.png: no such file' 'slide 0 0 3 0 0 -1 20 none.png'
bad 'no ies' 1 'none.ies: cannot be opened' 'ies 0 0 3 0 0 -1 none.ies'
bad 'gonio of another shape' 1 'wide.png: 3 x 1 pixels; expected six square faces' "gonio 0 0 3 0 0 -1 wide.png"
bad 'no image' 1 'lamp.ies' 'env lamp.ies'
sed 's/^1 1000 1 3 1/1 1000 1 9999999 1/' lamp.ies >huge.ies
bad 'ies: huge counts' 1 'huge.ies: number of vertical angles; expected 1 to 4096' 'ies 0 0 3 0 0 -1 huge.ies'
sed 's/^100 50 0/100 -50 0/' lamp.ies >negative.ies
bad 'ies: negative candela' 1 'negative.ies: candela; expected 0 or more, found -50' 'ies 0 0 3 0 0 -1 negative.ies'
sed 's/^0 10 20/0 10 1e9/' lamp.ies >angle.ies
bad 'ies: huge angles' 1 'angle.ies: vertical angles; expected ascending angles in 0 to 180' 'ies 0 0 3 0 0 -1 angle.ies'
sed 's/"solo": false/"solo": 7/' sub/rig.json >sub/wrong.json
expect_fail 'rig: a wrong field' 1 'sub/wrong.json: line [0-9]*, column [0-9]*; light 1; solo; expected true or false' x.exr \
    "$RELUME" relight full.exr -o x.exr --rig sub/wrong.json
tr ']' '}' <sub/rig.json >sub/broken.json
expect_fail 'rig: broken JSON' 1 'sub/broken.json: line [0-9]+, column [0-9]+; expected JSON' x.exr \
    "$RELUME" relight full.exr -o x.exr --rig sub/broken.json
expect_fail 'rig: cannot be written' 3 'nowhere/rig.json' nowhere/rig.json \
    "$RELUME" relight full.exr -o /dev/null --light 'dir 0 0 1' --save-rig nowhere/rig.json
finish
