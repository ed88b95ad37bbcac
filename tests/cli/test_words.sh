#!/bin/sh
# What relume says to people: nothing that a terminal would obey, and what to do next.
. "$(dirname "$0")/lib.sh"
shoot="$BUILD/tests/tools/shoot"

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
"$shoot" photo "$red.png" 80 60 1 0 0 0 0.5
"$shoot" photo b.png 80 60 4 0 0 0 0.5
printf '1\n4\n' >times.txt
tame 'a table of photographs' "$RELUME" capture --hdr "$red.png" b.png --times times.txt -o made.exr
"$RELUME" capture --hdr "$red.png" b.png --times times.txt -o made.exr --json >out.txt
check 'JSON escapes it' grep -qF '"a\u001b[31m\u009bb\u202ec.png"' out.txt
check 'made of a hostile name' test -s made.exr

# ---- an empty name is wrong usage
for command in 'synth box' 'capture b.png' 'encode list.lp' 'relight made.exr' 'sweep list.lp' 'import b.png' \
    'export made.exr --to ptm' 'glare made.exr' 'btf fit paper' 'btf render paper' 'synth --btf paper' \
    'capture --hdr b.png' 'btf tile paper' 'btf crop paper'; do
    expect_fail "$command -o ''" 2 'found an empty' - "$RELUME" $command -o ''
done
expect_fail 'an empty input' 2 'info: expected .*found an empty name' - "$RELUME" info ''
check 'the viewer: an empty output is wrong usage' sh -c "$VIEWER made.exr --offscreen ''; test \$? -eq 2"

finish
