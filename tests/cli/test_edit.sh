#!/bin/sh
# relume btf edit, btf make and maps edit: lists of edits beside what they change, shown, undone, baked, refused.
. "$(dirname "$0")/lib.sh"
"$RELUME" btf plant -o found.exr --size 12 --directions coarse -q
"$RELUME" btf render found.exr -o logo.png --light 'dir 0.4 0.2 0.8' -q
cp logo.png 'a name.png'
show() { "$RELUME" btf render "$1" -o "$2" --eye 0.2,-0.3,0.9 --light 'dir -0.6 0.3 0.7' -q; }
show found.exr before.exr
cp found.exr kept.exr

# ---- a list of g-BRDF edits
expect_ok 'several edits' 'found.exr: 3 edits apply, 0 undone' "$RELUME" btf edit found.exr --emboss 'a name.png' --height 0.03 --at 0.3,0.4 \
    --size 0.5 --roughness 0.6 --label 1 --tint 1,0.8,0.6 --mask logo.png
same 'the file is as it was' found.exr kept.exr
"$RELUME" btf edit found.exr >list.txt 2>err.txt
check 'the list, in its order' sh -c 'printf "%s\n" "1   emboss drawing 12x12 height 0.03 at 0.3,0.4 size 0.5" "2   roughness factor 0.6 label 1" "3   tint factors 1,0.8,0.6 mask 12x12" | cmp - list.txt'
check 'without a word' test ! -s err.txt
check 'info counts edits' sh -c "'$RELUME' btf info found.exr | grep -q '^edits    3, 0 undone'"
show found.exr edited.exr
differ 'they are seen' before.exr edited.exr
expect_ok 'bake' - "$RELUME" btf edit found.exr -o baked.exr
check 'baked has no list' test ! -e baked.edits.json
show baked.exr again.exr
same 'baked, the picture is the same' edited.exr again.exr
"$RELUME" btf expand found.exr -o one -q && "$RELUME" btf expand baked.exr -o two -q
check 'so is what expands' cmp one/values.npy two/values.npy
expect_ok 'eval' - "$RELUME" btf eval found.exr two --json
below 'of what it shows' "$(field relative_rms out.txt)" 0.001
"$RELUME" btf edit found.exr --undo --undo --undo -q
show found.exr undone.exr
same 'undone, the picture is that before' before.exr undone.exr
expect_fail 'nothing left to undo' 2 'undo: there is no edit left to undo' - "$RELUME" btf edit found.exr --undo
"$RELUME" btf edit found.exr --redo --redo --redo -q
show found.exr again.exr
same 'redone, it is the edited one' edited.exr again.exr
"$RELUME" btf edit found.exr --undo --json -q >out.txt
check 'JSON counts' grep -q '^{"edits": 3, "undone": 1, "list": \[{"operation": "emboss", "undone": false, .*"undone": true' out.txt
mkdir moved && cp found.exr moved/other.exr && cp found.edits.json moved/other.edits.json && rm 'a name.png'
show moved/other.exr one.exr && show found.exr two.exr
same 'a list goes where its file goes' one.exr two.exr
expect_ok 'a folder' - "$RELUME" btf edit found.exr -o folder
"$RELUME" btf edit folder --swap 0,2 --turn 30 --channels GBR --add-material 0.3 --r0 0.9 --colour 0,0,0 --highlight 1,0.7,0.3 --mask logo.png --engrave logo.png -q
check 'a folder has its list within' grep -q '"relumeEdits": 1' folder/edits.json
show folder one.exr
differ 'and shows it' one.exr two.exr
cp -r folder other && "$RELUME" btf edit other --undo --undo --undo --undo --undo -q
show other one.exr
same 'and loses it' one.exr two.exr
check 'lists name a parameter once' sh -c "'$RELUME' btf edit other | grep -q '^3   channels GBR (undone)'"

# ---- what is refused
list=$(cat found.edits.json)
refused() { # name, pattern, options...
    name=$1 pattern=$2
    shift 2
    expect_fail "$name" 2 "$pattern" - "$RELUME" btf edit found.exr "$@"
    [ "$list" = "$(cat found.edits.json)" ] || not_ok "$name" 'the list has changed'
}
refused 'a parameter without an operation' 'height: comes after the operation' --height 0.1
refused 'a parameter of another operation' 'height: stands behind --tint, which takes none' --tint 1,1,1 --height 0.1
refused 'a number out of range' 'roughness: factor; expected|roughness: factor: expected 0.1 to 10; found .1e9.' --roughness 1e9
refused 'no number' "tint: factors: expected R,G,B, each 0 to 16; found '1,red,1'" --tint 1,red,1
refused 'channels' "^relume: channels: expected three of R, G and B, as GBR; found 'RGBA'" --channels RGBA
refused 'labels' "swap: labels: expected two different labels" --swap 1
refused 'a label for itself' "swap: labels: expected two different labels, as 0,2; found '0,0'" --swap 0,0
expect_fail 'a label that is not there' 1 'edit 3, tint: there is no material 9; expected a label from 0 to 2' - "$RELUME" btf edit found.exr --tint 1,1,1 --label 9
expect_fail 'no drawing' 1 'nothing.png: no such file' - "$RELUME" btf edit found.exr --emboss nothing.png
expect_fail 'a relief too high' 1 'engrave: the relief becomes higher than one width' - "$RELUME" btf edit found.exr --engrave logo.png --height 1 --engrave logo.png --height 1
"$RELUME" btf render found.exr -o black.png --light 'dir 0.9 0.9 -0.1' -q
expect_fail 'a black mask' 1 'the mask leaves no texel' - "$RELUME" btf edit found.exr --tint 1,1,2 --mask black.png
expect_fail 'onto itself' 2 'found.exr' - "$RELUME" btf edit found.exr -o found.exr
check 'the list is as it was' test "$list" = "$(cat found.edits.json)"
cp found.edits.json list.json
"$RELUME" btf plant -o found.exr --size 12 --directions coarse --seed 1 -q
for task in 'render found.exr -o x.exr' 'info found.exr' 'edit found.exr' 'edit found.exr --undo'; do
    expect_fail "edits of another version: $task" 1 'found.edits.json: these edits are for another version of found.exr .*--clear' x.exr "$RELUME" btf $task
done
expect_ok 'dropped' '0 edits apply' "$RELUME" btf edit found.exr --clear
check 'and shown again' "$RELUME" btf info found.exr
mv kept.exr found.exr && mv list.json found.edits.json
check 'the version that they are for' "$RELUME" btf info found.exr
head -c 200 found.edits.json >cut.json && mv cut.json found.edits.json
expect_fail 'a cut list' 1 'found.edits.json: line .*expected JSON' - "$RELUME" btf info found.exr
"$RELUME" btf plant -o plant -q --size 8 --directions coarse && "$RELUME" btf expand plant -o values -q
"$RELUME" btf fit values --model lit -o lit -q
expect_fail 'another model' 1 'model lit cannot be edited; expected gbrdf' - "$RELUME" btf edit lit --tint 1,1,1
"$RELUME" btf fit values --model gbrdf --levels 2 -o levels -q
expect_fail 'levels of detail' 1 '2 levels of detail' - "$RELUME" btf edit levels --tint 1,1,1
expect_fail 'a picture' 1 "logo.png.*model.json|logo.png" - "$RELUME" btf edit logo.png --tint 1,1,1

expect_fail 'an option of another task' 2 'btf expand: --directions does nothing here' x "$RELUME" btf expand baked.exr -o x --directions coarse

# ---- in the viewer: edits by a script are those of the tool, kept, seen and undone
"$RELUME" btf plant -o seen.exr --size 12 --directions coarse -q && cp logo.png 'a name.png'
cat >edits.txt <<'SCRIPT'
light dir -0.6 0.3 0.7
frame bare.png
edit emboss "a name.png" height 0.04 size 0.5
edit tint 1,0.5,0.4 label 1
frame changed.png
edit undo
edit undo
frame undone.png
edit redo
edit redo
SCRIPT
expect_ok 'a script edits' - "$VIEWER" seen.exr --size 80x60 --script edits.txt --offscreen redone.png
"$RELUME" btf edit seen.exr >list.txt
check 'its list is kept' sh -c 'printf "%s\n" "1   emboss drawing 12x12 height 0.04 at 0.5,0.5 size 0.5" "2   tint factors 1,0.5,0.4 label 1" | cmp - list.txt'
differ 'edits are seen at once' bare.png changed.png
same 'and undone' bare.png undone.png
same 'and redone' changed.png redone.png
"$VIEWER" seen.exr --size 80x60 --light 'dir -0.6 0.3 0.7' --offscreen opened.png 2>err.txt
same 'a file that is opened shows them' changed.png opened.png
script_fails() { # name, material, pattern
    "$VIEWER" "$2" --size 80x60 --script edits.txt --offscreen x.png 2>err.txt
    status=$?
    errors_of err.txt >only.txt
    if [ "$status" -eq 1 ] && [ "$(wc -l <only.txt)" -eq 1 ] && grep -q "^relume-view: edits.txt: line 1, .*$3" only.txt && [ ! -e x.png ]; then
        ok "$1"
    else
        not_ok "$1" "status $status; $(cat err.txt)"
    fi
}
while read -r pattern words; do
    echo "edit $words" >edits.txt
    script_fails "a script's edit $words" seen.exr "$pattern"
done <<'SCRIPTS'
operation paint 3
operation roughness
value roughness 0.5 label
has.no.height roughness 0.5 height 2
material.9 tint 1,1,1 label 9
left redo
such.file emboss nothing.png
SCRIPTS
check 'what is refused is not kept' sh -c "'$RELUME' btf edit seen.exr | cmp - list.txt"
script_fails 'edits of what is none' lit 'expected a g-BRDF to be shown alone'

# ---- from two photographs
expect_ok 'make' - "$RELUME" btf make logo.png logo.png -o made.exr --relief 0.02 --roughness 0.4 --turn 45 --r0 0.1 --highlight 1,1,0.9
check 'its size' sh -c "'$RELUME' btf info made.exr | grep -q '^texels   12 x 12'"
show made.exr made.png
expect_ok 'made and edited' '1 edit applies' "$RELUME" btf edit made.exr --roughness 1.5
expect_fail 'make without a photograph' 1 'nothing.jpg: no such file' x.exr "$RELUME" btf make nothing.jpg logo.png -o x.exr
expect_fail 'a highlight that is none' 2 'shine: expected 0 to 1 each; found 7' x.exr "$RELUME" btf make logo.png logo.png -o x.exr --highlight 7,1,1
"$mkimage" poke before.exr odd.exr 3 4 nan
expect_fail 'a photograph with NaN' 1 'NaN or infinity' x.exr "$RELUME" btf make odd.exr logo.png -o x.exr

# ---- maps
"$sphere" photos --size 16 --lights 12 --hemisphere --shade lambert --format exr
"$RELUME" maps photos -o maps --width 50 -q && cp -r maps original
expect_ok 'maps: edits, and edited maps' 'maps: 2 edits apply' "$RELUME" maps edit maps --emboss logo.png --height 0.05 --size 0.5 --tint 1,0.5,0.25 -o gold
check 'the same files' test "$(ls gold | tr '\n' ' ')" = "$(ls original | tr '\n' ' ')"
for f in normal.exr height.exr basecolor.exr basecolor.png; do differ "maps: $f" original/$f gold/$f; done
for f in roughness.exr metallic.exr confidence.exr model.mtlx; do same "maps: $f" original/$f gold/$f; done
mv maps/edits.json list.json
check 'measured maps are as they were' diff -r maps original
mv list.json maps/edits.json
"$RELUME" maps edit maps >out.txt
check 'maps: the list' grep -qx '2   tint factors 1,0.5,0.25' out.txt
expect_ok 'maps: undone' 'maps: 0 edits apply, 2 undone' "$RELUME" maps edit maps --undo --undo -o plain
for f in normal.exr height.exr basecolor.png specular.png orm.png model.gltf; do same "maps: undone, $f" original/$f plain/$f; done
expect_fail 'maps have no labels' 2 'label' - "$RELUME" maps edit maps --tint 1,1,1 --label 0
expect_fail 'maps that are made again lose no list' 2 'maps.*edits.json' - "$RELUME" maps photos -o maps --force
mv maps/edits.json list.json && "$RELUME" maps photos -o maps --force --gain 0.5 -q && mv list.json maps/edits.json
expect_fail 'maps: edits of another version' 1 'maps/edits.json: these edits are for another version' x "$RELUME" maps edit maps -o x
expect_fail 'maps: what only -o shows' 2 'directx and --mesh are about what is written' - "$RELUME" maps edit maps --mesh 10
expect_fail 'no maps' 1 'photos/maps.json: no such file; expected a folder as relume maps makes it' x "$RELUME" maps edit photos -o x
expect_ok 'maps behind its options' - "$RELUME" maps -o named photos
finish
