#!/bin/sh
# Folders of maps in the viewer: shown as the library relights them, edited by a script as by the
# tool, undone, written; what cannot be shown is refused.
. "$(dirname "$0")/lib.sh"

"$RELUME" synth bust -q -o bust --size 48 --lights 12 --hemisphere --samples 2
"$BUILD/tests/tools/maps_relit" bust maps '-0.6 0.3 0.7' library.exr '0.3 0.2 0.9' other.exr || exit 1
"$VIEWER" maps --light 'dir -0.6 0.3 0.7' --offscreen seen.exr || not_ok 'a folder of maps is shown' ''
near() { # two pictures, the largest difference
    "$RELUME" compare "$1" "$2" | awk -v most="$3" '/max_abs/ { exit !($2 < most) }'
}
# pictures of a folder are halves, 0.05 % of what they hold
check 'as the library relights it' near library.exr seen.exr 4e-3
check 'which depends on the light' sh -c "! '$RELUME' compare other.exr seen.exr | awk '/max_abs/ { exit !(\$2 < 0.05) }'"
"$VIEWER" maps --light 'dir -0.6 0.3 0.7 rgb 2 2 2' --offscreen twice.exr
"$VIEWER" maps --light 'dir -0.6 0.3 0.7' --light 'dir -0.6 0.3 0.7' --offscreen sum.exr
check 'lights add up' near twice.exr sum.exr 1e-5

cat >edits.txt <<'SCRIPT'
light dir -0.6 0.3 0.7
frame bare.exr
edit tint 1,0.5,0.4
edit emboss "seen.png" height 0.02 size 0.5
edit roughness 0.7
frame edited.exr
edit undo
edit undo
edit undo
frame undone.exr
edit redo
edit redo
edit redo
edit write "the written"
frame redone.exr
SCRIPT
"$VIEWER" maps --light 'dir 0 0 1' --offscreen seen.png
expect_ok 'a script edits maps' - "$VIEWER" maps --script edits.txt --offscreen x.png
check 'its list is kept' sh -c "'$RELUME' maps edit maps | awk '{ print \$2 }' | tr '\n' ' ' | grep -qx 'tint emboss roughness '"
check 'edits are seen' sh -c '! cmp -s bare.exr edited.exr'
check 'and undone to the bit' cmp -s bare.exr undone.exr
check 'and redone' cmp -s edited.exr redone.exr
"$RELUME" maps edit maps -o tool -q
for map in normal basecolor roughness height; do
    check "what is written is what the tool writes: $map" cmp -s tool/$map.exr "the written/$map.exr"
done
rm -rf bare && cp -r tool bare && rm -f bare/edits.json
"$VIEWER" bare --light 'dir -0.6 0.3 0.7' --offscreen again.exr
check 'what the tool writes is what was seen' near again.exr edited.exr 4e-3

fails() { # name, pattern, arguments
    name=$1 pattern=$2
    shift 2
    rm -f x.exr
    "$VIEWER" "$@" --offscreen x.exr 2>err.txt
    status=$?
    errors_of err.txt >only.txt
    if [ "$status" -eq 1 ] && [ "$(wc -l <only.txt)" -eq 1 ] && grep -q "$pattern" only.txt && [ ! -e x.exr ]; then
        ok "$name"
    else
        not_ok "$name" "status $status; $(cat err.txt)"
    fi
}
fails 'near lights' 'directional lights and environments' maps --light 'point 0 0 1'
fails 'another pass' 'of maps the colour alone' maps --pass normals
echo 'pass normals' >pass.txt
fails 'another pass by a script' 'of maps colour alone' maps --script pass.txt
echo 'edit swap 0,1' >swap.txt
list=$(cat maps/edits.json)
fails 'an edit of g-BRDFs' 'swap.txt: line 1, .*swap' maps --script swap.txt
echo 'edit write maps' >write.txt
fails 'a folder that is there' 'write.txt: line 1, .*maps' maps --script write.txt
check 'the list is as it was' test "$list" = "$(cat maps/edits.json)"
rm -rf cut && cp -r bare cut && head -c 100 bare/normal.exr >cut/normal.exr
fails 'a cut map' 'cut/normal.exr' cut
rm -rf cut && cp -r bare cut && echo '{' >cut/maps.json
fails 'a broken description' 'cut/maps.json: line' cut
finish
