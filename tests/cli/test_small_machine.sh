#!/bin/sh
# Poor machines: little memory and few file descriptors. Every command ends, with what it was to do
# or status 3 and one line, and leaves nothing behind.
. "$(dirname "$0")/lib.sh"
case $BUILD in *asan* | *tsan*) skip 'small machines' 'sanitizers want addresses of their own'; finish; exit ;; esac
"$sphere" cap --size 24 --lights 10 --half || exit 1
"$sphere" shots --size 24 --lights 10 --format jpg || exit 1
"$RELUME" encode cap -o file.exr --basis sh --coefficients 4 2>/dev/null || not_ok encode failed
"$RELUME" relight file.exr -o shown.png 2>/dev/null || not_ok relight failed
"$RELUME" relight file.exr -o shown.tif 2>/dev/null || not_ok relight failed

# poor LIMIT COMMAND...: status 0, or status 3 with one line; 127 is the loader's, which has no memory
# for the libraries and says so itself.
poor() {
    limit=$1
    shift
    name="ulimit $limit: $1"
    rm -rf out out.exr out.png
    timeout -k 1 20 sh -c "ulimit $limit; exec \"\$@\"" sh "$RELUME" "$@" >out.txt 2>err.txt
    status=$?
    errors_of err.txt >only.txt
    if [ "$status" -eq 127 ] && grep -q 'shared librar' err.txt; then
        ok "$name (not loaded)"
    elif [ "$(leftovers)" ]; then
        not_ok "$name" "left behind: $(leftovers)"
        rm -rf $(leftovers)
    elif [ "$status" -eq 0 ]; then
        ok "$name (done)"
    elif [ "$status" -ne 3 ] || [ "$(wc -l <only.txt)" -ne 1 ] || ! grep -q '^relume: ' only.txt; then
        not_ok "$name" "status $status; $(head -c 600 err.txt)"
    elif [ -e out ] || [ -e out.exr ] || [ -e out.png ]; then
        not_ok "$name" 'an output exists'
    else
        ok "$name"
    fi
}

for limit in '-n 4' '-n 5' '-n 6' '-n 7' '-n 9' '-v 70000' '-v 82000' '-v 100000' '-v 200000'; do
    poor "$limit" --version
    poor "$limit" info file.exr
    poor "$limit" check file.exr
    poor "$limit" encode shots/dirs.lp -o out.exr
    poor "$limit" encode cap --shadows no -o out.exr
    poor "$limit" relight file.exr -o out.png
    poor "$limit" compare shown.png shown.png
    poor "$limit" compare shown.tif shown.tif
    poor "$limit" glare shown.png -o out.exr
    poor "$limit" export file.exr --to relight -o out
    poor "$limit" synth box --size 8 --lights 1 --samples 1 -o out
    poor "$limit" capture shots/view00/light*.jpg --lights shots/dirs.lp -o out
done

# More lights than descriptors: the same file.
for format in jpg exr; do
    "$sphere" many --size 16 --lights 49 --format $format || exit 1
    "$RELUME" encode many -o many.exr --basis sh --coefficients 4 -q || not_ok 'encode failed'
    expect_ok "49 lights, 16 descriptors, $format" - sh -c "ulimit -n 16; exec \"$RELUME\" encode many \
        -o few.exr --basis sh --coefficients 4 -q"
    check "the same bytes, $format" cmp many.exr few.exr
    rm -rf many few.exr
done

# what had status 1
for input in shots/dirs.lp cap; do
    expect_fail "no file can be opened for $input" 3 'too many files are open' out.exr \
        sh -c "ulimit -n 4; exec \"$RELUME\" encode $input -o out.exr"
done
finish
