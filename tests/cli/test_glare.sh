#!/bin/sh
# Pictures as an eye sees them: light is kept, patterns are written, films are whole; and every way
# to ask for it wrongly.
. "$(dirname "$0")/lib.sh"
quick="--size 128 --wavelengths 8 --width 9"
glare() { "$RELUME" glare "$@"; }
bad() { # name, status, pattern, options...
    name=$1 want=$2 pattern=$3
    shift 3
    expect_fail "$name" "$want" "$pattern" out.png "$RELUME" glare "$@"
}

"$sphere" dome --size 24 --lights 4 --hemisphere || exit 1
lit=$(find dome -name "*.exr" -o -name "*.png" | sort | head -n 1)
cp "$lit" in.exr
"$mkimage" poke in.exr lamp.exr 12 12 900

expect_ok 'a picture' - "$RELUME" glare lamp.exr -o seen.exr $quick
expect_ok 'the same by one thread' - "$RELUME" glare lamp.exr -o one.exr $quick --threads 1
same 'any number of threads' seen.exr one.exr
for mode in billboard hybrid; do
    expect_ok "mode $mode" - "$RELUME" glare lamp.exr -o $mode.exr $quick --mode $mode
    "$RELUME" compare seen.exr $mode.exr --json >c.json
    above "$mode sees much the same" "$(field psnr_db c.json)" 20
done
expect_ok 'the border goes on' - "$RELUME" glare in.exr -o border.png $quick --border clamp --nits 0

# ---- patterns
expect_ok 'a pattern as a picture' - "$RELUME" glare --psf psf.exr $quick
expect_ok 'a pattern with all that belongs to it' - "$RELUME" glare --psf pattern $quick
for file in psf.exr psf.png aperture.png pupil.svg pupil.png observer.svg observer.png; do
    check "$file" test -s "pattern/$file"
done
same 'the same pattern' psf.exr pattern/psf.exr
glare --psf later.exr $quick --time 2
differ 'time passes' psf.exr later.exr
glare --psf with.exr $quick --luminance 0.01
for part in cornea fibres lens vitreous lids; do
    glare --psf without.exr $quick --without $part --luminance 0.01
    [ $part = lids ] || differ "without $part" with.exr without.exr
done
expect_ok 'planes' - "$RELUME" glare --psf planes.exr $quick --planes 3
differ 'planes differ' psf.exr planes.exr

# ---- films
expect_ok 'numbered pictures' - "$RELUME" glare lamp.exr -o 'f.%03d.png' $quick --frames 3 --fps 25
check 'three of them' test -s f.000.png -a -s f.002.png -a ! -e f.003.png
expect_ok 'a folder' - "$RELUME" glare lamp.exr -o film $quick --frames 3 --fps 25
same 'the same pictures' f.002.png film/0002.png
glare lamp.exr -o single.png $quick --time 1.08
same 'a picture of a film is that of its time' f.002.png single.png
bad 'a folder that is there' 2 'film: already exists; expected a new or empty folder$' lamp.exr -o film $quick --frames 2
if command -v ffmpeg >ffmpeg.txt; then
    expect_ok 'a film' - "$RELUME" glare lamp.exr -o film.mp4 $quick --frames 3
else
    expect_fail 'no ffmpeg' 3 'ffmpeg is not installed' film.mp4 \
        "$RELUME" glare lamp.exr -o film.mp4 $quick --frames 3
fi

# ---- frames of relit files
"$RELUME" encode dome -q -o dome.exr
expect_ok 'a pass of relight' - "$RELUME" relight dome.exr -o pass.png --pass glare --nits 1
"$RELUME" synth attic -q -o attic --projection cylindrical --lights 9 --hemisphere --size 24 --samples 1
"$RELUME" encode attic -q -o attic.exr
seen_alike() { # name, least brightness that glare adds, most, lights; of $file in $look
    what=$1 least=$2 most=$3
    shift 3
    "$RELUME" relight $file -q -o a.exr --pass glare --time 0 $look "$@"
    "$RELUME" relight $file -q -o b.exr $look "$@"
    "$RELUME" compare a.exr b.exr --json >c.json
    above "$what" "$(field max_abs c.json)" "$least"
    below "$what, no more" "$(field max_abs c.json)" "$most"
    expect_ok "$what, in the viewer" - "$VIEWER" $file --offscreen v.exr --glare --sources \
        --glare-mode fft --glare-size 1536 ${look:---size 24x24} "$@"
    "$RELUME" compare a.exr v.exr --json >c.json
    # floats, and reflectances summed in another order: 2e-5 of the brightest pixel was found
    below "$what, and seen alike" "$(field max_abs c.json)" "$(awk "BEGIN { print 1e-4 * $most }")"
}
file=attic.exr look='--pan 0 --size 48x32'
seen_alike 'a lamp and a panel shine' 10 500 --light "point 0.4 0.3 -1 rgb .1 .1 .1" \
    --light "area -0.3 0.4 -1.2 0.1 0 0 0 0.1 0 rgb 3 2 1"
seen_alike 'a lamp behind the wall does not' 0 0.1 --light "point 4 0.3 -9 rgb 10 10 10"
file=dome.exr look=
seen_alike 'a lamp above a picture shines' 10 500 --light "point 0.3 0.5 1.4 rgb .1 .1 .1"
expect_fail 'a panorama unfolded' 2 'expected --pan' p.png \
    "$RELUME" relight attic.exr -o p.png --pass glare

# ---- what cannot be
bad 'no output' 2 'expected -o OUT, --psf OUT' in.exr
bad 'no picture' 2 'expected a picture IN' -o out.png
bad 'two pictures' 2 'found 2 inputs' in.exr in.exr -o out.png
bad 'no such file' 1 'nowhere.exr' nowhere.exr -o out.png
bad 'fov 0' 2 '--fov: expected a number from 0.01 to 170; found .0.' in.exr -o out.png --fov 0
bad 'fov 171' 2 '--fov: expected' in.exr -o out.png --fov 171
bad 'an unknown mode' 2 "unknown --mode 'hybird'; did you mean 'hybrid'" --psf out.png --mode hybird
bad 'an unknown border' 2 'unknown --border' --psf out.png --border mirror
bad 'an unknown part' 2 'unknown --without' --psf out.png --without iris
bad 'odd size' 2 'expected an even number' --psf out.png --size 101
bad 'field and width' 2 'expected one of --field, --width' --psf out.png --field 2 --width 9
bad 'too large on the picture' 2 'at most 16384' in.exr -o out.png --fov 0.05 --magnify 900 $quick
bad 'frames and one name' 2 'for --frames' in.exr -o out.png --frames 2
bad 'fps alone' 2 'need --frames' in.exr -o out.png --fps 30
bad 'a number without frames' 2 'expected --frames N' in.exr -o 'out.%d.png'
bad 'not a sphere' 1 'twice as wide as high' in.exr -o out.png --pan 10
expect_fail 'a full disk' 3 'No space left' - "$RELUME" glare in.exr -o /dev/full $quick
expect_fail 'nowhere to write' 3 'no/out.png' no/out.png "$RELUME" glare in.exr -o no/out.png $quick
printf '{"format": "relume-subject", "version": 1,\n "lens": {"count": 3,\n "radius_mm": 9}}' >s.json
bad 'absurd subject' 1 's.json: line 3; lens.radius_mm; expected 0.001 to 1; found 9' --psf out.png --subject s.json
printf '{"format": "relume-subject", "version": 1, "lense": {}}' >s.json
bad 'unknown group' 1 'line 1; lense; unknown; did you mean "lens"' --psf out.png --subject s.json
printf '{"format": "relume-subject", "version": 1, "lids": {"squint": 0.6, "blink_interval_s": 0}}' >s.json
expect_ok 'a squinting subject' - "$RELUME" glare --psf squint.exr $quick --subject s.json
differ 'squinting' psf.exr squint.exr
printf '{"format": "relume-subject", "version": 1, "lids": {"squint": 0.6, "blink_interval_s": 0, "lash_image": "l.exr"}}' >s.json
bad 'no picture of lashes' 1 'l.exr: no such file' --psf out.png --subject s.json
"$mkimage" poke in.exr l0.exr 12 0 0 && "$mkimage" poke l0.exr l.exr 12 1 0
expect_ok 'lashes of a picture' - "$RELUME" glare --psf lashes.exr $quick --subject s.json
differ 'lashes' squint.exr lashes.exr

# ---- pixels that are no light
"$mkimage" poke in.exr nan.exr 3 3 nan
expect_ok 'NaN' 'warning: .*pixels are not numbers' "$RELUME" glare nan.exr -o nan.png $quick
finish
