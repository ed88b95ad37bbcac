#!/bin/sh
# What relume says to people: nothing that a terminal would obey, and what to do next.
. "$(dirname "$0")/lib.sh"
made_photo="$BUILD/tests/tools/made_photo"

# ---- names that would act on the terminal
red=$(printf 'a\033[31m\302\233b\342\200\256c')
tame() { # name, command...: what it prints holds no escape, no C1 control, nothing that turns text
    name=$1
    shift
    "$@" >out.txt 2>err.txt
    if cat out.txt err.txt | LC_ALL=C grep -qE "$(printf '\033|\302\233|\342\200\256')"; then
        not_ok "$name" "$(cat -v out.txt err.txt | head -c 300)"
    else
        check "$name" test -s err.txt -o -s out.txt
    fi
}
for command in info relight encode eval import export query sweep compare; do
    tame "$command: a hostile name" "$RELUME" $command "$red" "$red" -o "$red/x"
done
tame 'a hostile command' "$RELUME" "$red"
tame 'a hostile option' "$RELUME" info "--$red"
tame 'a hostile value' "$RELUME" relight "$red" --size "$red"
tame 'the viewer' "$VIEWER" "$red" --offscreen x.png
printf '2\n%s 0 0 1\n%s 0 1 1\n' "$red" "$red" >list.lp
tame 'a name in a .lp file' "$RELUME" encode list.lp -o x.exr
printf '{"format": "%s"}' "$red" >capture.json
tame 'a text in capture.json' "$RELUME" encode capture.json -o x.exr
"$made_photo" photo "$red.png" 80 60 1 0 0 0 0.5
"$made_photo" photo b.png 80 60 4 0 0 0 0.5
printf '1\n4\n' >times.txt
tame 'a table of photographs' "$RELUME" hdr "$red.png" b.png --times times.txt -o made.exr
"$RELUME" hdr "$red.png" b.png --times times.txt -o made.exr --json >out.txt
check 'JSON escapes it' grep -qF '"a\u001b[31m\u009bb\u202ec.png"' out.txt
check 'made of a hostile name' test -s made.exr

# ---- an empty name is wrong usage
for command in 'synth box' 'capture b.png' 'encode list.lp' 'relight made.exr' 'sweep list.lp' 'import b.png' \
    'export made.exr --to ptm' 'glare made.exr' 'btf fit paper' 'btf render paper' 'synth --btf paper' \
    'hdr b.png' 'btf tile paper'; do
    expect_fail "$command -o ''" 2 'found an empty' - "$RELUME" $command -o ''
done
expect_fail 'an empty input' 2 'info: expected .*found an empty name' - "$RELUME" info ''
check 'the viewer: an empty output is wrong usage' sh -c "$VIEWER made.exr --offscreen ''; test \$? -eq 2"

# ---- names as long as the disk allows
for n in 239 251; do
    long=$(printf "%0${n}d" 0)
    expect_ok "a picture's name of $((n + 4)) bytes" - "$RELUME" hdr "$red.png" b.png --times times.txt -o "$long.exr"
    cp b.png "$long.png"
    expect_ok "a photograph's of $((n + 4))" - "$RELUME" hdr "$red.png" "$long.png" --times times.txt -o merged.exr
    expect_ok "a folder's of $((n + 4))" - "$RELUME" synth box --size 8 --lights 2 -o "${long}0000"
    expect_ok "a relume file's of $((n + 4))" - "$RELUME" encode "${long}0000" -o "$long.exr" --basis table
done

# ---- sentences that say what to do
expect_fail 'a relume file for a capture' 1 'this is a relume file, encoded already; expected the capture.json' x.exr "$RELUME" encode "$long.exr" -o x.exr --lossless
expect_fail 'a photograph for a capture' 1 "b.png: this is a photograph; give the .lp file, or use 'relume capture', for a panorama 'relume panorama'" x.exr "$RELUME" encode b.png -o x.exr
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\nabcd' >sky.hdr
expect_fail 'an HDR map for a capture' 1 "sky.hdr: this is a photograph; give the .lp file, .* for a panorama 'relume panorama'" x.exr "$RELUME" encode sky.hdr -o x.exr
printf 'light 1 2 3' >plain.txt
expect_fail 'a text for a capture' 1 'plain.txt: not JSON, no capture; expected a capture.json, a .lp file or a folder' x.exr "$RELUME" encode plain.txt -o x.exr
printf 'PTM_1.2\n' >coin.ptm
expect_fail 'a PTM for a capture' 1 "coin.ptm: this is a PTM file, no capture; use 'relume import'" x.exr "$RELUME" encode coin.ptm -o x.exr
"$BUILD/samples/sphere" few --size 32 --lights 4 --hemisphere --format png
expect_ok 'lamps to add, in words' 'add lamps: .*, [0-9]* degrees above the table \([0-9]* degrees counter-clockwise' \
    "$RELUME" capture few/view00/light*.png --lights few/dirs.lp -o uneven

# ---- tools of the tests: a mistyped option is no folder to write to
"$BUILD/samples/sphere" --help 2>err.txt
check 'an option is no folder' test $? = 1 -a ! -e ./--help
check '... and refused in words' grep -q -e '--help: unknown option; usage: sphere DIR' err.txt

# ---- captures that name files outside their folder, and images that are missing
"$BUILD/samples/sphere" c --size 16 --lights 6 --format png || exit 1
mkdir lps && sed 's|view00/|../c/view00/|' c/dirs.lp >lps/outside.lp
refused() { expect_fail "$1" 1 "$2" x.exr "$RELUME" encode "$3" -o x.exr --basis table; }
refused '.lp, ..' "names '../c/view00/light0000.png', outside its folder.*--allow-outside" lps/outside.lp
expect_ok '.lp, .. is trusted' - "$RELUME" encode lps/outside.lp -o x.exr --basis table --allow-outside && rm -f x.exr
sed "s|view00/|$PWD/c/view00/|" c/dirs.lp >lps/absolute.lp
refused '.lp, absolute' 'outside its folder' lps/absolute.lp
sed 's|view00/|C:\\\\RTI\\\\coin\\\\|' c/dirs.lp >c/view00/windows.lp
expect_ok '.lp of Windows: base names beside it' - "$RELUME" encode c/view00/windows.lp -o x.exr --basis table && rm -f x.exr
sed 's|view00/|../elsewhere/|' c/dirs.lp >c/view00/moved.lp
expect_ok '.lp, moved: base names beside it' - "$RELUME" encode c/view00/moved.lp -o x.exr --basis table && rm -f x.exr
mkdir j && sed 's|"view00/|"../c/view00/|g; s|"depth": [^,]*, ||' c/capture.json >j/capture.json
refused 'capture.json, ..' "names '../c/view00/light0000.png', outside its folder" j
expect_ok 'capture.json is trusted' - "$RELUME" encode j -o x.exr --basis table --allow-outside && rm -f x.exr
sed 's|"view00/|"a/../../c/view00/|g' c/capture.json >j/capture.json
refused 'capture.json, .. further in' 'outside its folder' j
sed 's|"view00/|"view00/../view00/|g' c/capture.json >c/in.json
expect_ok 'capture.json, .. that stays inside' - "$RELUME" encode c/in.json -o x.exr --basis table && rm -f x.exr
sed 's|"directions"|"positions"|; s|\[ *[-0-9.e]*, *[-0-9.e]*, *[-0-9.e]*\]|[0, 0, 0]|g' c/capture.json >c/zero.json
refused 'lamps all at 0' 'lights.positions\[0\]; expected a place of a lamp; found 0, 0, 0' c/zero.json
rm c/view00/light0002.png
refused 'a missing image, .lp' '1 of 6 images is missing; --skip-missing continues without it' c/dirs.lp
refused 'a missing image' '1 of 6 images is missing; --skip-missing continues without' c
mkdir rays && for i in 0 1 2 3; do cp b.png "rays/r$((i / 2))_c$((i % 2))_.png"; done
expect_ok 'a slab of photographs elsewhere' - "$RELUME" lightfield rays -o slab --names 'r{row}_c{column}_' -q
expect_ok 'needs no trust' - "$RELUME" encode slab -o x.exr --basis table -q && rm -f x.exr

# ---- errors in per cent of white, the figures of --json
"$RELUME" encode few -o x.exr --basis hsh --coefficients 1 --bits 8 -q
"$RELUME" info x.exr --json >info.json
percents() { # the two shares as print_error puts them
    sed 's/.*"fit_rms": \([^,]*\), "store_rms": \([^,]*\),.*/\1 \2/' info.json |
        awk '{ printf "error         %.*f %% of white from the model, %.*f %% from rounding", $1 < 0.01 ? 2 : 1, 100 * $1, $2 < 0.01 ? 2 : 1, 100 * $2 }'
}
"$RELUME" info x.exr >info.txt
check 'info: errors in per cent of white' grep -qF "$(percents)" info.txt
"$RELUME" encode few -o x.exr --basis hsh --coefficients 1 --bits float --no-depth -q
"$RELUME" info x.exr >info.txt
check 'info: no error from floats' grep -qE 'white from the model, (0|below 0.01) % from rounding' info.txt
check 'info: no extras' grep -q '^extras *none$' info.txt

finish
