#!/bin/sh
# Light between captured scenes and objects from the command line: what the ways do to a slab, a
# panorama and a panorama without depth; options; bad input.
#
# Compares: between/front.frag.glsl, between/gather.glsl, between/lamps.frag.glsl,
# between/mesh.vert.glsl, between/scene.frag.glsl, between/shown.frag.glsl,
# between/smooth.frag.glsl, transport/between.comp.glsl, transport/ism.comp.glsl,
# transport/leaves.comp.glsl, transport/lights.comp.glsl, transport/maps.comp.glsl,
# transport/micro.comp.glsl, transport/tree.glsl, transport/up.comp.glsl, transport/virtual.glsl
# with between.c, cut.c, exchange.c, exchange_gather.c, exchange_lamps.c, hierarchy.c, hierarchy.h,
# instant.c, maps.c, micro.c, scenery.c, screen.c, smooth.c, transport.c, virtual.c, virtual.h.
. "$(dirname "$0")/lib.sh"

awk -v n=24 -f "$TOP/scripts/ball.awk" >ball.obj
objects() { # translate, material
    echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"ball.obj\",
        \"parts\":[{\"material\":$2}],\"pose\":{\"scale\":0.3,\"translate\":[$1]}}]}"
}
objects '0,-0.6,-1.4' '{"diffuse":[0.8,0.4,0.2]}' >ball.json
"$RELUME" synth attic -q -o room --projection spherical --size 32 --lights 6 --samples 1
"$RELUME" encode -q room -o room.exr --shadows no
look="--tilt -20 --size 48x32"
for way in none ssao ssdo ism radiosity micro path; do
    expect_ok "$way" - "$RELUME" relight room.exr --objects ball.json $look -o $way.exr --light 'dir 0 1 0' --transport $way -q
done
expect_ok 'none is what is done without' - "$RELUME" relight room.exr --objects ball.json $look -o without.exr --light 'dir 0 1 0' -q
check 'the same' cmp none.exr without.exr
check 'light goes between' sh -c "'$RELUME' compare none.exr path.exr | awk '/max_abs/ { exit !(\$2 > 0.02) }'"
expect_ok 'twice the same' - "$RELUME" relight room.exr --objects ball.json $look -o again.exr --light 'dir 0 1 0' --transport path --threads 1 -q
check 'byte for byte' cmp path.exr again.exr
expect_ok 'samples and bounces' - "$RELUME" relight room.exr --objects ball.json $look -o few.exr --transport path --samples 100 --bounces 0 -q
expect_ok 'at every pixel' - "$RELUME" relight room.exr --objects ball.json $look -o each.exr --light 'dir 0 1 0' --transport micro --spacing 1 --samples 100 -q
check 'nearly the same as at every fourth' sh -c "'$RELUME' compare each.exr micro.exr | awk '/^rms/ { exit !(\$2 > 0 && \$2 < 0.02) }'"


# a film, as docs/transport.md has it: as the sun sinks, ball and room darken together
mkdir film
awk 'BEGIN { for (i = 0; i < 4; i++) { a = 0.35 + i * 1.05 / 3; print i + 100, sin(a), cos(a), .1 } }' |
    while read -r n x y z; do
        "$RELUME" relight room.exr --objects ball.json $look -o film/$n.pfm --light "dir $x $y $z" --transport ssdo -q
    done
for n in 100 101 102 103; do
    tail -n +4 film/$n.pfm | od -An -v -w12 -tf4 | awk '{
        x = (NR - 1) % 48; y = int((NR - 1) / 48); v = $1 + $2 + $3
        if (x > 20 && x < 27 && y > 12 && y < 20) { ball += v; n++ } else { room += v; k++ }
    } END { print ball / n, room / k }'
done >film.txt
check 'ball and room darken together' awk 'NR > 1 && !($1 < 0.95 * ball && $2 < 0.95 * room) { exit 1 } { ball = $1; room = $2 } END { exit NR != 4 || !(room > 0) }' film.txt

# small pictures do, also for what shines, here by its own library: they are warped by the material
expect_ok 'pictures of 8 x 8' - "$RELUME" relight room.exr --objects ball.json $look -o small.exr --light 'dir 0 1 0' --transport micro --samples 64 -q
check 'are the default' cmp small.exr micro.exr
printf 'newmtl shiny\nKd 0.8 0.4 0.2\nPr 0.3\n' >shiny.mtl
{ printf 'mtllib shiny.mtl\nusemtl shiny\n' && cat ball.obj; } >shiny.obj
objects '0,-0.6,-1.4' 0 | sed 's/"ball.obj"/"shiny.obj"/; s/"parts":\[[^]]*\],//' >shiny.json
for samples in '' '--samples 576'; do
    expect_ok "gloss $samples" - "$RELUME" relight room.exr --objects shiny.json $look -o "shiny$samples.exr" --light 'dir 0 1 0' --transport micro $samples -q
done
check 'is nearly that of 24 x 24' sh -c "'$RELUME' compare shiny.exr 'shiny--samples 576.exr' | awk '/^rms/ { exit !(\$2 > 0 && \$2 < 0.001) }'"
check 'and shines' sh -c "'$RELUME' compare shiny.exr micro.exr | awk '/max_abs/ { exit !(\$2 > 0.02) }'"

check 'by virtual lights' sh -c "'$RELUME' compare none.exr ism.exr | awk '/max_abs/ { exit !(\$2 > 0.02) }'"
check 'as exact shadows have it' sh -c "'$RELUME' compare radiosity.exr ism.exr | awk '/rms/ { exit !(\$2 < 0.02) }'"
expect_ok 'one light a pixel' - "$RELUME" relight room.exr --objects ball.json $look -o few.exr --transport ism --samples 1 --bounces 0 -q
expect_fail 'a million virtual lights' 1 'at most 4096 samples' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport ism --samples 15625
# a sheet that is open, one that is turned round, and one without area
corners='v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n'
printf "${corners}vn 0 -1 0\nf 1/1/1 2/2/1 3/3/1 4/4/1\n" >up.obj
printf "${corners}vn 0 1 0\nf 4/4/1 3/3/1 2/2/1 1/1/1\n" >down.obj
for sheet in up down; do
    objects '0,-0.6,-1.4' '{"diffuse":[0.8,0.4,0.2]}' | sed "s/ball.obj/$sheet.obj/" >$sheet.json
    expect_ok "a sheet: $sheet" - "$RELUME" relight room.exr --objects $sheet.json $look -o $sheet.exr --transport ism -q
done
check 'whichever way it is turned' sh -c "'$RELUME' compare up.exr down.exr | awk '/rms/ { exit !(\$2 < 0.002) }'"

# lamps of an environment are looked for between pixels, too
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n' >sky.hdr
printf '\200\200\200\202\200\200\200\200\200\100\100\200\100\100\200\201\100\100\100\200\100\100\100\200\100\100\100\200\100\100\100\200' >>sky.hdr
for spacing in 1 4; do
    expect_ok "under a sky, spacing $spacing" - "$RELUME" relight room.exr --objects ball.json --tilt -20 --size 96x64 -o sky$spacing.exr --light 'env sky.hdr' --transport micro --spacing $spacing -q
done
check 'hardly differ' sh -c "'$RELUME' compare sky1.exr sky4.exr | awk '/^rms/ { exit !(\$2 > 0 && \$2 < 0.01) }'"
check 'nor does what is lit alone' sh -c "'$RELUME' relight room.exr --objects ball.json --tilt -20 --size 96x64 -o skyp.exr --light 'env sky.hdr' --transport path -q && '$RELUME' compare sky4.exr skyp.exr | awk '/^rms/ { exit !(\$2 < 0.03) }'"

# few captured lights foretell less than none: what objects send does not make more of it
expect_ok 'a lamp near by' - "$RELUME" relight room.exr --objects ball.json $look -o near.pfm --light 'point 0 0 0' --transport micro -q
above 'no more darkness' "$(tail -n +4 near.pfm | od -An -v -tf4 | awk '{ for (i = 1; i <= NF; i++) if ($i < least) least = $i } END { print least + 0 }')" -0.05

# an object before the plane of a slab: it is lit from behind by what it stands before
"$RELUME" synth teapot -q -o slab --views 2x2 --size 24 --lights 6 --samples 1
"$RELUME" encode -q slab -o slab.exr --shadows no
objects '0,0,0.6' '{"diffuse":0.7}' >front.json
expect_ok 'a slab' - "$RELUME" relight slab.exr --objects front.json -o slab-ssdo.exr --transport ssdo -q

# a panorama without depth is far away, which is said once
"$RELUME" encode -q room -o far.exr --no-depth
expect_ok 'a far panorama' - "$RELUME" relight far.exr --objects ball.json $look -o far.png --transport ssdo
check 'is told' test "$(grep -c 'the panorama has no depth' err.txt)" = 1
objects '0,-0.6,-1.4' '{"mirror":1}' >mirror.json
expect_ok 'with a mirror in it' - "$RELUME" relight far.exr --objects mirror.json $look -o far.png --transport path -q
expect_fail 'without light between it needs depth' 1 'how far the scene is' x.png "$RELUME" relight far.exr --objects ball.json -o x.png

# the viewer draws what relight does, two ways beside each other, and how far they are apart
viewed() { # name, way, file, options...
    name=$1 way=$2 file=$3
    shift 3
    "$VIEWER" "$file" --objects ball.json --size 48x32 --offscreen viewed.exr --light 'dir 0 1 0' --transport "$way" "$@" 2>err.txt &&
        "$RELUME" relight "$file" --objects ball.json --size 48x32 -o cpu.exr --light 'dir 0 1 0' --transport "$way" "$@" -q || {
        not_ok "$name" "a program failed"
        return
    }
    check "$name" cmp viewed.exr cpu.exr
}
ways=$("$VIEWER" room.exr --objects ball.json --transport x 2>&1 | sed -n 's/.*one of: none //p')
check 'the viewer has all ways' test "$(echo $ways | wc -w)" -ge 3
for way in $ways; do viewed "the viewer shows $way" $way room.exr --tilt -20; done
viewed 'the viewer takes samples and bounces' path room.exr --tilt -20 --samples 10 --bounces 0
viewed 'the viewer shows a far panorama' ssdo far.exr --tilt -20
check 'and says so once' test "$(grep -c 'the panorama has no depth' err.txt)" = 1
viewed 'the viewer shows a slab' ssdo slab.exr
# passes of the graphics card: nearer to the library's picture than hard shadows are by far
"$RELUME" synth attic -q -o hall --projection spherical --size 96 --lights 12 --samples 2
"$RELUME" encode -q hall -o hall.exr --shadows no
passes() { # name, way, most error over that of hard shadows, lights and options...
    name=$1 way=$2 most=$3 hard="hard $5.exr"
    shift 3
    "$VIEWER" hall.exr --objects ball.json --tilt -20 --size 96x64 --relight passes --offscreen passes.exr --transport "$way" "$@" &&
        "$VIEWER" hall.exr --objects ball.json --tilt -20 --size 96x64 --relight library --offscreen library.exr --transport "$way" "$@" &&
        { [ -e "$hard" ] || "$VIEWER" hall.exr --objects ball.json --tilt -20 --size 96x64 --offscreen "$hard" $1 "$2"; } || {
        not_ok "$name" "a program failed"
        return
    }
    off=$("$RELUME" compare library.exr passes.exr | awk '$1 == "rms" { print $2 }')
    below "$name" "$(awk -v a="$off" -v b="$("$RELUME" compare library.exr "$hard" | awk '$1 == "rms" { print $2 }')" 'BEGIN { print a / b }')" "$most"
}
# what is left are borders of shadows, and outlines, which software draws without means
passes 'ssdo by passes' ssdo 0.35 --light 'dir 0 1 0'
passes 'ssao by passes' ssao 0.35 --light 'dir 0 1 0'
passes 'a sun through the window by passes' ssdo 0.35 --light 'dir .3 .3 1'
passes 'no bounces by passes' ssdo 0.35 --light 'dir .3 .3 1' --bounces 0
passes 'small pictures by passes' micro 0.3 --light 'dir 0 1 0' --samples 16
passes 'virtual lights by passes' ism 0.3 --light 'dir 0 1 0' --samples 4
MESA_GL_VERSION_OVERRIDE=3.3FC "$VIEWER" hall.exr --objects ball.json --tilt -20 --size 96x64 --relight passes --offscreen passes.exr --transport ism --light 'dir 0 1 0' --samples 4 2>err.txt
check 'without compute passes by the library' cmp passes.exr library.exr
check 'as is said once' test "$(grep -c 'need OpenGL 4.3' err.txt)" = 1
"$VIEWER" hall.exr --objects ball.json --tilt -20 --size 96x64 --relight passes --offscreen both.exr --transport ssdo --light 'dir 0 1 0' --light 'dir .3 .3 1 rgb 1 .5 .2'
"$VIEWER" hall.exr --objects ball.json --tilt -20 --size 96x64 --relight library --offscreen want.exr --transport ssdo --light 'dir 0 1 0' --light 'dir .3 .3 1 rgb 1 .5 .2'
below 'two lights by passes' "$("$RELUME" compare want.exr both.exr | awk '$1 == "rms" { print $2 }')" 0.03

# in a furnace, all of it 1, a white ball vanishes
awk 'BEGIN { printf "P3\n64 32\n255\n"; for (i = 0; i < 3 * 64 * 32; i++) print 255 }' >white.ppm
awk 'BEGIN { printf "P2\n64 32\n255\n"; for (i = 0; i < 64 * 32; i++) print 128 }' >even.pgm
"$RELUME" panorama white.ppm --transfer linear --depth even.pgm --depth-range 2,3 -o white -q 2>/dev/null
"$RELUME" encode -q white -o white.exr 2>/dev/null
objects '0,-0.6,-1.4' '{"diffuse":1}' >white.json
for way in ssao ssdo micro ism; do
    "$VIEWER" white.exr --objects white.json --tilt -20 --size 96x64 --relight passes --offscreen furnace.pfm --transport $way --samples 16
    tail -n +4 furnace.pfm | od -An -v -tf4 | awk '{ for (i = 1; i <= NF; i++) { d = $i > 1 ? $i - 1 : 1 - $i; sum += d; n++; if (d > most) most = d } } END { print most, sum / n }' >off.txt
    test $way = ism || below "a furnace: $way by passes" "$(cut -d' ' -f1 off.txt)" 0.03
done
below 'a furnace on average: ism by passes' "$(cut -d' ' -f2 off.txt)" 0.01 # where they are near, lights are discs

cat >ways.txt <<'END'
size 48 32
frame none.exr
transport ssdo
frame one.exr
transport beside path
frame sides.exr
transport difference path
frame apart.exr
transport difference ssdo
frame same.exr
transport alone
key ctrl+t
frame next.exr
transport path
key tab
shot panel.png
END
expect_ok 'ways in a script' - "$VIEWER" room.exr --objects ball.json --tilt -20 --script ways.txt
for pair in none:one one:sides sides:apart apart:same one:next; do
    differ "ways: ${pair%:*} and ${pair#*:}" "${pair%:*}.exr" "${pair#*:}.exr"
done
check 'a way is not apart from itself' sh -c "'$RELUME' relight room.exr --objects ball.json $look -o black.exr --light 'dir 0 1 0 rgb 0 0 0' -q; '$RELUME' compare same.exr black.exr | awk '\$1 == \"max_abs\" { exit !(\$2 == 0) }'"
echo 'transport sdo' >bad.txt
refuse 'a way in a script that is none' 1 "column 11; expected WAY, beside WAY, .*ssdo, .*or path; found 'sdo'" "$VIEWER" room.exr --objects ball.json --script bad.txt
echo 'transport ssdo' >bad.txt
refuse 'a way without objects' 1 'expected objects in a scene' "$VIEWER" room.exr --script bad.txt
refuse 'a way in a script beside objects alone' 1 'expected objects in a scene' "$VIEWER" ball.json --script bad.txt
refuse 'a way for objects alone' 2 'only with objects in a scene' "$VIEWER" ball.json --offscreen x.png --transport ssdo
refuse 'a way for a scene alone' 2 'only with objects in a scene' "$VIEWER" room.exr --offscreen x.png --transport ssdo
refuse 'a way of the viewer that is none' 2 "unknown --transport 'sddo'; did you mean 'ssdo'" "$VIEWER" room.exr --objects ball.json --offscreen x.png --transport sddo
refuse 'the viewer without depth and a way' 1 'how far the scene is' "$VIEWER" far.exr --objects ball.json --offscreen x.png

# light goes below the surface of what is translucent, under all ways and lights
objects '0,-0.6,-1.4' '{"translucent":{"preset":"skin","scale_mm":30}}' >skin.json
for way in none ssao ssdo ism radiosity path; do
    expect_ok "translucent, $way" - "$RELUME" relight room.exr --objects skin.json $look -o skin-$way.exr --light 'dir 0 1 0' --transport $way -q
done
check 'it is lit by the room' sh -c "'$RELUME' compare skin-none.exr skin-path.exr | awk '/max_abs/ { exit !(\$2 > 0.02) }'"
expect_ok 'again by one thread' - "$RELUME" relight room.exr --objects skin.json $look -o again.exr --light 'dir 0 1 0' --transport path --threads 1 -q
check 'byte for byte' cmp skin-path.exr again.exr
for light in 'point 0.5 0.8 -1' 'area 0 1 -1 0.4 0 0 0 0 0.4' 'spot 0 1 -1 0 -1 -0.3 40'; do
    expect_ok "under $light" - "$RELUME" relight room.exr --objects skin.json $look -o lit.exr --light "$light" -q
done
objects '0,0,0' '{"translucent":"marble"}' >marble.json
expect_ok 'alone' - "$RELUME" btf render marble.json -o marble.exr --picture 48x48 --light 'dir 1 0 -0.5'
check 'its size is said to be a guess' grep -q 'marble: nothing says how large object 0 is: taken to be 100 mm long' err.txt
check 'light comes through' sh -c "'$RELUME' btf render marble.json -o behind.exr --picture 48x48 --light 'dir 0 0 -1' -q && ! cmp -s marble.exr behind.exr"
for material in '"jade"' '{"absorption":-1,"reduced_scattering":1}' '{"preset":"marble","scale_mm":0}' '{"preset":"marble","scale":1}' '7'; do
    objects '0,0,0' "{\"translucent\":$material}" >bad.json
    expect_fail "translucent $material" 1 'bad.json: object 0: translucent: (preset|absorption|scale_mm|expected|unknown)' x.png "$RELUME" relight room.exr --objects bad.json -o x.png
done

expect_fail 'a way that is none' 2 "unknown --transport 'sddo'; did you mean 'ssdo'\?" x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport sddo
expect_fail 'without objects' 2 'work only with --objects' x.png "$RELUME" relight room.exr -o x.png --transport path
expect_fail 'many rays a pixel' 2 'expected 1 to 16 rays' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --samples 17
expect_fail 'spacing of a way that shares directions' 2 '\-\-spacing works only with --transport micro and path' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport ssdo --spacing 2
expect_fail 'cameras of a way that has none' 2 '\-\-cameras works only with --transport ssao and ssdo' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport micro --cameras 2
expect_fail 'many cameras' 2 'cameras' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport ssdo --cameras 17
for n in 0 1 16; do
    expect_ok "$n cameras" - "$RELUME" relight room.exr --objects ball.json $look -o cameras-$n.exr --light 'dir 0 1 0' --transport ssdo --cameras $n -q
done
differ 'a camera sees more' cameras-0.exr cameras-1.exr
expect_fail 'far apart' 2 'spacing' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport micro --spacing 17
expect_fail 'many bounces' 2 'bounces' x.png "$RELUME" relight room.exr --objects ball.json -o x.png --transport path --bounces 17
for material in '{"diffuse":1.5}' '{"diffuse":"red"}' '{"diffuse":0.5,"mirror":1}' '{"diffuse":[1,1]}'; do
    objects '0,0,0' "$material" >bad.json
    expect_fail "material $material" 1 'bad.json: object 0: (diffuse|material): expected' x.png "$RELUME" relight room.exr --objects bad.json -o x.png
done
objects '0,0,0' '{"difuse":0.5}' >bad.json
expect_fail 'a misspelt material' 1 "unknown member 'difuse'; did you mean 'diffuse'\?" x.png "$RELUME" relight room.exr --objects bad.json -o x.png
finish
