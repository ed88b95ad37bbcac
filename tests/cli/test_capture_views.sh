#!/bin/sh
# Photographs of many cameras become slabs, pictures of all directions panoramas; depth from views.
. "$(dirname "$0")/lib.sh"

data="$TOP/../shared/data"

relume synth teapot -o slab --views 3x3 --lights 1 --hemisphere --size 48 --samples 4 || exit 1
relume encode slab -o slab.exr --basis table --bits half || exit 1
# Every view where it belongs: a file of the true capture shows the new one. Half floats of one
# light: exact but for 2^-11 of its value, 66 dB and more after coding.
as_true() { # name, capture
    "$RELUME" eval slab.exr "$2" --json -q >eval.json
    above "$1" "$(field psnr_db eval.json)" 60
}

# ---- a grid of cameras
mkdir rows
for n in 0 1 2 3 4 5 6 7 8; do cp slab/view0$n/light0000.exr rows/view_0$((n / 3))_0$((n % 3)).exr; done
relume lightfield rows --lights slab/capture.json -o out
as_true 'rows and columns' out
relume lightfield rows -o wide --baseline 2 --distance 6 --window 4 --st-z 1
check 'world units' grep -q '"uv_plane_z": 7, "st_plane_z": 1, "st_min": \[-2, -2\]' wide/capture.json
check 'and the baseline' grep -q '"uv": \[-1, 1\]' wide/capture.json
relume lightfield rows -o high --baseline 2 --baseline-v 0.5
check 'rows nearer to each other than columns' grep -q '"uv": \[-1, 0.25\]' high/capture.json
relume capture rows --slab -o moved --focus-disparity 2 --force
below 'a focus disparity crops' "$(relume encode moved -o m.exr --no-depth && "$RELUME" info m.exr --json |
    sed -n 's/.*"width": *\([0-9]*\).*/\1/p')" 44

# ---- how far apart rows are: every n-th row and column of a square grid, 7 x 7
relume synth teapot -o seven --views 7x7 --lights 1 --hemisphere --size 96 --samples 2
choose() { # folder, rows, columns
    rm -rf $1 && mkdir $1
    r=0
    for row in $2; do
        c=0
        for column in $3; do
            cp seven/view$(printf %02d $((7 * row + column)))/light0000.exr $1/view_0${r}_0$c.exr
            c=$((c + 1))
        done
        r=$((r + 1))
    done
}
spacing() { sed -n 's/.*rows of cameras are \([0-9.]*\) times.*/\1/p' spacing.txt; }
spaced() { # ratio, tolerance, rows, columns
    choose grid "$3" "$4"
    "$RELUME" lightfield grid -o spaced --force 2>spacing.txt
    above "rows $1 times as far apart as columns" "$(spacing)" "$(echo "$1 $2" | awk '{ print $1 * (1 - $2) }')"
    below '... and no farther' "$(spacing)" "$(echo "$1 $2" | awk '{ print $1 * (1 + $2) }')"
}
all='0 1 2 3 4 5 6'
# steps of the ratio are 1 %; the teapot moves by up to 9 texels, found to whole ones
spaced 0.5 0.03 "$all" '0 2 4 6'
spaced 2 0.03 '0 2 4 6' "$all"
spaced 1.5 0.03 '0 3 6' '0 2 4 6'
# numbers that count rows otherwise than columns, as of every second row of an archive
rm -rf even && mkdir even
for r in 0 1 2 3; do for c in 0 1 2 3 4 5 6; do
    cp seven/view$(printf %02d $((14 * r + c)))/light0000.exr even/view_0$((2 * r))_0$c.exr
done; done
"$RELUME" lightfield even -o spaced --force 2>spacing.txt
above 'rows by their numbers: the spacing is reported' "$(spacing)" 1.94
spaced 1 0 "$all" "$all"
check 'a square grid is one exactly' grep -q '"uv": \[-0.5, 0.5\]' spaced/capture.json
check 'what was found is said' grep -q 'by the photographs (error . %, .. % of the pixels agree); if not, give --baseline-v' spacing.txt
"$RELUME" lightfield grid -o spaced --baseline-v 1 --force 2>spacing.txt
check 'who says it himself is believed' test -z "$(spacing)"
for f in grid/*; do cmp -s $f grid/view_00_00.exr || cp grid/view_00_00.exr $f; done
expect_ok 'what does not move does not tell' 'as far apart as columns, 1 from the first to the last: the photographs do not show it; if that is wrong' \
    "$RELUME" lightfield grid -o still
chess="$data/lf-stanford-chess-9x9"
if [ -d "$chess" ]; then # every second row, counted as if it were every row
    "$RELUME" lightfield "$chess"/view_*.jpg -o archive 2>spacing.txt
    one=$(spacing)
    mkdir half
    for r in 0 1 2 3 4; do for c in 0 1 2 3 4 5 6 7 8; do
        cp "$chess"/view_$(printf %02d_%02d $((4 * r)) $((2 * c))).jpg half/view_0${r}_0$c.jpg
    done; done
    "$RELUME" lightfield half -o archive --force 2>spacing.txt
    two=$(spacing)
    above 'chess: half the rows are twice as far apart' "$(echo "$two $one" | awk '{ print $1 / $2 }')" 1.96
    below '... and no farther' "$(echo "$two $one" | awk '{ print $1 / $2 }')" 2.04
else
    skip 'chess: half the rows' 'no ../shared/data'
fi

# ---- bad grids (names: tests/unit/test_views.c)
relume relight slab.exr -o rows/view_02_02.exr --size 40x40
expect_fail 'another size' 1 'view_02_02.exr: 40 x 40 pixels; expected 48 x 48' bad \
    "$RELUME" lightfield rows -o bad
rm rows/view_02_02.exr
expect_fail 'a missing camera is named' 1 'row 2, column 2' bad "$RELUME" lightfield rows -o bad
cp slab/view08/light0000.exr rows/view_02_02.exr

# ---- the spellings before these commands, for one version
expect_ok 'an old spelling says the new one' "'relume capture --slab' is now 'relume lightfield'" \
    "$RELUME" capture rows --slab --lights slab/capture.json -o old
same 'and does the same' old/capture.json out/capture.json
check '-q silences the hint' test -z "$("$RELUME" capture rows --slab -o quiet -q 2>&1)"
"$RELUME" hdr --help | grep -q -e '--hdr' && not_ok 'help shows new spellings only' || ok 'help shows new spellings only'

# ---- depth from views
relume synth teapot -o many --views 3x3 --lights 3 --hemisphere --size 48 --samples 4 || exit 1
for n in 1 3; do
    relume lightfield many --depth-from-views -o depth$n --threads $n --json >d$n.json
done
# 1 to 2 % were seen; the teapot's relief is a quarter of its distance
below 'depth is near the truth' "$(field median_relative d1.json)" 0.03
same 'threads do not matter to depth' depth1/view004_depth.exr depth3/view004_depth.exr
same 'nor to confidence' depth1/view004_confidence.exr depth3/view004_confidence.exr
relume synth teapot -o truth --eye 0.25,0.25,3 --lights-from many/capture.json --size 48 --samples 4 || exit 1
relume encode depth1 -o with.exr --basis table --bits 16
relume encode many -o without.exr --basis table --bits 16 --no-depth
light="dir $(tr -d '\n ' <many/capture.json | sed 's/.*"directions":\[\[\([^]]*\)\].*/\1/' | tr ',' ' ')"
for k in with without; do
    relume relight $k.exr -o $k.png.exr --eye 0.25,0.25,3 --light "$light"
done
above 'a camera left out is met 4 dB better' "$(psnr with.png.exr truth/view00/light0000.exr)" \
    "$(psnr without.png.exr truth/view00/light0000.exr | awk '{ print $1 + 4 }')"
relume synth teapot -o flat --projection planar --lights 1 --size 16 --samples 1
expect_fail 'depth needs a slab' 2 'expected a slab of two views' bad \
    "$RELUME" lightfield flat --depth-from-views -o bad

# ---- poses: the slab's own cameras as COLMAP would write them
mkdir model
n=0
for r in 0 1 2; do
    for c in 0 1 2; do
        n=$((n + 1))
        u=$(awk -v c=$c 'BEGIN { print (c - 1) / 2 }') v=$(awk -v r=$r 'BEGIN { print (1 - r) / 2 }')
        echo "$n PINHOLE 48 48 72 72 $(awk -v u=$u -v v=$v 'BEGIN { print 24 * (1 + u), 24 * (1 - v) }')"
        echo "$n 0 1 0 0 $(awk -v u=$u -v v=$v 'BEGIN { print -u, v }') 3 $n view_0${r}_0$c.exr" >>model/images.txt
        echo >>model/images.txt
    done
done >model/cameras.txt
relume lightfield rows --colmap model --distance 3 --views 3x3 -o posed --lights slab/capture.json
as_true 'from poses: a view at a photograph is that photograph' posed
expect_fail 'parallel cameras without points ask for the distance' 1 'expected --distance' bad \
    "$RELUME" lightfield rows --colmap model -o bad
sed 's/PINHOLE 48/FISHEYE 48/' model/cameras.txt >c && cp -r model fish && mv c fish/cameras.txt
expect_fail 'a camera model that is not supported' 1 'camera model FISHEYE' bad \
    "$RELUME" lightfield rows --colmap fish --distance 3 -o bad

# ---- panoramas
relume synth attic -o attic --lights 1 --size 48 --samples 4 --projection cube || exit 1
relume encode attic -o attic.exr --basis table --bits half
relume relight attic.exr -o unfolded.exr
mkdir faces
look() { relume relight attic.exr -o "faces/$1.exr" --pan="$2" --tilt="$3" --size 48x48; }
look right 90 0
look left -90 0
look top 0 90
look bottom 0 -90
look back 180 0
look front 0 0
relume panorama faces --layout cube -o cube
above 'six faces' "$(psnr cube/light0000.exr unfolded.exr)" 60
mkdir card
for f in right:posx left:negx top:posy bottom:negy front:posz back:negz; do
    cp faces/${f%:*}.exr card/${f#*:}.exr
done
expect_ok 'the z of graphics cards shows at the edges' 'posz.exr is the face in front' \
    "$RELUME" panorama card --layout cube -o card_cube
same 'and is turned round' card_cube/light0000.exr cube/light0000.exr
rm card/posy.exr
expect_fail 'five faces' 1 'expected six faces' bad "$RELUME" panorama card --layout cube -o bad
expect_fail 'not square' 1 'expected square faces' bad "$RELUME" panorama unfolded.exr unfolded.exr \
    unfolded.exr unfolded.exr unfolded.exr unfolded.exr --layout cube -o bad
relume synth attic -o sphere --lights 1 --size 32 --samples 1 --projection spherical || exit 1
cp sphere/view00/light0000.exr s.exr
relume panorama s.exr --depth sphere/view00/depth.exr -o taken
same 'a sphere as it is, with depth' taken/depth.exr sphere/view00/depth.exr
relume capture s.exr --panorama cylinder -o cylinder
check 'a cylinder of square pixels' grep -q '"v_min": -1.57079633, "v_max": 1.57079633' cylinder/capture.json
relume relight attic.exr -o grey.png
expect_fail 'grey depth asks for its range' 2 'expected the distances of white and black' bad \
    "$RELUME" panorama s.exr --depth grey.png -o bad

# ---- stitching
if [ ! -e "$BUILD/librelume-stitch.so.0" ]; then
    skip 'stitched photographs' 'built without OpenCV'
    expect_fail 'but what it needs is said' 3 "expected a build with OpenCV \('make deps-stitch', then 'make'\)" out.exr \
        "$RELUME" panorama s.exr s.exr -o out.exr
elif [ ! -e "$data/hdri-polyhaven-1k/forest.hdr" ]; then
    skip 'stitched photographs' 'no data'
else
    relume panorama "$data/hdri-polyhaven-1k/forest.hdr" -o forest
    relume encode forest -o forest.exr --basis table --bits half
    for p in 0 35 70; do
        relume relight forest.exr -o shot$p.exr --pan $p --zoom 1.2 --size 320x240
    done
    expect_ok 'photographs are stitched' 'cover' "$RELUME" panorama shot0.exr shot35.exr shot70.exr \
        -o stitched --width 1024
    # 2 atan(1 / 1.2) = 79.6 degrees; half a degree is four pixels
    below 'their field of view is found' "$(sed -n 's/.*photographs of \([0-9.]*\) degrees.*/\1/p' err.txt |
        awk '{ d = $1 - 79.6; print d < 0 ? -d : d }')" 0.5
    relume encode stitched -o stitched.exr --basis table --bits half
    for k in forest stitched; do
        relume relight $k.exr -o look_$k.png --pan 35 --zoom 1.5 --size 200x150
    done
    # leaves a pixel wide: twice resampled, and a tenth of a degree off
    above 'and meet the truth' "$(psnr look_stitched.png look_forest.png)" 18
    relume relight forest.exr -o away.exr --pan 200 --zoom 1.2 --size 320x240
    expect_fail 'a photograph that overlaps none' 1 'away.exr: overlaps none' bad \
        "$RELUME" panorama shot0.exr shot35.exr shot70.exr away.exr -o bad
fi
finish
