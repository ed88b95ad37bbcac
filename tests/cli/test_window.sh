#!/bin/sh
# relume-view in a real window, by real pointer and key events: a virtual X server and xdotool.
. "$(dirname "$0")/lib.sh"
# OpenGL drivers under Xvfb leave some memory behind; frames without a window are checked for leaks.
export ASAN_OPTIONS="${ASAN_OPTIONS:-}:detect_leaks=0"

for program in Xvfb xdotool; do
    command -v "$program" >/dev/null 2>&1 && continue
    skip 'a window and a pointer' "$program is not installed"
    exit 0
done

size=256
"$sphere" photos --size $size --lights 20 --hemisphere &&
    "$RELUME" encode -q photos -o ball.exr --basis hsh --coefficients 9 || exit 1

Xvfb -displayfd 3 -screen 0 800x800x24 -noreset -nolisten tcp 3>display.txt 2>xvfb.txt &
server=$!
viewer=
trap 'kill $viewer $server 2>/dev/null; wait 2>/dev/null; cd /; rm -rf "$work"' EXIT
tries=0
until [ -s display.txt ] || [ $tries -eq 100 ]; do sleep 0.1; tries=$((tries + 1)); done
DISPLAY=:$(cat display.txt)
export DISPLAY
unset WAYLAND_DISPLAY

"$VIEWER" ball.exr --size ${size}x$size --no-config >view.txt 2>&1 &
viewer=$!
window=$(timeout 30 xdotool search --sync --onlyvisible --name 'ball.exr' | head -n 1)
if [ -z "$window" ]; then
    not_ok 'a window opens' "$(cat view.txt xvfb.txt | head -c 600)"
    finish
    exit 1
fi
ok 'a window opens'
xdotool windowmove "$window" 0 0 windowfocus "$window"

# press S and wait for the picture that it saves
picture() { # number
    file=$(printf 'ball-%04d.png' "$1")
    xdotool key s
    tries=0
    until [ -s "$file" ] || [ $tries -eq 100 ]; do sleep 0.1; tries=$((tries + 1)); done
}
# the tool's own picture under the light that the drag should make: one of 255, for either rounding
shows() { # name, picture, SPEC
    if [ ! -s "$2" ]; then not_ok "$1" "$2 was not saved; $(cat view.txt)"; return; fi
    "$RELUME" relight ball.exr -o want.png --light "$3"
    "$RELUME" compare "$2" want.png >difference.txt
    above "$1" "$(awk '$1 == "psnr_db" { print $2 }' difference.txt)" 45
}
drag() { # button, x, y, x, y
    xdotool mousemove "$2" "$3" mousedown "$1" mousemove $((($2 + $4) / 2)) $((($3 + $5) / 2)) \
        mousemove "$4" "$5" mouseup "$1"
    sleep 0.3
}

picture 1
shows 'lit from the front' ball-0001.png 'dir 0 0 1'
drag 3 100 128 132 128 # 32 of 256 pixels: 22.5 degrees to the right
picture 2
shows 'a drag turns the light' ball-0002.png 'dir 0.382683 0 0.923880'
differ 'other pixels' ball-0001.png ball-0002.png
xdotool key Tab
sleep 0.3
drag 1 76 126 109 126 # from the middle of the panel's ball to 0.6 of its radius
picture 3
shows "the panel's ball turns the light" ball-0003.png 'dir 0.6 0 0.8'
xdotool key Tab windowsize "$window" 1 1
sleep 0.3
xdotool windowsize "$window" $size $size
sleep 0.3
picture 4
same 'a window of one pixel and back' ball-0003.png ball-0004.png
xdotool windowunmap "$window"
sleep 0.3
xdotool windowmap "$window" windowfocus "$window"
sleep 0.3
left() { # is the viewer gone within five seconds?
    tries=0
    while [ $tries -lt 50 ] && kill -0 $viewer 2>/dev/null; do sleep 0.1; tries=$((tries + 1)); done
    ! kill -0 $viewer 2>/dev/null
}
quits() { # name
    if ! left; then not_ok "$1" 'it is still there'; return; fi
    wait $viewer
    status=$?
    viewer=
    if [ $status -eq 0 ]; then ok "$1"; else not_ok "$1" "status $status: $(cat view.txt)"; fi
}
# full screen and back: the root window is 800 x 800
geometry() { xdotool getwindowgeometry --shell "$window" | sed -n 's/^WIDTH=//p;s/^HEIGHT=//p' | tr '\n' ' '; }
xdotool key F11
sleep 0.5
check 'F11 fills the screen' test "$(geometry)" = '800 800 '
xdotool key F11
sleep 0.5
check 'F11 again' test "$(geometry)" = "$size $size "
# the help by ?, away by Esc; Esc asks before it quits, Esc again stays
xdotool key question Escape Escape Escape
sleep 0.3
picture 5
same 'Esc does not quit unasked' ball-0003.png ball-0005.png
xdotool mousemove 241 224 mousedown 1 mousemove 254 224 mouseup 1
picture 6
differ 'the ball in the corner turns the light' ball-0003.png ball-0006.png
xdotool key Escape
sleep 0.3
xdotool key Return
quits 'Esc and Enter quit'

# a signal ends it in the middle of a recording, and nothing is left of that
printf 'key k\nwait 30\n' >record.txt
"$VIEWER" ball.exr --size 512x512 --no-config --script record.txt --window >view.txt 2>&1 &
viewer=$!
tries=0
until [ "$(leftovers)" ] || [ $tries -eq 100 ]; do sleep 0.1; tries=$((tries + 1)); done
kill -TERM $viewer
if left; then ok 'a signal ends a window'; else not_ok 'a signal ends a window' 'it is still there'; fi
wait $viewer
check 'by that signal' test $? -eq 143
viewer=
check 'and leaves nothing of its recording' test $tries -lt 100 -a -z "$(leftovers)"

# a screen with twice the pixels: the panel is twice as large, and its ball takes the pointer there
if command -v xprop >/dev/null 2>&1; then
    xprop -root -f RESOURCE_MANAGER 8s -set RESOURCE_MANAGER 'Xft.dpi: 192'
    printf 'key tab\ndrag left 152 252 218 252\nkey w\nkey esc\n' >dense.txt
    timeout 60 "$VIEWER" ball.exr --size 512x512 --no-config --script dense.txt --window >view.txt 2>&1
    x=$(sed -n 's/.*"dir \([^ ]*\) .*/\1/p' ball-0001.json)
    if awk "BEGIN { exit !(${x:-9} > 0.57 && ${x:-9} < 0.63) }"; then ok 'a dense screen'; else
        not_ok 'a dense screen' "x = '$x', expected 0.6; $(cat view.txt)"
    fi
    xprop -root -remove RESOURCE_MANAGER
else
    skip 'a dense screen' 'xprop is not installed'
fi

# a window without a file
printf 'wait 0.1\nkey ctrl+o\nwait 0.1\ntype ball.exr\nkey enter\nwait 0.1\nkey s\nwait 0.1\nquit\n' >empty.txt
timeout 60 "$VIEWER" --size 256x256 --no-config --script empty.txt --window >view.txt 2>&1
check 'a window without a file opens one' test -s ball-0007.png

# light between objects and scene is gathered beside the frames, begun anew and cancelled; what is saved is finished
awk -v n=12 -f "$TOP/scripts/ball.awk" >sphere.obj
echo '{"format":"relume-objects","version":1,"objects":[{"mesh":"sphere.obj","parts":[{"material":[{"diffuse":0.8},{"diffuse":[1,0.2,0.2]}]}],
    "pose":{"scale":0.3,"translate":[0.3,0.3,0.4]}}]}' >sphere.json
printf 'transport path\nwait 0.1\ndrag right 60 40 90 44 0.3\nkey c\nwait 0.1\nlight dir 0.3 0.5 0.8\nkey c\nwait\nkey s\nkey ctrl+t\nkey ctrl+d\nwait\nkey esc\n' >ways.txt
mkdir ways
(cd ways && timeout 100 "$VIEWER" ../ball.exr --objects ../sphere.json --size 120x120 --no-config --script ../ways.txt --window >view.txt 2>&1)
check 'light between in a window' test $? -eq 0 -a ! -s ways/view.txt
"$VIEWER" ball.exr --objects sphere.json --size 120x120 --light 'dir 0.3 0.5 0.8' --transport path --offscreen path.png
check 'is what a picture shows' cmp path.png ways/ball-0001.png

# the window remembers; settings that cannot be read or written are no reason to fail
remembers() { # name, folder for settings, size that is wanted, options...
    name=$1 settings=$2 want=$3
    shift 3
    printf 'wait\nkey esc\n' >leave.txt
    XDG_CONFIG_HOME=$settings timeout 60 "$VIEWER" ball.exr --script leave.txt --window "$@" >view.txt 2>&1
    status=$?
    got=$(sed -n 's/^size //p' "$settings/relume/viewer" 2>/dev/null)
    if [ $status -eq 0 ] && [ ! -s view.txt ] && [ "$got" = "$want" ]; then ok "$name"; else
        not_ok "$name" "status $status, size '$got'; $(cat view.txt)"
    fi
}
remembers 'a size is kept' "$work/config" '300 200' --size 300x200 --light 'dir 1 0 1' --dock right
remembers 'it comes back' "$work/config" '300 200'
check 'lights are not kept unasked' test ! -e config/relume/rig.json
check 'where the panel was' grep -qx 'dock 2' config/relume/viewer
remembers 'lights are kept' "$work/config" '300 200' --light 'dir 1 0 1' --keep-lights
check 'the lights are kept' grep -q 'dir 1 0 1' config/relume/rig.json
printf 'wait\nkey w\nquit\n' >lit.txt
XDG_CONFIG_HOME=$work/config timeout 60 "$VIEWER" ball.exr --script lit.txt --window >view.txt 2>&1
check 'they come back' grep -q 'dir 1 0 1' ball-0002.json
printf 'size -1 99999999\npanel x\n\377\n' >config/relume/viewer
printf '{' >config/relume/rig.json
remembers 'broken settings are forgotten' "$work/config" "$((2 * size)) $((2 * size))"
touch file
remembers 'settings that cannot be written' "$work/file" ''
remembers 'no settings' "$work/none" '' --no-config
check 'nothing is written then' test ! -e none
finish
