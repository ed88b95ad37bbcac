#!/bin/sh
# `make demo-web`: a site of a photographed, a walkable and a panoramic thing. demo-web.sh BUILD_FOLDER OUT_FOLDER
# The photographs are item 1 of RealRTI where it lies in $REALRTI, else a made bust.
set -eu
relume=$1/relume out=$2
photographs=${REALRTI:-../shared/data/realrti}/item1
rm -rf "$out"
mkdir -p "$out/made"

if [ -f "$photographs/dirs.lp" ]; then
    first=door title='A painted door under 60 lights'
    maker='RealRTI, thanks to Accademia delle Belle Arti Verona'
    "$relume" encode "$photographs/dirs.lp" -o "$out/made/door.exr"
else
    first=bust title='A marble bust under 60 lights' maker='relume synth'
    "$relume" synth bust -o "$out/made/bust" --lights 60 --hemisphere --size 512 --samples 4
    "$relume" encode "$out/made/bust" -o "$out/made/bust.exr"
fi
"$relume" synth teapot -o "$out/made/teapot" --views 5x5 --lights 49 --size 256 --samples 4
"$relume" encode "$out/made/teapot" -o "$out/made/teapot.exr" --domain display --shadows no
"$relume" synth attic -o "$out/made/attic" --lights 49 --hemisphere --size 256 --samples 4
"$relume" encode "$out/made/attic" -o "$out/made/attic.exr" --domain display --shadows no

cat >"$out/made/site.json" <<END
{
  "title": "Things in another light",
  "description": "A painting, a pot and a room. Open one and drag to move the light.",
  "files": {
    "$first": {"title": "$title", "maker": "$maker"},
    "teapot": {"title": "A teapot that you can walk around", "maker": "relume synth"},
    "attic": {"title": "An attic from its middle", "maker": "relume synth"}
  }
}
END
"$relume" publish "$out/made/$first.exr" "$out/made/teapot.exr" "$out/made/attic.exr" -o "$out/site" \
    --metadata "$out/made/site.json"
echo "  $out/site/index.html"
