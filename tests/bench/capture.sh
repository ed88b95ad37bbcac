#!/bin/sh
# capture.sh BUILD [ROLL] - the times of docs/measurements/capture.md: three photographs of 12 megapixels, held by
# hand (one turned by ROLL degrees, default 2; from 3 on blocks are searched twice), aligned by
# macroblocks and merged; twelve photographs of psmImages under one light each, from the
# chrome ball to a relit picture. Seconds of wall clock and of the processor, three runs each.
set -eu
build=$(cd "$1" && pwd) roll=${2:-2} data="$(cd "$(dirname "$0")/../.." && pwd)/../shared/data/psmimages"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
timed() { # name, command...
    name=$1
    shift
    for run in 1 2 3; do
        rm -rf out*
        printf '%-24s run %d  ' "$name" "$run"
        { time -p sh -c '"$@" >log.txt 2>&1' - "$@"; } 2>&1 | awk '{ printf "%s %6.2f  ", $1, $2 } END { print "" }'
    done
}
made_photo="$build/tests/tools/made_photo"
"$made_photo" photo a.jpg 4000 3000 1 0 0 0 0.5
"$made_photo" photo b.jpg 4000 3000 4 1 12 -7 0.5
"$made_photo" photo c.jpg 4000 3000 0.25 "-$roll" -9 14 0.5
printf '1\n4\n0.25\n' >times.txt
timed '3 x 12 megapixels' "$build/relume" hdr a.jpg b.jpg c.jpg --times times.txt --align blocks -o out.exr
if [ -d "$data/chrome" ]; then
    mkdir chrome
    cp "$data"/chrome/chrome.[0-9]*.png chrome/
    timed '12 lights' "$build/relume" capture "$data/buddha" --ball-photos chrome -o out
    timed '12 lights, relit' "$build/relume" capture "$data/buddha" --ball-photos chrome -o out \
        --encode out.exr --relight out.png --light 'dir 0.5 0.3 1'
else
    echo 'skipped: light sequence: no ../shared/data/psmimages'
fi
