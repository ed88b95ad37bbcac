#!/bin/sh
# Pictures of docs/btf.md, docs/gbrdf.md and docs/objects.md.
# btf.sh BUILD_FOLDER WORK_FOLDER PICTURES_FOLDER
# Samples and models stay in the work folder, which may be that of tests/bench/btf_tables.sh, and are
# used again. The cow is left out where ../shared/data is not there.
set -eu
relume=$1/relume draw=$1/samples/figures out=$2 pictures=$3
cow=../shared/data/meshes/spot.obj skies=../shared/data/hdri-polyhaven-1k
mkdir -p "$out/panels" "$pictures"

sample() { # name, material, options...
    name=$1 material=$2
    shift 2
    [ -d "$out/$name" ] || "$relume" synth --btf "$material" -o "$out/$name" "$@" -q
}
model() { # sample, model
    [ -d "$out/$1-$2" ] || "$relume" btf fit "$out/$1" --model "$2" -o "$out/$1-$2" -q
}
# Shadows are not black in a room: a weak light from the eye.
fill='dir 0.3 -0.3 0.9 rgb 0.12 0.12 0.12'
swatch() { # picture, BTF or model, eye, light
    "$relume" btf render "$2" -o "$out/panels/$1.exr" --eye "$3" --light "$4" --light "$fill" -q
}
names() { for panel; do echo "$out/panels/$panel.exr"; done; }

materials='corduroy knit stone leather weave wallpaper aluminium'
n=0
for light in 'dir 0 -0.5 0.9' 'dir -0.9 0 0.45' 'dir 0 0.9 0.4'; do
    n=$((n + 1)) list=
    for m in $materials; do
        sample "$m" "$m" --size 64
        swatch "$m-$n" "$out/$m" 0.3,-0.3,0.9 "$light"
        list="$list $m-$n"
    done
    "$draw" row "$out/panels/row$n.exr" scale=2 $(names $list)
done
"$draw" column "$pictures/btf-materials.png" $(names row1 row2 row3)
echo "  $pictures/btf-materials.png"

sample stone-faults stone --size 64 --blur 1 --noise 0.02 --shift 0.5 --flicker 0.03
n=0 list=
for view in '0.05,-0.1,0.99|dir 0.3 -0.85 0.42' '0.75,-0.3,0.6|dir -0.3 0.3 0.9'; do
    n=$((n + 1))
    swatch "stone-sharp-$n" "$out/stone" "${view%|*}" "${view#*|}"
    swatch "stone-faults-$n" "$out/stone-faults" "${view%|*}" "${view#*|}"
    list="$list stone-sharp-$n stone-faults-$n"
done
"$draw" row "$pictures/btf-faults.png" scale=2 $(names $list)
echo "  $pictures/btf-faults.png"

n=0
for view in '0.05,-0.1,0.99|dir 0.3 -0.85 0.42' '0.75,-0.3,0.6|dir -0.3 0.3 0.9'; do
    n=$((n + 1)) list=
    for m in measured bump laf slaf rfp rfnl vpca lpca; do
        from=$out/stone
        [ $m = measured ] || { model stone $m; from=$out/stone-$m; }
        swatch "stone-$m-$n" "$from" "${view%|*}" "${view#*|}"
        list="$list stone-$m-$n"
    done
    "$draw" row "$out/panels/models$n.exr" scale=2 $(names $list)
done
"$draw" column "$pictures/btf-models.png" $(names models1 models2)
echo "  $pictures/btf-models.png"

# g-BRDFs in the viewer: planted, the same found from what it shows, and a weave, measured and found.
[ -d "$out/planted" ] || { "$relume" btf plant -o "$out/planted.exr" && "$relume" btf expand "$out/planted.exr" -o "$out/planted"; }
sample threads weave --size 128 --directions coarse --samples 1
[ -f "$out/found.exr" ] || "$relume" btf fit "$out/planted" --model gbrdf -o "$out/found.exr" -q
[ -f "$out/threads.exr" ] || "$relume" btf fit "$out/threads" --model gbrdf -o "$out/threads.exr" -q
list=
for m in planted.exr found.exr threads threads.exr; do
    "$1/relume-view" "$out/$m" --size 300x300 --eye 0.9,-2.3,3.4 --look-at 0,0,0.1 --fov 29 --light 'dir -0.6 0.5 0.7 rgb 1.3 1.3 1.3' \
        --light 'dir 0.7 -0.3 0.6 rgb 0.3 0.3 0.4' --offscreen "$out/panels/cushion-$m.exr"
    list="$list cushion-$m"
done
"$draw" row "$pictures/gbrdf.jpg" $(names $list)
echo "  $pictures/gbrdf.jpg"

[ -f "$cow" ] || { echo "skipped: $cow is not there"; exit 0; }
sample cloth corduroy --size 32
for m in measured lit bump laf slaf rfp rfnl rfnlc cmf vpca lpca fmf; do
    from=$out/cloth
    [ $m = measured ] || { model cloth $m; from=$out/cloth-$m; }
    "$relume" btf render "$from" --mesh "$cow" --repeat 5 -o "$out/panels/cow-$m.exr" --picture 220x250 \
        --eye -1.6,1.1,-2.6 --fov 30 --samples 3 --light 'dir -0.6 0.9 -0.9' \
        --light 'dir -1.6 1.1 -2.6 rgb 0.2 0.2 0.22' -q
done
"$draw" row "$out/panels/cows1.exr" $(names cow-measured cow-lit cow-bump cow-laf cow-slaf cow-rfp)
"$draw" row "$out/panels/cows2.exr" $(names cow-rfnl cow-rfnlc cow-cmf cow-vpca cow-lpca cow-fmf)
"$draw" column "$pictures/objects-models.jpg" $(names cows1 cows2)
echo "  $pictures/objects-models.jpg"

[ -d "$skies" ] || { echo "skipped: $skies is not there"; exit 0; }
for sky in sunset forest studio; do
    "$relume" btf render "$out/cloth-rfnl" --mesh "$cow" --repeat 5 -o "$out/panels/cow-$sky.exr" --picture 280x300 \
        --eye -1.2,0.9,-1.9 --fov 42 --samples 2 --light "env $skies/$sky.hdr" -q
done
"$draw" row "$pictures/objects-sky.jpg" $(names cow-sunset cow-forest) gain=0.6 $(names cow-studio)
echo "  $pictures/objects-sky.jpg"
