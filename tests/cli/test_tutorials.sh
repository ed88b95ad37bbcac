#!/bin/sh
# Every tutorial runs word for word: scripts/tutorials.sh runs the sh blocks of docs/tutorials as a
# newcomer would, in an empty folder; then what each leaves is looked at. Their pictures are small.
. "$(dirname "$0")/lib.sh"
PATH=$BUILD:$BUILD/samples:$TOP/samples:$PATH
unset MAKEFLAGS
check 'make builds what the tutorials need' make -s -C "$TOP" config=$config all
check 'their programs as well' sh -c \
    'make -n -C "$1" config="$2" -W samples/mirrorball.c all | grep -q samples/mirrorball' - "$TOP" $config

tutorial() { # name, files that must be there
    title=$1
    shift
    mkdir "$title" && cd "$title" || exit 1
    if timeout 120 "$TOP/scripts/tutorials.sh" "$title" >../out.txt 2>../err.txt; then ok "$title.md runs"; else
        not_ok "$title.md runs" "$(tail -n 3 ../err.txt)"
    fi
    for f in "$@"; do check "$title.md makes $f" test -s "$f"; done
    cd ..
}
for page in "$TOP"/docs/tutorials/*.md; do
    title=$(basename "$page" .md)
    check "$title.md is run" grep -q "^tutorial $title " "$TOP/tests/cli/test_tutorials.sh"
    check "$title.md has a picture" test -s "$TOP/docs/pictures/tutorial-$title.jpg"
done

tutorial photographs statue.exr raking.png two.png normals.png specular.png web/info.json statue.html
# the ball is found in photographs that say nothing of the lamps: to 1.5 degrees RMS (half a pixel
# of a ball of 26 pixels is 1.1 degrees of the normal, twice that of the light)
sed -n 's/^ *\[\([-0-9.e, ]*\)\],\{0,1\}$/\1/p' photographs/bust/capture.json | tr -d ',' >truth.txt
below 'photographs.md: the lamps are where they were' "$(tail -n +2 photographs/statue/lights.lp | cut -d' ' -f2- |
    paste -d' ' - truth.txt | awk '{ d = $1 * $4 + $2 * $5 + $3 * $6; if (d > 1) d = 1
        a = atan2(sqrt(1 - d * d), d) * 57.29578; s += a * a } END { print sqrt(s / NR) }')" 1.5
check 'photographs.md: the page holds every plane' test \
    "$(grep -o 'data:image/jpeg' photographs/statue.html | wc -l)" -eq "$(ls photographs/web/plane_*.jpg | wc -l)"

tutorial lightfield field.exr middle.png upper-left.png near.png far.png
# depth found from the views alone; 95.7 % were trusted when this was written
above 'lightfield.md: depth is trusted' "$(sed -n 's/^trusted *\([0-9.]*\) %.*/\1/p' out.txt)" 90
differ 'lightfield.md: the focus moves' lightfield/near.png lightfield/far.png

tutorial material leather_model/model.json ring.obj grain.png side.png ring.png lamp.png
finish
