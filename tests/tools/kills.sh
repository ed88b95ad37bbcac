#!/bin/sh
# Kill -9 at random times: after each kill the output is the old one or the new one, whole; after the
# next run to its end nothing else is there. kills.sh [SEED], KILLS times for each command (default
# 200). Prints one line a command and ends with 1 when anything was lost, mixed or left.
#
# $RELUME, $BUILD as for tests/cli. Works in a folder of its own; temporary files are looked for too.
set -u
seed=${1:-1} kills=${KILLS:-200}
work=$(mktemp -d) || exit 1
trap 'cd /; rm -rf "$work"' EXIT
cd "$work" || exit 1
mkdir tmp out
export TMPDIR="$work/tmp"
bad=0

# What an output is: all bytes of all its files, but for how long things took.
sum() { # file or stem or folder
    find "$@" -type f 2>/dev/null | LC_ALL=C sort | while read -r f; do
        echo "$f"
        case $f in
            *.csv) cut -d , -f 1-12,14- "$f" ;;
            *.json) sed 's/"seconds": [0-9.e+-]*//g' "$f" ;;
            *) cat "$f" ;;
        esac
    done | md5sum
}
now_ms() { date +%s%3N; }
litter() { find out tmp -name '.relume-*' -prune; find out -mindepth 1 -maxdepth 1 -name 'kept-*'; find tmp -mindepth 1 -maxdepth 1; }
complain() {
    echo "kills: $*" >&2
    bad=1
}

# hunt NAME OUTPUTS OLD-COMMAND NEW-COMMAND: both write OUTPUTS in out/; the new one is killed.
hunt() {
    name=$1 outputs=$2 old=$3 new=$4
    rm -rf out tmp/* && mkdir out
    sh -c "$new" 2>err.txt || complain "$name: $(cat err.txt)"
    want=$(cd out && sum $outputs)
    rm -rf out && mkdir out
    sh -c "$old" 2>err.txt || complain "$name: $(cat err.txt)"
    before=$(cd out && sum $outputs)
    [ "$want" != "$before" ] || complain "$name: old and new are equal"
    rm -rf kept && cp -rp out kept
    start=$(now_ms)
    sh -c "$new" 2>/dev/null
    took=$(($(now_ms) - start))
    [ "$(cd out && sum $outputs)" = "$want" ] || complain "$name: two runs differ"
    olds=0 news=0 most=0 n=0
    for delay in $(awk -v n="$kills" -v t="$took" -v s="$seed" \
        'BEGIN { srand(s); for (i = 0; i < n; i++) printf "%.4f\n", 1.1e-3 * t * rand() }'); do
        n=$((n + 1))
        for f in $outputs; do rm -rf "out/$f" && cp -rp "kept/$f" "out/$f"; done
        [ $((n % 2)) -eq 0 ] && rm -f out/*.resume  # every other sweep goes on from kept rows
        sh -c "exec $new" 2>/dev/null & pid=$!
        sleep "$delay"
        kill -9 $pid 2>/dev/null
        wait $pid 2>/dev/null
        case $(cd out && sum $outputs) in
            "$before") olds=$((olds + 1)) ;;
            "$want") news=$((news + 1)) ;;
            *) is_between "$name" || complain "$name: killed after $delay s: neither the old nor the new one" ;;
        esac
        found=$(litter | wc -l)
        [ "$found" -gt "$most" ] && most=$found
    done
    sh -c "$new" 2>err.txt || complain "$name: the next run: $(cat err.txt)"
    [ "$(cd out && sum $outputs)" = "$want" ] || complain "$name: the next run gives something else"
    [ -z "$(litter)" ] || complain "$name: left after the next run: $(litter)"
    echo "$name: $n kills within $took ms, $olds old, $news new, $((n - olds - news)) between files, at most $most left, 0 after the next run"
}

# The files of a sweep are written one after the other: each is old or new.
is_between() {
    [ "$1" = sweep ] || return 1
    for f in $outputs; do
        one=$(cd out && sum "$f")
        [ "$one" = "$(cd new && sum "$f")" ] || [ "$one" = "$(cd kept && sum "$f")" ] || return 1
    done
}

"$BUILD/samples/sphere" cap --size 64 --lights 25 --half --hemisphere || exit 1
"$BUILD/samples/sphere" shots --size 64 --lights 12 --format jpg || exit 1
"$RELUME" encode cap -o cap.exr -q --basis pca --coefficients 9 2>/dev/null || exit 1
r="\"$RELUME\""
hunt encode o.exr "$r encode cap -o out/o.exr -q --basis sh --coefficients 4" "$r encode cap -o out/o.exr -q --basis pca --coefficients 9"
hunt export o "$r export cap.exr -o out/o -q --quality 60" "$r export cap.exr -o out/o -q --quality 90 --force"
hunt capture o "$r capture shots/view00/*.jpg --lights shots/dirs.lp -o out/o -q" \
    "$r capture shots/view00/*.jpg --lights shots/dirs.lp -o out/o -q --transfer linear --force"
hunt synth o "$r synth box -o out/o -q --size 64 --lights 3 --samples 1" "$r synth box -o out/o -q --size 64 --lights 6 --samples 4 --force"
sweep="$r sweep cap -q --leave-out 5 -o"
mkdir new && sh -c "$sweep new/o --basis sh,hsh --coefficients 4,9" >/dev/null 2>&1
hunt sweep 'o.csv o.json o.svg o.png' "$sweep out/o --basis sh --coefficients 4 >/dev/null" "$sweep out/o --basis sh,hsh --coefficients 4,9 >/dev/null"
exit $bad
