#!/bin/sh
# How a slab or a panorama is looked at, and how a picture is developed.
. "$(dirname "$0")/lib.sh"


is() { if [ "$2" = "$3" ]; then ok "$1"; else not_ok "$1" "found '$2', expected '$3'"; fi; }

# ---- a camera left out: synth renders the truth
relume synth teapot -o slab --views 3x3 --lights 4 --hemisphere --size 96 --samples 4 || exit 1
relume synth teapot -o truth --eye 0.25,0.25,3 --lights-from slab/capture.json --size 96 --samples 4 || exit 1
relume encode slab -o slab.exr --basis table --bits 16 || exit 1
relume encode slab -o bare.exr --basis table --bits 16 --no-depth || exit 1
# the second of its lights
light="dir $(tr -d '\n ' <slab/capture.json | sed 's/.*"directions":\[\[[^]]*\],\[\([^]]*\)\].*/\1/' | tr ',' ' ')"
for i in constant linear depth; do
    relume relight slab.exr -o $i.exr --eye 0.25,0.25,3 --light "$light" --interpolate $i
done
above 'by depth, a camera left out is met' "$(psnr depth.exr truth/view00/light0001.exr)" 24
above 'better than by the nearest camera' "$(psnr depth.exr truth/view00/light0001.exr)" \
    "$(psnr constant.exr truth/view00/light0001.exr)"
above 'and than linearly, by 4 dB' "$(psnr depth.exr truth/view00/light0001.exr)" \
    "$(psnr linear.exr truth/view00/light0001.exr | awk '{ print $1 + 4 }')"
relume relight slab.exr -o default.exr --eye 0.25,0.25,3 --light "$light"
same 'depth is the default where there is any' default.exr depth.exr
relume relight bare.exr -o bare.out.exr --eye 0.25,0.25,3 --light "$light"
same 'else it is linear' bare.out.exr linear.exr
relume relight slab.exr -o nearest.exr --eye 0.25,0.25,3 --light "$light" --nearest
same '--nearest is constant' nearest.exr constant.exr
relume relight slab.exr -o eye.exr --eye 0.5,0,3 --light "$light"
relume relight slab.exr -o view.exr --view 5 --light "$light"
same 'a captured eye is its view' eye.exr view.exr
relume relight slab.exr -o pinhole.exr --eye 0.25,0.25,3 --light "$light" --aperture 0 --focus 0
same 'no aperture, the st plane in focus: linear' pinhole.exr linear.exr
relume relight slab.exr -o wide.exr --light "$light" --aperture 0.8
differ 'an aperture blurs' wide.exr linear.exr
for n in 1 3; do relume relight slab.exr -o t$n.exr --eye 0.1,0.2,3.3 --threads $n; done
same 'threads do not matter' t1.exr t3.exr

# ---- one ray is a pixel: column 40, row 60 of 96 looks at s = -0.15625, t = -0.2604167
relume query slab.exr --eye 0.25,0.25,3 --direction=-0.40625,-0.5104167,-3 --light "$light" >q.txt
"$mkimage" read default.exr 40 60 >p.txt
for i in 1 2 3; do
    below "query is the pixel, channel $i" \
        "$(awk -v i=$i 'NR == FNR { a = $i; next } { d = $i - a; print d < 0 ? -d : d }' q.txt p.txt)" 1e-4
done

# ---- many rays at once are those one by one
cat >rays.txt <<'END'
# eye, then direction
0.25 0.25 3 -0.40625 -0.5104167 -3
0,0,3, 0,0,-1   # commas do as well

0.1 -0.3 3 0.05 0.1 -1
0 0 3 9 9 -1
END
for i in depth linear constant; do
    relume query slab.exr --rays rays.txt --light "$light" --interpolate $i >list.txt 2>/dev/null
    {
        relume query slab.exr --eye 0.25,0.25,3 --direction=-0.40625,-0.5104167,-3 --light "$light" --interpolate $i
        relume query slab.exr --eye 0,0,3 --direction=0,0,-1 --light "$light" --interpolate $i
        relume query slab.exr --eye 0.1,-0.3,3 --direction=0.05,0.1,-1 --light "$light" --interpolate $i
        echo none
    } >one.txt
    same "rays from a file, $i" list.txt one.txt
done
differ 'interpolations differ' list.txt q.txt
relume query slab.exr --rays - --light "$light" <rays.txt >stdin.txt 2>/dev/null
relume query slab.exr --rays rays.txt --light "$light" >list.txt 2>/dev/null
same 'rays from stdin' stdin.txt list.txt
relume query slab.exr --rays rays.txt --light "$light" --json 2>/dev/null | tr -d '[]{}:,"' | tr -s ' ' '\n' |
    grep -v '^rgb$' >json.txt
tr ' ' '\n' <list.txt | sed 's/none/null/' >flat.txt
same 'rays as JSON' json.txt flat.txt
expect_ok 'rays that are not there are counted' '1 of 4 rays are not in the file' \
    "$RELUME" query slab.exr --rays rays.txt
printf '0 0 3 0 0 -1\n0 0 3 0 0\n' >short.txt
printf '0 0 3 0 0 0\n' >nowhere.txt
printf '0 0 3 0 0 nan\n' >nan.txt
printf '# nothing\n' >empty.txt
expect_fail 'a line of five numbers' 1 'short.txt: line 2: expected six numbers' - "$RELUME" query slab.exr --rays short.txt
expect_fail 'no direction' 1 'line 1: the direction is 0 0 0; expected where the ray goes' - "$RELUME" query slab.exr --rays nowhere.txt
expect_fail 'a direction that is no number' 1 'line 1: expected six numbers' - "$RELUME" query slab.exr --rays nan.txt
expect_fail 'no rays' 1 'holds no rays; expected six numbers per line' - "$RELUME" query slab.exr --rays empty.txt
expect_fail 'no file of rays' 1 'cannot be read' - "$RELUME" query slab.exr --rays missing.txt
expect_fail 'a picture for rays' 1 'line 1: expected six numbers' - "$RELUME" query slab.exr --rays slab.exr
expect_fail 'a ray and rays' 2 'or --rays FILE' - "$RELUME" query slab.exr --rays rays.txt --eye 0,0,3
expect_fail 'by depth without depth' 1 'interpolation by depth needs a file with depth' - \
    "$RELUME" query bare.exr --rays rays.txt --interpolate depth

# ---- an eye nearer than the cameras: rays beside the grid go by depth, or to the nearest camera
relume synth teapot -o near --views 1x1 --eye 0,0,1.6 --lights-from slab/capture.json --size 96 --samples 4 || exit 1
relume relight slab.exr -o near.exr --eye 0,0,1.6 --light "$light"
relume relight bare.exr -o clamped.exr --eye 0,0,1.6 --light "$light"
# they were black: 16 dB
above 'by depth most of it is filled' "$(psnr near.exr near/view00/light0001.exr)" 24
above 'without depth the nearest camera stands in' "$(psnr clamped.exr near/view00/light0001.exr)" 18
expect_ok 'and it is said' 'beyond the cameras: shown as the nearest' \
    "$RELUME" relight slab.exr -o x.png --eye 0,0,1.6
# the frame is drawn again for its exposure
"$VIEWER" slab.exr --offscreen v.png --eye 0,0,1.6 --exposure auto 2>said.txt
check 'the viewer says it, once' test "$(grep -c 'beyond the cameras: shown as the nearest' said.txt)" = 1
"$VIEWER" slab.exr --offscreen v.png --eye 0.1,0,3 2>said.txt
check 'not of an eye among them' test ! -s said.txt
expect_fail 'an eye that sees no camera is refused' 1 'sees nothing of the slab' x.exr \
    "$RELUME" relight slab.exr -o x.exr --eye 9,9,3

# ---- other sizes: proportions are kept, one side gives the other
size_of() { "$mkimage" size "$1"; }
relume synth box -o flat --lights 9 --hemisphere --size 64 --samples 1 || exit 1
relume encode flat -o flat.exr || exit 1
for size in 32 32x x32 32x32; do
    relume relight flat.exr -o s.exr --size $size || not_ok "--size $size" 'refused'
    is "--size $size" "$(size_of s.exr)" '32 32'
done
relume relight flat.exr -o full.exr
relume relight flat.exr -o own.exr --size 64
same 'its own size is as it is' own.exr full.exr
expect_ok 'another shape is fitted in, and said' 'it fills 32 x 32, with black borders' \
    "$RELUME" relight flat.exr -o wide.exr --size 48x32
is 'in a picture as large as asked for' "$(size_of wide.exr)" '48 32'
relume relight flat.exr -o small.exr --size 32
is 'black beside it' "$("$mkimage" read wide.exr 7 16)" "$("$mkimage" read wide.exr 40 16)"
is 'the picture in the middle' "$("$mkimage" read wide.exr 18 16)" "$("$mkimage" read small.exr 10 16)"
for y in 20 21; do for x in 20 21; do "$mkimage" read full.exr $x $y; done; done |
    awk '{ for (i = 1; i <= 3; i++) s[i] += $i / 4 } END { print s[1], s[2], s[3] }' >mean.txt
"$mkimage" read small.exr 10 10 >pixel.txt
for i in 1 2 3; do
    below "a pixel is the mean of its four, channel $i" \
        "$(awk -v i=$i 'NR == FNR { a = $i; next } { d = $i - a; print d < 0 ? -d : d }' mean.txt pixel.txt)" 1e-6
done
relume relight flat.exr -o nearest.exr --size 32 --filter nearest
differ 'the nearest texel is no mean' nearest.exr small.exr
relume relight flat.exr -o linear.exr --size 200
relume relight flat.exr -o cubic.exr --size 200 --filter cubic
differ 'cubic is not linear' cubic.exr linear.exr
for n in 1 3; do relume relight flat.exr -o z$n.exr --size 41x77 --threads $n; done
same 'threads do not matter there' z1.exr z3.exr
relume relight slab.exr -o fitted.exr --size 48x96 --light "$light"
is 'a slab is not stretched' "$("$mkimage" read fitted.exr 20 10)" "$("$mkimage" read fitted.exr 20 90)"
rm -f x.png
for bad in 0 0x10 10x0 x 12x12x 1e3 -5x5 70000 99999999999999999999; do
    expect_fail "--size=$bad" 2 'expected WxH, W or xH' x.png \
        "$RELUME" relight flat.exr -o x.png "--size=$bad"
done
expect_fail 'a size that no memory holds' 2 'too large' x.png \
    "$RELUME" relight flat.exr -o x.png --size 65536
expect_fail 'unknown filter' 2 "did you mean 'cubic'" x.png \
    "$RELUME" relight flat.exr -o x.png --filter cubik

# ---- developing
relume synth attic -o pano --lights 9 --hemisphere --size 32 --samples 1 || exit 1
relume encode pano -o pano.exr || exit 1
look='--pan 30 --size 90x50'
for t in linear reinhard filmic; do
    relume relight pano.exr $look -o $t.png --tone $t
    relume relight pano.exr $look -o $t.exr --tone $t
done
same 'EXR stays linear' linear.exr filmic.exr
differ 'filmic is not linear' linear.png filmic.png
differ 'nor reinhard' reinhard.png filmic.png
relume relight pano.exr $look -o plain.png
same 'linear is the default' plain.png linear.png
relume relight pano.exr $look -o auto.exr --exposure auto
differ 'automatic exposure exposes' auto.exr linear.exr
relume relight pano.exr -o planet.exr --projection planet --size 60x60
relume relight pano.exr -o down.exr --projection stereographic --tilt -90 --zoom 0.5 --size 60x60
same 'a planet is a stereographic look down' planet.exr down.exr

# ---- a part of a view
relume relight pano.exr -o whole.png
relume relight pano.exr -o part.png --crop 5,3,20,11
if [ "$("$mkimage" size part.png)" = '20 11' ]; then ok 'a part has its own size'; else not_ok 'a part has its own size' "$("$mkimage" size part.png)"; fi
for at in '0 0' '19 10' '7 4'; do
    x=${at% *} y=${at#* }
    if [ "$("$mkimage" read part.png $x $y)" = "$("$mkimage" read whole.png $((x + 5)) $((y + 3)))" ]; then ok "pixel $at of the part"; else not_ok "pixel $at of the part" 'differs from the whole'; fi
done
expect_fail 'a part beyond the view' 2 'expected one within the' x.png \
    "$RELUME" relight pano.exr -o x.png --crop 5,3,20000,11
expect_fail 'a part of a look' 2 'expected a captured view' x.png \
    "$RELUME" relight pano.exr -o x.png --crop 5,3,2,1 --pan 10
expect_fail 'parts of pixels' 2 'four whole numbers' x.png \
    "$RELUME" relight pano.exr -o x.png --crop 5,3.5,2,1

# ---- a smaller picture, by reduced levels
"$sphere" large --size 300 --lights 6 --hemisphere || exit 1
for domain in linear display; do
    relume encode large -o deep.exr --basis pca --coefficients 6 --domain $domain --pyramid yes --bits 12
    relume encode large -o flat.exr --basis pca --coefficients 6 --domain $domain --pyramid no --bits 12
    for how in '--size 150' '--size 75' '--crop 20,40,200,120 --size 100' '--crop 7,9,240,240 --size 60'; do
        relume relight deep.exr -o a.exr --light 'dir 0.3 0.4 1' $how
        relume relight flat.exr -o b.exr --light 'dir 0.3 0.4 1' $how
        # sizes that are whole parts of the view's: the mean is the same but for the quantiser, and in the display domain
        # for what so few components cannot express; the last part begins between the level's pixels
        above "$domain, $how" "$("$RELUME" compare a.exr b.exr | awk '$1 == "psnr_db" { print $2 }')" 38
    done
done
relume relight flat.exr -o a.exr --crop 20,40,200,120 --size 300x100
if [ "$("$RELUME" compare a.exr b.exr 2>&1 | grep -c 300)" -gt 0 ]; then ok 'a part in another size'; else not_ok 'a part in another size' 'of its own'; fi

# ---- refusals
expect_fail 'interpolation by depth without depth' 1 'interpolation by depth needs a file with depth' x.png \
    "$RELUME" relight bare.exr -o x.png --interpolate depth
expect_fail 'unknown interpolation' 2 "did you mean 'linear'" x.png \
    "$RELUME" relight slab.exr -o x.png --interpolate liner
expect_fail 'a focus behind the cameras' 2 'expected it between z = 3' x.png \
    "$RELUME" relight slab.exr -o x.png --focus 4
expect_fail 'an aperture and an interpolation' 2 'expected one of' x.png \
    "$RELUME" relight slab.exr -o x.png --aperture 1 --interpolate depth
expect_fail 'unknown tone' 2 "did you mean 'filmic'" x.png \
    "$RELUME" relight slab.exr -o x.png --tone flimic
expect_fail 'no exposure' 2 'or auto; found .bright' x.png \
    "$RELUME" relight slab.exr -o x.png --exposure bright
expect_fail 'unknown projection' 2 'perspective' x.png \
    "$RELUME" relight pano.exr -o x.png --projection flat
finish
