#!/bin/sh
# relume-view as a program: frames without a display equal those of relume relight, and what it says
# when it cannot show anything.
. "$(dirname "$0")/lib.sh"

"$RELUME" synth teapot -q -o teapot --views 2x2 --lights 12 --size 24 --samples 1 || exit 1
"$RELUME" encode -q teapot -o teapot.exr || exit 1
light="dir 0.5 0.4 0.8"

same() { # name, options...: both programs draw the same linear frame
    name=$1
    shift
    "$RELUME" relight teapot.exr -o cpu.exr --light "$light" "$@" &&
        "$VIEWER" teapot.exr --offscreen gpu.exr --light "$light" "$@" || {
        not_ok "$name" "a program failed"
        return
    }
    # single precision on both sides, values up to about 2: 1e-4 is ample
    worst=$("$RELUME" compare cpu.exr gpu.exr | awk '$1 == "max_abs" { print $2 }')
    if awk "BEGIN { exit !($worst < 1e-4) }"; then ok "$name"; else not_ok "$name" "off by $worst"; fi
}
same 'the default frame'
same 'a captured view' --view 3
same 'an eye between cameras' --eye 0.1,-0.2,3

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

# Mesa draws by the same code whether OSMesa or EGL asks; a graphics card rounds in its own way.
if "$VIEWER" teapot.exr --offscreen egl.exr --gl egl 2>err.txt; then
    "$VIEWER" teapot.exr --offscreen osmesa.exr --gl osmesa
    worst=$("$RELUME" compare egl.exr osmesa.exr | awk '$1 == "max_abs" { print $2 }')
    if awk "BEGIN { exit !($worst < 1e-3) }"; then ok 'EGL and OSMesa agree'; else not_ok 'EGL and OSMesa agree' "off by $worst"; fi
else
    skip 'EGL and OSMesa agree' "$(cat err.txt)"
fi

refuse() { # name, status, pattern, command...
    name=$1 want=$2 pattern=$3
    shift 3
    timeout 60 "$@" >out.txt 2>err.txt
    status=$?
    if [ "$status" -ne "$want" ]; then
        not_ok "$name" "status $status, expected $want; $(cat err.txt)"
    elif [ "$(wc -l <err.txt)" -ne 1 ] || ! grep -qE "^relume-view: .*$pattern" err.txt; then
        not_ok "$name" "expected one line with /$pattern/, found: $(cat err.txt)"
    else
        ok "$name"
    fi
}
refuse 'no display' 3 'use --offscreen .*package' env -u DISPLAY -u WAYLAND_DISPLAY "$VIEWER" teapot.exr
refuse 'no such file' 1 'none.exr: no such file' "$VIEWER" none.exr --offscreen none.png
refuse 'unknown option' 2 "did you mean '--offscreen'" "$VIEWER" teapot.exr --offscren none.png
refuse 'unknown source of GL' 2 'auto, osmesa or egl; found .vulkan' "$VIEWER" teapot.exr --offscreen none.png --gl vulkan
refuse 'unwritable picture' 3 'nowhere/x.png' "$VIEWER" teapot.exr --offscreen nowhere/x.png
if [ -e none.png ]; then not_ok 'nothing is written' 'none.png exists'; else ok 'nothing is written'; fi
finish
