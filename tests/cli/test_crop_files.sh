#!/bin/sh
# A part of captures, light fields and files, by encode and publish; notes that move with it.
. "$(dirname "$0")/lib.sh"
"$RELUME" synth bust -o bust --size 128 --lights 24 --hemisphere --samples 1 -q || exit 1
"$BUILD/samples/mirrorball" bust photos || exit 1
relume capture photos -o whole
relume capture photos -o part --crop 40,20,48,80
check 'balls are remembered' grep -q '"balls": \[\[' whole/capture.json

# ---- every kind of file: numbers of a part are those of the whole
n=0
for file in "$TOP"/tests/kept/*/relit/*.exr; do
    "$RELUME" info "$file" --json >info.json || not_ok "$file" 'info failed'
    grep -q '"projection": "\(planar\|slab\)".*"slabs": 0' info.json || continue
    w=$(sed 's/.*"width": \([0-9]*\).*/\1/' info.json) h=$(sed 's/.*"height": \([0-9]*\).*/\1/' info.json)
    n=$((n + 1))
    why=$("$BUILD/tests/tools/parts" "$file" 0 0 "$w" "$h" 1 2 $((w - 3)) $((h - 2)) $((w / 2)) 0 1 $((h / 2)) $((w - 1)) $((h - 1)) 1 1)
    if [ $? = 0 ]; then ok "parts of $(basename "$file")"; else not_ok "parts of $(basename "$file")" "$why"; fi
done
check 'most kinds of files have parts' test "$n" -ge 40

# ---- encode crops a capture as capture crops photographs
expect_ok 'a part of a capture' 'cropped to 40,20,48,80 of 128 x 128 pixels' "$RELUME" encode whole -o cropped.exr --highlights no --crop 40,20,48,80
relume encode part -o part.exr --highlights no
provenance() { "$RELUME" info "$1" --json | sed 's/.*"provenance"://'; }
check 'the same provenance' test "$(provenance cropped.exr)" = "$(provenance part.exr)"
relume relight cropped.exr -o a.exr --light 'dir -0.5 0.4 0.8'
relume relight part.exr -o b.exr --light 'dir -0.5 0.4 0.8'
same 'the same pixels' a.exr b.exr
expect_ok 'the object of a capture' 'cropped to [0-9,]* of 128 x 128' "$RELUME" encode whole -o auto.exr --highlights no --crop auto
sed -n 's/.*cropped to \([0-9]*\),.*/\1/p' err.txt >x.txt
check 'without the ball' test "$(cat x.txt)" -ge 29
relume encode part -o twice.exr --highlights no --crop 5,6,20,30
check 'a part of a part' sh -c 'case $1 in *"\"crop\": [45, 26, 20, 30]"* | *"\"crop\":[45,26,20,30]"*) ;; *) exit 1 ;; esac' - "$(provenance twice.exr)"

# a light field with depth: the same views of a part
"$RELUME" synth box -o slab --size 24 --views 2x2 --lights 6 --samples 1 -q || exit 1
relume encode slab -o slab.exr --basis table --shadows no
relume encode slab -o slab-part.exr --basis table --shadows no --crop 4,6,16,12
for view in 0 3; do
    relume relight slab.exr -o a.exr --view $view --crop 4,6,16,12 --light 'dir 0.3 0.4 0.8'
    relume relight slab-part.exr -o b.exr --view $view --light 'dir 0.3 0.4 0.8'
    above "view $view of a part" "$(psnr a.exr b.exr)" 45
done
expect_fail 'beyond the border' 2 'crop 100,0,40,40: expected a part of the images of 128 x 128 pixels' no.exr "$RELUME" encode whole -o no.exr --crop 100,0,40,40

# ---- publish
relume encode whole -o coin.exr --basis pca --highlights no
note() { "$RELUME" notes coin.exr --add "$@" -q >out.txt || not_ok "note $*" 'failed'; }
note 'point 60,50' --text inside
note 'point 17,100' --text 'the ball'
note 'line 50,40 110,40' --text across
cp coin.notes.json before.json
expect_ok 'a part of a file' 'cropped to 40,20,48,80 of 128 x 128 pixels' "$RELUME" publish coin.exr -o site --crop 40,20,48,80
check 'notes beside it are named' grep -q '1 note lies beside the part that is shown' err.txt
check 'its size' grep -q '"width": *48, *"height": *80' site/coin/scene.json
check 'a note moved' grep -q '"x": *20, *"y": *30' site/coin/notes.json
check 'the ball is not said' sh -c '! grep -q "the ball" site/coin/notes.json'
check 'a line across moved' grep -q 'across' site/coin/notes.json
same 'the file keeps its list' coin.notes.json before.json
expect_ok 'the object of a file' 'cropped to [0-9,]* of 128 x 128' "$RELUME" publish coin.exr -o auto --crop auto
sed -n 's/.*cropped to \([0-9]*\),.*/\1/p' err.txt >x.txt
check 'without the ball' test "$(cat x.txt)" -ge 29
for file in "$TOP"/tests/kept/*/relit/panorama-spherical.exr; do
    expect_fail 'a panorama' 1 'has no parts by themselves; --crop expects a planar file or one slab' no "$RELUME" publish "$file" -o no --crop auto
done
expect_fail 'beyond the border of a file' 2 'crop 100,0,40,40: expected a part of its 128 x 128 pixels' no "$RELUME" publish coin.exr -o no --crop 100,0,40,40

# ---- a file that is replaced by a part of it, and back
relume encode whole -o coin.exr --basis pca --highlights no --crop 40,20,48,80
check 'notes moved with the file' grep -q '"x": *20, *"y": *30' coin.notes.json
check 'what lies beside it is kept' grep -q 'the ball' coin.exr.notes-outside.json
check 'the list belongs to the file' sh -c '"$1" notes coin.exr -q | grep -q inside' - "$RELUME"
relume encode whole -o coin.exr --basis pca --highlights no
check 'and moved back' grep -q '"x": *60, *"y": *50' coin.notes.json
"$RELUME" notes coin.exr --embed -q >out.txt
relume encode whole -o coin.exr --basis pca --highlights no --crop 44,20,40,80
check 'inside a file' sh -c '"$1" notes coin.exr --json | grep -q "16, *30\|\[16,30\]"' - "$RELUME"
finish
