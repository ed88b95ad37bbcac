#!/bin/sh
# --domain log: components of logarithms, for high dynamic range (docs/log-pca.md).
. "$(dirname "$0")/lib.sh"
"$RELUME" synth teapot -o stage --projection planar --size 24 --lights 40 --samples 1 --bounces 1 -q
"$RELUME" encode stage -o log.exr --basis pca --domain log --coefficients 40 --bits half -q
"$RELUME" encode stage -o own.exr --basis pca --domain log:0.02 --coefficients 40 -q
"$RELUME" info log.exr >info.txt
check 'info says it' grep -q '^domain  *log (log:0.01)$' info.txt
check 'and its delta' grep -q '(log:0.02)' <<X
$("$RELUME" info own.exr)
X
check 'as JSON' grep -q '"domain": "log", "display": "log:0.01"' <<X
$("$RELUME" info log.exr --json)
X
# half of 80 components of 120 numbers: most of it comes back, above white too
psnr=$("$RELUME" eval log.exr stage --json | sed 's/.*"psnr_db": \([0-9.]*\), "psnr_pooled.*/\1/')
check 'captured lights come back' awk -v p="$psnr" 'BEGIN { exit !(p > 34) }'

value() { "$RELUME" query "$@" --eye 0.1,0.3,4 --direction 0,0,-1 -q; }
near() { awk -v a="$1" -v b="$2" 'BEGIN { n = split(a, x, " "); split(b, y, " "); bad = n != 3
    for (i = 1; i <= n; i++) { d = x[i] - y[i]; if (!(d < 1e-5 && d > -1e-5)) bad = 1 } exit bad }'; }
sum() { echo "$1 $2" | awk '{ print $1 + $4, $2 + $5, $3 + $6 }'; }
a=$(value log.exr --light "dir 0.3 0.2 1") b=$(value log.exr --light "dir -0.5 0.4 1")
both=$(value log.exr --light "dir 0.3 0.2 1" --light "dir -0.5 0.4 1")
check 'lights are added as light, after the exponential' near "$both" "$(sum "$a" "$b")"

expect_fail 'no such domain' 2 "unknown --domain 'lag'.*log" x.exr "$RELUME" encode stage -o x.exr --domain lag
expect_fail 'a delta of 0' 2 "log:DELTA with DELTA from 1e-6 to 1; found 'log:0'" x.exr \
    "$RELUME" encode stage -o x.exr --domain log:0
expect_fail 'with loss' 2 'without --domain log' x.exr "$RELUME" encode stage -o x.exr --domain log --psnr 40
finish
