#!/bin/sh
# growth.sh BUILD > docs/data/growth.csv - how time, memory and bytes grow with pixels, lights, views and
# coefficients: a row for each size and command, with seconds of the processor (one thread), peak memory in
# MB and the file's MB. scripts/plot_growth.sh draws it.
set -eu
relume=$1/relume work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo growth,size,command,seconds,memory,file

row() { # growth, size, name of the command, file, command...
    growth=$1 size=$2 name=$3 file=$4
    shift 4
    /usr/bin/time -f '%U %S %M' -o "$work/used" "$relume" "$@" --threads 1 -q >"$work/log" 2>&1 || {
        cat "$work/log" >&2
        return 1
    }
    awk -v OFS=, -v g="$growth" -v s="$size" -v c="$name" -v b="$(wc -c <"$file")" \
        '{ print g, s, c, $1 + $2, $3 / 1000, b / 1e6 }' "$work/used"
}
three() { # growth, size, capture, coefficients, "coded" where that takes no minutes
    row "$1" "$2" encode "$work/f.exr" encode "$3" -o "$work/f.exr" --force --basis pca --coefficients "$4"
    row "$1" "$2" relight "$work/f.exr" relight "$work/f.exr" -o "$work/f.png" --light 'dir 0.3 0.2 0.9'
    [ -z "${5-}" ] ||
        row "$1" "$2" 'encode --psnr 36' "$work/g.exr" encode "$3" -o "$work/g.exr" --force --psnr 36
}

for n in 128 256 512 1024 2048; do
    "$relume" synth bust -q --force -o "$work/c" --size $n --lights 24 --hemisphere --samples 1
    coded=
    [ $n -gt 512 ] || coded=coded
    three pixels $((n * n)) "$work/c" 9 $coded
done
for n in 12 24 48 96 192; do
    "$relume" synth bust -q --force -o "$work/c" --size 256 --lights $n --hemisphere --samples 1
    three lights $n "$work/c" 9 coded
done
for n in 1 2 4 8; do
    "$relume" synth teapot -q --force -o "$work/c" --size 128 --views ${n}x$n --lights 24 --hemisphere --samples 1
    three views $((n * n)) "$work/c" 9 coded
done
"$relume" synth bust -q --force -o "$work/c" --size 256 --lights 96 --hemisphere --samples 1
for n in 4 9 16 25 49 96; do three coefficients $n "$work/c" $n; done
