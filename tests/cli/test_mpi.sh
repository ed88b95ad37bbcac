#!/bin/sh
# relume-mpi: the file of all processes of an MPI launcher is that of one process byte for byte; one voice.
. "$(dirname "$0")/lib.sh"

mpi=${RELUME%/*}/relume-mpi
if ! command -v mpirun >/dev/null || [ ! -x "$mpi" ]; then
    echo "skipped: no MPI (make deps-mpi)"
    exit 0
fi
# in a container one is root; processes share cores and wait without turning
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl=self,vader,tcp OMPI_MCA_mpi_yield_when_idle=1
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0"  # OpenMPI keeps what it has until the end
processes() { # number, command line
    n=$1
    shift
    timeout -k 1 120 mpirun --oversubscribe -n "$n" "$mpi" "$@"
}

"$RELUME" synth teapot -o slab --size 40 --views 3x3 --lights 8 --samples 1 -q
"$RELUME" synth bust -o flat --size 70 --lights 12 --samples 1 -q

as_one() { # name processes capture options...
    name=$1 n=$2 capture=$3
    shift 3
    rm -f whole.exr together.exr
    relume encode "$capture" --shadows no "$@" -o whole.exr
    processes "$n" encode "$capture" "$@" -o together.exr -q
    same "$name" whole.exr together.exr
}
as_one 'by itself' 3 slab
as_one 'one codebook for all views' 3 slab --basis sh --coefficients 4 --codebook 64 --share
as_one 'of two stages, by splitting' 2 slab --basis pca --coefficients 6 --codebook 32 --share --stages 2 --codebook-start split
as_one 'rows' 3 flat --basis pca
as_one 'one process' 1 slab --basis sh
"$sphere" cut --size 44 --lights 9 --views 2 --mask --format jpg
as_one 'rows of two views, blocks of one of them' 5 cut --basis sh --coefficients 4
"$RELUME" synth teapot -o few --size 24 --views 3x3 --lights 5 --samples 1 -q
as_one 'with loss, a process without views' 3 few --basis pca --coefficients 4 --psnr 26
"$sphere" wide --size 1544 --rows 16 --lights 4 --hemisphere --mask --format png
as_one 'tiles of one picture' 3 wide --basis sh --coefficients 4 --psnr 20
as_one 'bytes, a pyramid, a process without tiles' 5 wide --basis sh --coefficients 4 --bytes-per-pixel 0.5 --pyramid yes
# halves where 8 bits turn out too few
"$sphere" lamp --size 32 --lights 1 --views 3 --hemisphere
for view in lamp/view0?; do
    "$mkimage" poke "$view/light0000.exr" lit.exr 16 16 1000 && mv lit.exr "$view/light0000.exr"
done
as_one 'very bright highlights' 2 lamp --basis table
# parts that an earlier run has made are taken up; a byte of one that is changed shows it
unfinished() { # processes, capture, options...: the device of the output is full
    rm -f later.exr
    ln -s /dev/full later.exr
    processes "$@" -o later.exr -q >out.txt 2>err.txt
    rm -f later.exr
}
set -- 3 encode slab --basis sh --coefficients 4 --compression none --no-depth
unfinished "$@"
check 'parts stay where joining fails' [ "$(ls | grep -c '^later.*\.relume-mpi$')" = 3 ]
rm later.2of3.relume-mpi
processes "$@" -o later.exr -q
shift
relume "$@" -o whole.exr
same 'the run is taken up, one part made again' whole.exr later.exr
check 'and they go' [ "$(ls | grep -c '\.relume-mpi$')" = 0 ]
unfinished 3 "$@"
printf '\377' | dd of=later.1of3.relume-mpi bs=1 seek=$(($(wc -c <later.1of3.relume-mpi) - 9)) conv=notrunc 2>/dev/null
processes 3 "$@" -o later.exr -q
check 'parts that are there are used' sh -c '! cmp -s whole.exr later.exr'
unfinished 3 "$@"
as_other=$(echo "$*" | sed 's/ 4 / 1 /')
processes 3 $as_other -o later.exr -q
relume $as_other -o whole.exr
same 'but not those of other options' whole.exr later.exr
check 'no part is left' [ "$(ls | grep -c '\.relume-mpi$')" = 0 ]

# ---- one voice
processes 3 encode slab -o said.exr >out.txt 2>err.txt
check 'the result is said once' [ "$(grep -c 'reproduces your photographs' err.txt)" = 1 ]
silent() { # name status pattern, processes, command line: one line of ours, no output
    name=$1 want=$2 pattern=$3
    shift 3
    rm -f no.exr
    processes "$@" >out.txt 2>err.txt
    got=$?
    if [ $got = "$want" ] && [ "$(grep -c '^relume: ' err.txt)" = 1 ] && grep -q "^relume: $pattern" err.txt && [ ! -e no.exr ]; then
        ok "$name"
    else
        not_ok "$name" "status $got; $(head -5 err.txt)"
    fi
}
silent 'no capture' 1 'none: ' 3 encode none -o no.exr
silent 'a part of a part' 2 'relume-mpi makes the parts' 2 encode slab --part 1/2 -o no.exr
silent 'more than rows' 1 '1 views of 70 rows cannot be shared by 6 parts' 6 encode flat -o no.exr
head -c 900 slab/view07/light0003.exr >short && cp short slab/view07/light0003.exr
silent 'a damaged photograph of the last process' 1 '.*light0003.exr: ' 3 encode slab -o no.exr
check 'no part is left of it' [ "$(ls | grep -c '\.relume-mpi$')" = 0 ]

# ---- parts that somebody made by --part are theirs, whether the work succeeds or not
relume encode flat --part 1/3 --basis sh -o theirs.part
cp theirs.part no.1of3.part && cp theirs.part together.1of3.part
silent 'a damaged photograph beside parts' 1 '.*light0003.exr: ' 3 encode slab -o no.exr
as_one 'beside parts' 3 flat --basis sh
same 'a part of --part stays where work fails' theirs.part no.1of3.part
same 'and where it succeeds' theirs.part together.1of3.part
finish
