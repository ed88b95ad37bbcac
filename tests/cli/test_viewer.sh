#!/bin/sh
# relume-view as a program: frames without a display equal those of relume relight, and what it says
# when it cannot show anything.
. "$(dirname "$0")/lib.sh"

"$RELUME" synth teapot -q -o teapot --views 2x2 --lights 12 --size 24 --samples 1 || exit 1
"$RELUME" encode -q teapot -o teapot.exr --shadows no || exit 1  # a ray may fall on another pixel: tests/cli/test_shadows.sh
"$RELUME" encode -q teapot -o bare.exr --no-depth || exit 1
light="dir 0.5 0.4 0.8"

same() { # name, options...: both programs draw the same linear frame
    name=$1
    shift
    "$RELUME" relight teapot.exr -o cpu.exr "$@" --light "$light" &&
        "$VIEWER" teapot.exr --relight passes --offscreen gpu.exr "$@" --light "$light" || {
        not_ok "$name" "a program failed"
        return
    }
    # single precision on both sides, values up to about 2: 1e-4 is ample
    worst=$("$RELUME" compare cpu.exr gpu.exr | awk '$1 == "max_abs" { print $2 }')
    if awk "BEGIN { exit !($worst < 1e-4) }"; then ok "$name"; else not_ok "$name" "off by $worst"; fi
}
same 'the default frame'
same 'a captured view' --view 3
same 'an eye between cameras' --eye 0.1,-0.2,3 --interpolate linear
same 'the nearest camera' --eye 0.1,-0.2,3 --interpolate constant
awk 'BEGIN {
    printf "{ \"format\": \"relume-rig\", \"version\": 1, \"lights\": [\n"
    for (i = 0; i < 10000; i++)
        printf "{ \"light\": \"%s %f %f 2\", \"rgb\": [1e-4, 1e-4, %f] }%s\n",
            i % 200 ? "dir" : "point", cos(i), sin(i), i / 1e8, i < 9999 ? "," : " ] }"
}' >many.json
same 'ten thousand lights' --view 1 --rig many.json
same 'a slab in a frame of another shape' --eye 0.1,-0.2,3 --interpolate linear --size 61x24
same 'a view of half the size' --view 1 --size 12
same 'a view by its height, in no whole proportion' --view 1 --size x9
same 'a view enlarged, with black above and below' --view 1 --size 50x70
same 'an aperture' --eye 0.1,-0.2,3 --aperture 0.6 --focus 0.5

# by depth a rounding may send a ray to another texel, a few in a frame: PSNR instead of the worst
"$RELUME" relight teapot.exr -o cpu.exr --light "$light" --eye 0.1,-0.2,3 &&
    "$VIEWER" teapot.exr --offscreen gpu.exr --light "$light" --eye 0.1,-0.2,3
above 'an eye by depth' "$("$RELUME" compare cpu.exr gpu.exr | awk '$1 == "psnr_db" { print $2 }')" 45

developed() { # name, options...: both programs write the same picture for the screen
    name=$1
    shift
    "$RELUME" relight pano.exr -o cpu.png "$@" && "$VIEWER" pano.exr --offscreen gpu.png "$@" || {
        not_ok "$name" "a program failed"
        return
    }
    # 1/255 of display values; near white that is 2.3/255 of linear light
    below "$name" "$("$RELUME" compare cpu.png gpu.png | awk '$1 == "max_abs" { print $2 }')" 0.01
}
"$RELUME" synth attic -q -o pano --lights 9 --hemisphere --size 24 --samples 1 || exit 1
"$RELUME" encode -q pano -o pano.exr || exit 1
developed 'tone and exposure' --pan 40 --exposure 2 --tone filmic --size 100x60
developed 'automatic exposure' --pan 40 --exposure auto --tone reinhard --white 2 --size 100x60
developed 'a little planet' --projection planet --exposure auto --size 80x80

same 'luminance' --view 1 --pass luminance
same 'enhanced' --view 1 --pass unsharp
same 'with a highlight' --pass specular

# a large view is known smaller, and shown by its tiles: --vram makes it large here
"$sphere" large --size 640 --lights 4 --hemisphere || exit 1
"$RELUME" encode -q large -o deep.exr --basis sh --coefficients 1 --pyramid yes || exit 1
"$RELUME" encode -q large -o flat.exr --basis sh --coefficients 1 --pyramid no || exit 1
printf 'size 200 200\nlight dir .4 .3 1\nwheel 14 40 40\nwait\nframe %s\n' a.exr >tiles.txt
sed 's/a.exr/b.exr/' tiles.txt >whole.txt
for how in passes library; do
    "$VIEWER" deep.exr --script tiles.txt --vram 14 --relight $how && "$VIEWER" flat.exr --script whole.txt --relight $how
    # the same codes, of which single precision finds the places a little differently
    above "tiles, by $how" "$("$RELUME" compare a.exr b.exr | awk '$1 == "psnr_db" { print $2 }')" 80
done

# a panel that is open changes a shot, not a frame; clicks on it change the picture
cat >panel.txt <<'END'
size 500 540
frame plain.png
key tab
frame open.png
shot shot.png
click 25 49
frame dark.png
END
"$VIEWER" teapot.exr --script panel.txt --light "$light"
check 'a frame is the picture alone' cmp plain.png open.png
if cmp -s shot.png open.png; then not_ok 'a shot shows the panel' 'it is the picture'; else ok 'a shot shows the panel'; fi
"$RELUME" compare dark.png shot.png >dark.txt 2>&1
if cmp -s dark.png open.png; then not_ok 'a click turns the light off' 'nothing changed'; else ok 'a click turns the light off'; fi

# letters: a font beside the program is taken before the packaged one; one that is no font is reported
# once to who sees the panel; the panel grows
mkdir own
cp "$VIEWER" own/relume-view
echo junk >own/DejaVuSans.ttf
own() { LD_LIBRARY_PATH=$BUILD own/relume-view teapot.exr "$@"; }
own --script panel.txt 2>err.txt
check 'a panel without its font is drawn' test -s shot.png
check 'its font is missed once' test "$(grep -c 'warning: .*/own/DejaVuSans.ttf: the panel needs' err.txt)/$(wc -l <err.txt)" = 1/1
own --offscreen plain.png 2>err.txt
check 'a picture misses no font' test ! -s err.txt
printf 'size 700 600\nkey tab\ndrag left 152 252 218 252\nkey w\n' >scaled.txt
"$VIEWER" teapot.exr --script scaled.txt --ui-scale 2
x=$(sed -n 's/.*"dir \([^ ]*\) .*/\1/p' teapot-0001.json)
if awk "BEGIN { exit !(${x:-9} > 0.57 && ${x:-9} < 0.63) }"; then ok '--ui-scale 2'; else not_ok '--ui-scale 2' "x = '$x', expected 0.6"; fi
rm -f teapot-0001.json

# another file begins with its own light, unless the lights are to be kept; near ones need a place to stand
cat >next.txt <<'END'
light "dir 1 0.2 0.4 rgb 1 0.5 0.2"
add point 0.4 0.4 1
open teapot.exr
frame again.png
open bare.exr
key w
END
"$VIEWER" teapot.exr --script next.txt
"$VIEWER" teapot.exr --offscreen first.png
check 'the next file begins with its own light' cmp again.png first.png
check 'one light' test "$(grep -c '"light"' bare-0001.json)" = 1
"$VIEWER" teapot.exr --script next.txt --keep-lights
"$VIEWER" teapot.exr --offscreen first.png --light 'dir 1 0.2 0.4 rgb 1 0.5 0.2' --light 'point 0.4 0.4 1'
check 'lights that are kept' cmp again.png first.png
check 'but near ones where there is no depth' test "$(grep -c '"light"' bare-0002.json)" = 1
check 'the light that is kept' grep -q '"dir 1 0.2' bare-0002.json

# no file yet: a page that says how to open one, and a list of what there is
cat >start.txt <<'END'
size 500 400
shot page.png
key ctrl+o
shot folder.png
type bare.exr
key enter
shot opened.png
key b
key ctrl+o
type none.exr
key enter
shot missing.png
key esc
frame frame.png
END
"$VIEWER" --script start.txt 2>err.txt
"$VIEWER" bare.exr --size 500x400 --offscreen want.png
differ 'a page and a list' page.png folder.png
differ 'a list and what was opened from it' folder.png opened.png
check 'what was opened' cmp frame.png want.png
check 'a file that is not there is reported' grep -q 'none.exr: no such file' err.txt

# a rig in, the same rig out
"$RELUME" relight teapot.exr -o rigged.png --light "$light" --light "dir -1 0 1 rgb 0 0 1" --save-rig rig.json
"$VIEWER" teapot.exr --rig rig.json --offscreen seen.png
check 'a rig' "$RELUME" compare rigged.png seen.png
if [ "$("$RELUME" compare rigged.png seen.png | awk '$1 == "max_abs" { print ($2 < 0.01) }')" = 1 ]; then
    ok 'the lights of a rig'; else not_ok 'the lights of a rig' "$("$RELUME" compare rigged.png seen.png)"; fi

# how it is seen, as a line that relight and the viewer read
cat >look.txt <<'END'
light dir 0.6 0.3 0.7 rgb 1 0.5 0.5
add point 0.5 0.5 2
set eye 0.1 0.05 3
set exposure -0.5
key ctrl+c
frame seen.png
END
state=$("$VIEWER" teapot.exr --script look.txt)
check 'a state' [ "$state" = 'eye=0.1,0.05,3&light=dir,0.6,0.3,0.7,rgb,1,0.5,0.5&light=point,0.5,0.5,2&exposure=-0.5' ]
"$VIEWER" teapot.exr --state "$state" --offscreen again.png
check 'shown again' cmp seen.png again.png
"$RELUME" relight teapot.exr -o relit.png --state "https://example.org/teapot.html#$state&at=1,2,3" 2>err.txt
check 'pages add what is theirs' test ! -s err.txt
above 'relight shows the same' "$(psnr relit.png seen.png)" 45
"$RELUME" relight teapot.exr -o relit.png --state "$state" --eye 0,0,3 -q && "$RELUME" relight teapot.exr -o plain.png --eye 0,0,3 \
    --light 'dir 0.6 0.3 0.7 rgb 1 0.5 0.5' --light 'point 0.5 0.5 2' --exposure -0.5 -q
check 'options beside it count before it' cmp relit.png plain.png
expect_ok 'nothing is written that a state names' "'o' is not known here; it is left out" "$RELUME" relight teapot.exr -o relit.png --state 'o=other.png&save-rig=x'
check 'indeed' test ! -e other.png -a ! -e x
for bad in 'light=dir,nan,0,1' 'exposure=1e300' 'pass=nothing' 'light=%00' 'pan'; do
    expect_fail "state $bad" 2 "" none.png "$RELUME" relight teapot.exr -o none.png --state "$bad"
done

# notes: a line and an area by the mouse, a view; the tool reads them, and a picture shows them
cat >jot.txt <<'END'
size 700 480
light dir 0.6 0.3 0.7
key ctrl+n
shot passing.png
click 163 48
shot passing.png
click 430 200
click 560 200
click 560 300
key enter
shot lines.png
light dir -0.6 0.3 0.7
click 217 48
shot passing.png
click 400 120
key backspace
click 400 100
click 500 100
click 500 150
click 400 100
shot shown.png
END
rm -f teapot.notes.json
"$VIEWER" teapot.exr --script jot.txt
"$RELUME" notes teapot.exr --json >notes.json
check 'a line of the viewer' grep -q '"n1", "kind": "line", "places": \[\[16, 10\], \[22.5, 10\], \[22.5, 15\]\], "length": 11.5, "area": null, "degrees": 90' notes.json
check 'an area, in its light' grep -q '"n2", "kind": "polygon", .*"area": 6.25, .*"state": "eye=0,0,3&light=dir,-0.6,0.3,0.7"' notes.json
differ 'are drawn' lines.png shown.png
rm -f teapot.notes.json

"$VIEWER" teapot.exr --record turntable -o turn --frames 3
check 'a recording is a folder of pictures' test -s turn/0002.png -a ! -e turn/0003.png -a -z "$(leftovers)"
mkdir fake
cat >fake/ffmpeg <<'END'
#!/bin/sh
for last; do :; done
wc -c >"${last#file:}"
END
chmod +x fake/ffmpeg
PATH="$PWD/fake:$PATH" "$VIEWER" teapot.exr --record sweep -o 'a film; rm x.mp4' --frames 5
check 'a film gets every picture' test "$(cat 'a film; rm x.mp4')" -eq $((5 * 24 * 24 * 3))

if command -v ffmpeg >/dev/null 2>&1 && command -v ffprobe >/dev/null 2>&1; then
    "$VIEWER" teapot.exr --record turntable -o real.mp4 --frames 4 --size 33x20
    ffprobe -v error -count_frames -select_streams v:0 -of csv=p=0 \
        -show_entries stream=width,height,nb_read_frames real.mp4 >real.txt 2>&1
    # yuv420p takes even sizes
    check 'the film of the real ffmpeg' grep -qx '34,20,4' real.txt
else
    skip 'the film of the real ffmpeg' 'ffmpeg is not installed'
fi

# a recording by key: a picture a frame; Esc keeps those that are whole and the light goes back
cat >stop.txt <<'END'
frame before.png
key k
wait 0.08
key esc
frame after.png
END
"$VIEWER" teapot.exr --script stop.txt --light "$light"
n=$(ls teapot-0001-sweep | wc -l)
if [ "$n" -ge 3 ] && [ "$n" -lt 10 ]; then ok 'Esc ends a recording'; else not_ok 'Esc ends a recording' "$n pictures"; fi
"$VIEWER" teapot.exr --record sweep -o all --light "$light" --relight auto
check 'pictures of a recording' cmp all/0002.png teapot-0001-sweep/0002.png
check 'the light goes back' cmp before.png after.png
printf 'key k\n' >whole.txt
"$VIEWER" teapot.exr --script whole.txt --light "$light"
check 'a recording is brought to its end' test "$(ls teapot-0002-sweep | wc -l)" -eq 72

# the next frame that is drawn shows what the pointer has done: one frame of latency
cat >latency.txt <<'END'
press right 12 12
frame rest.png
move 16 14
frame next.png
wait
frame later.png
END
"$VIEWER" teapot.exr --script latency.txt --light "$light"
check 'one frame of latency' cmp next.png later.png
if cmp -s rest.png next.png; then not_ok 'the pointer moved the light' 'nothing changed'; else ok 'the pointer moved the light'; fi

# a film of a script: 25 pictures a second of what a window would show, from file to file
cat >film.txt <<'END'
size 60 40
wait 0.2
open pano.exr
wait 0.12
END
"$VIEWER" teapot.exr --script film.txt --record script -o played
check 'a film of a script' test "$(ls played | wc -l)" -eq 8
if cmp -s played/0004.png played/0005.png; then not_ok 'another file' 'the same picture'; else ok 'another file'; fi
printf 'wait 0.1\nopen none.exr\n' >none.txt
"$VIEWER" teapot.exr --script none.txt --record script -o broken 2>broken.txt
check 'a film that ends early' grep -q 'none.txt: line 2, column 6; none.exr' broken.txt
check 'nothing is left of it' test ! -e broken -a -z "$(leftovers)"

# Half floats hold the weights of near lights on the GPU: 1/255 is promised.
"$RELUME" synth box -q -o sky --projection spherical --lights 1 --size 16 --samples 1 || exit 1
nearly() { # name, light, options...: both programs draw the same frame to 1/255
    name=$1 lamp=$2
    shift 2
    "$RELUME" relight teapot.exr -q -o cpu.exr --light "$lamp" "$@" &&
        "$VIEWER" teapot.exr --offscreen gpu.exr --light "$lamp" "$@" || {
        not_ok "$name" "a program failed"
        return
    }
    worst=$("$RELUME" compare cpu.exr gpu.exr | awk '$1 == "max_abs" { print $2 }')
    if awk "BEGIN { exit !($worst < 1 / 255) }"; then ok "$name"; else not_ok "$name" "off by $worst"; fi
}
nearly 'a point light' 'point 0.6 1 2 rgb 2 2 2'
nearly 'a spot from another eye' 'spot 0.5 0.5 2.5 -0.1 -0.1 -1 20 rgb 6 5 4' --eye 0.1,-0.2,3
nearly 'an area light' 'area 0 1.5 1 0.5 0 0 0 0 0.5 rgb 8 8 8'
"$RELUME" relight teapot.exr -o slide.png --light 'dir 0 0 1'
nearly 'a slide' 'slide 0 0 3 0 0 -1 25 slide.png rgb 5 5 5'
nearly 'an environment' 'env sky/view00/light0000.exr 30 rgb 3 3 3'

# the list of maps beside the one in use; the next one takes its place, as it was turned
mkdir maps
for map in one two; do cp sky/view00/light0000.exr maps/$map.exr; done
touch maps/note.txt
cat >choose.txt <<'END'
size 500 700
light env maps/one.exr 25
key tab
shot closed.png
click 186 315
# the list is made when it is asked for
shot open.png
shot list.png
click 60 356
shot chosen.png
key w
END
"$VIEWER" teapot.exr --script choose.txt
check 'another map is chosen' grep -q '"env maps/two.exr 25"' teapot-0001.json

# Mesa draws by the same code whether OSMesa or EGL asks; a graphics card rounds in its own way.
if "$VIEWER" teapot.exr --offscreen egl.exr --gl egl 2>err.txt; then
    "$VIEWER" teapot.exr --offscreen osmesa.exr --gl osmesa
    worst=$("$RELUME" compare egl.exr osmesa.exr | awk '$1 == "max_abs" { print $2 }')
    if awk "BEGIN { exit !($worst < 1e-3) }"; then ok 'EGL and OSMesa agree'; else not_ok 'EGL and OSMesa agree' "off by $worst"; fi
else
    skip 'EGL and OSMesa agree' "$(cat err.txt)"
fi

refuse 'no display' 3 'use --offscreen .*package' env -u DISPLAY -u WAYLAND_DISPLAY "$VIEWER" teapot.exr
refuse 'no such file' 1 'none.exr: no such file' "$VIEWER" none.exr --offscreen none.png
refuse 'unknown option' 2 "did you mean '--offscreen'" "$VIEWER" teapot.exr --offscren none.png
refuse 'no depth' 1 'file with depth' "$VIEWER" bare.exr --interpolate depth --offscreen none.png
refuse 'a focus behind the cameras' 2 'focus: expected' "$VIEWER" teapot.exr --focus 3 --offscreen none.png
refuse 'unknown source of GL' 2 'unknown --gl .vulkan.; expected one of: auto osmesa egl' "$VIEWER" teapot.exr --offscreen none.png --gl vulkan
refuse 'unwritable picture' 3 'nowhere/x.png' "$VIEWER" teapot.exr --offscreen nowhere/x.png
refuse 'a script with a mistake' 1 'bad.txt: line 2, column 9; expected size W H; found' \
    sh -c 'printf "key b\nsize 800\n" >bad.txt; "$VIEWER" teapot.exr --script bad.txt'
refuse 'a near light without depth' 1 'need to know how far the surface is' \
    sh -c 'printf "add point 0 0 1\n" >near.txt; "$VIEWER" bare.exr --script near.txt'
refuse 'a turntable of one view' 2 'turntable: expected a slab' \
    "$VIEWER" teapot.exr --view 0 --record turntable -o none.png
refuse 'a recording over a folder' 2 'already exists; expected a new or empty folder$' "$VIEWER" teapot.exr --record sweep -o teapot
refuse 'a recording without a name' 2 'expected --record KIND and -o OUT' \
    "$VIEWER" teapot.exr --record sweep
refuse 'a film without ffmpeg' 3 'ffmpeg is not installed' \
    env PATH=/nonexistent "$VIEWER" teapot.exr --record sweep -o none.png.mp4 --frames 2
refuse 'a panel too large' 2 '--ui-scale: expected a number from 0.5 to 4' "$VIEWER" teapot.exr --ui-scale 5
refuse 'an unknown pass' 2 "did you mean 'normals'" "$VIEWER" teapot.exr --pass normal
if [ -e none.png ]; then not_ok 'nothing is written' 'none.png exists'; else ok 'nothing is written'; fi
finish
