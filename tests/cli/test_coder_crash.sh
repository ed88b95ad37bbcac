#!/bin/sh
# libaom in a process of its own: the bytes are those of a tool without relume-helper, and where the
# process dies, the file is lossless and one warning says so.
. "$(dirname "$0")/lib.sh"

"$RELUME" synth bust -o wide --size 160 --lights 16 --samples 1 -q
mkdir alone && cp "$RELUME" alone/

same() { # name OPTION...
    name=$1
    shift
    "$RELUME" encode wide -o helped.exr "$@" -q && alone/relume encode wide -o alone.exr "$@" -q
    check "$name" cmp helped.exr alone.exr
}
same 'planes have the same bytes with and without relume-helper' --psnr 36
same 'models of highlights too' --basis pca --highlights yes

# The processes that relume-helper has forked for the command $1.
coders_of() {
    for helper in $(cat "/proc/$1"/task/*/children 2>/dev/null); do
        cat "/proc/$helper"/task/*/children 2>/dev/null
    done
}

# Every process that codes gets the signal until the command ends.
crash() { # SIGNAL OUTPUT OPTION...
    signal=$1 output=$2
    shift 2
    "$RELUME" encode wide -o "$output" "$@" >said.txt 2>&1 &
    command=$!
    while kill -0 $command 2>/dev/null && [ -r "/proc/$command/stat" ] && ! grep -q ') Z ' "/proc/$command/stat"; do
        for coder in $(coders_of $command); do kill -s "$signal" "$coder" 2>/dev/null; done
    done
    wait $command
}

lossless() { "$RELUME" info "$1" | grep '^storage ' | grep -vq av1; }
count() { [ "$(grep -c "$1" said.txt)" -eq "$2" ]; }

check 'a crash of libaom does not end the command' crash SEGV crashed.exr --psnr 36
check 'it is one warning' count 'warning: .*libaom, the lossy coder, crashed (Segmentation fault); the file is lossless, and larger; encode again' 1
check 'and no error' count 'relume: wide: libaom' 0
check 'the file is lossless' lossless crashed.exr
check 'and sound' "$RELUME" check crashed.exr
check 'a coder that is killed does not either' crash KILL killed.exr --bytes-per-pixel 2
check 'the warning says so' count 'libaom, the lossy coder, was killed; the machine may be short of memory; the file is lossless' 1
check 'that file is lossless too' lossless killed.exr
check 'a search by --jnd goes on' crash SEGV jnd.exr --jnd 2
check 'with a lossless file' lossless jnd.exr
check 'a lossless file is written without models' crash SEGV models.exr --basis pca --highlights yes
check 'the warning says what is missing' count 'shadows and highlights fade in the file' 1
check 'as it would be without them' "$RELUME" check models.exr

crash SEGV part.exr --psnr 36 --part 1/2
if [ $? -eq 3 ] && count '^relume: .*libaom, the lossy coder, crashed' 1 && [ ! -e part.exr ]; then
    ok 'a part fails, since parts agree about their coding'
else
    not_ok 'a part fails, since parts agree about their coding' "$(cat said.txt)"
fi
check 'nothing is left behind' test -z "$(leftovers)"
finish
