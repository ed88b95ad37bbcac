#!/bin/sh
# Failing calls to the system: each command is run with the first, second, ... call of each kind
# failing, once, and for good. After each: status 3 with one line and the old output, or 0 and the new
# one, and nothing else is there. faults.sh [STEP [COMMANDS]]: only about every STEP-th call (default
# 1: all), from 1000 on one way of failing instead of four.
# Prints one line a command and ends with 1 when anything was lost, mixed, left, or said badly.
#
# $RELUME and $BUILD as for tests/cli; needs $BUILD/tests/tools/faults.so.
set -u
step=${1:-1} commands=${2:-encode relight export synth capture sweep}
ways="5: 5:+ 28: 28:+"
[ "$step" -ge 1000 ] && ways=28:+
work=$(mktemp -d) || exit 1
trap 'cd /; rm -rf "$work"' EXIT
cd "$work" || exit 1
mkdir tmp out
export TMPDIR="$work/tmp" RELUME_FAULT_UNDER="$work"
bad=0 EIO=5 ENOSYS=38 EINVAL=22 EOPNOTSUPP=95

complain() {
    echo "faults: $*" >&2
    bad=1
}
sum() {
    find "$@" -type f 2>/dev/null | LC_ALL=C sort | while read -r f; do
        echo "$f"
        case $f in
            *.csv) cut -d , -f 1-12,14- "$f" ;;
            *.json) sed 's/"seconds": [0-9.e+-]*//g' "$f" ;;
            *) cat "$f" ;;
        esac
    done | md5sum
}
# A folder that is kept is no litter where a line says so.
kept() {
    for k in out/kept-by-relume-* tmp/kept-by-relume-*; do
        [ ! -e "$k" ] || grep -q "/${k#*/}: this old folder could not be removed" err.txt || echo "$k"
    done
}
litter() { find out tmp -name '.relume-*' -prune; kept; find tmp -mindepth 1 -maxdepth 1 ! -name 'kept-*'; }
restore() { for f in $outputs; do rm -rf "out/$f" && cp -rp "kept/$f" "out/$f"; done; rm -f out/*.resume; }
whole() { # each output is the old or the new one; a folder or file alone is exactly one of them
    for f in $outputs; do
        one=$(cd out && sum "$f")
        [ "$one" = "$(cd new && sum "$f")" ] || [ "$one" = "$(cd kept && sum "$f")" ] || return 1
    done
}

# try FAULT ALLOWED-STATUS...: 1 when there was no such call
try() {
    fault=$1
    shift
    restore
    rm -f hit
    LD_PRELOAD="$BUILD/tests/tools/faults.so" RELUME_FAULT=$fault RELUME_FAULT_HIT="$work/hit" \
        timeout 60 sh -c "exec $new" >out.txt 2>err.txt
    status=$?
    [ -e hit ] || return 1
    tried=$((tried + 1))
    lines=$(grep -v '^relume: warning: ' err.txt | grep -c '^relume: ')
    case " $* " in *" $status "*) ;; *) complain "$name, $fault: status $status; $(cat err.txt)" ;; esac
    if [ "$status" -eq 0 ]; then
        passed=$((passed + 1))
        [ "$(cd out && sum $outputs)" = "$want" ] || complain "$name, $fault: done, and not the new output"
    else
        [ "$lines" -eq 1 ] || complain "$name, $fault: $lines lines; $(cat err.txt)"
        whole || complain "$name, $fault: neither old nor new"
    fi
    [ -z "$(litter)" ] || complain "$name, $fault: left: $(litter)"
    rm -rf out/.relume-* out/kept-* tmp/* tmp/.relume-*
    return 0
}

# hunt NAME OUTPUTS OLD-COMMAND NEW-COMMAND
hunt() {
    name=$1 outputs=$2 old=$3 new=$4 tried=0 passed=0
    case " $commands " in *" $name "*) ;; *) return ;; esac
    rm -rf out new kept && mkdir out && sh -c "$new" >/dev/null 2>&1
    want=$(cd out && sum $outputs) && mv out new
    mkdir out && sh -c "$old" >/dev/null 2>&1
    cp -rp out kept
    for call in open write sync rename exchange link unnamed map allocate mkdir flush; do
        for way in $ways; do  # the number of the error, and whether it stays
            n=1
            while try "$call:$n${way#*:}:${way%:*}" 0 3; do n=$((n + step + (step > 1 ? n / 2 : 0))); done
        done
    done
    n=1
    # what a file is, the first readings say
    while try "read:$n:$EIO" 0 1 3; do n=$((n < 4 ? n + 1 : n + step + (step > 1 ? n / 2 : 0))); done
    # file systems without these
    try "exchange:1+:$ENOSYS" 0
    try "exchange:1+:$EINVAL" 0
    try "unnamed:1+:$EOPNOTSUPP" 0
    echo "$name: $tried faults, $passed harmless, $((tried - passed)) reported"
}

"$BUILD/samples/sphere" cap --size 24 --lights 9 --half --hemisphere || exit 1
"$BUILD/samples/sphere" shots --size 32 --lights 9 --format jpg || exit 1
"$RELUME" encode cap -o cap.exr -q --basis sh --coefficients 4 2>/dev/null || exit 1
r="\"$RELUME\""
hunt encode o.exr "$r encode cap -o out/o.exr -q --basis hsh --coefficients 4" "$r encode cap -o out/o.exr -q --basis sh --coefficients 4"
hunt relight o.png "$r relight cap.exr -o out/o.png -q --light 'dir 1 0 1'" "$r relight cap.exr -o out/o.png -q"
hunt export o "$r export cap.exr -o out/o -q --quality 60" "$r export cap.exr -o out/o -q --quality 90 --force"
hunt synth o "$r synth box -o out/o -q --size 8 --lights 1 --samples 1" "$r synth box -o out/o -q --size 8 --lights 2 --samples 1 --force"
hunt capture o "$r capture shots/view00/*.jpg --lights shots/dirs.lp -o out/o -q" \
    "$r capture shots/view00/*.jpg --lights shots/dirs.lp -o out/o -q --transfer linear --force"
sweep="$r sweep cap -q --leave-out 5 -o"
hunt sweep 'o.csv o.json o.svg o.png' "$sweep out/o --basis sh --coefficients 1 >/dev/null" "$sweep out/o --basis sh --coefficients 1,4 >/dev/null"
exit $bad
