#!/bin/bash -eu
# What OSS-Fuzz runs: every target of tests/fuzz with the engine and the sanitizer of the environment
# ($CC, $CXX, $CFLAGS, $LIB_FUZZING_ENGINE, $OUT), its seeds and its words. Alone, it builds with clang's
# libFuzzer into $OUT: OUT=/somewhere oss-fuzz/build.sh
[ -d tests/fuzz ] || cd "$(dirname "$0")/.."
: "${OUT:=$PWD/build/oss-fuzz}" "${CC:=clang}" "${CXX:=clang++}" "${LIB_FUZZING_ENGINE:=-fsanitize=fuzzer}"
mkdir -p "$OUT"
flags=
[ -z "${CFLAGS:-}" ] || flags="$CFLAGS -DRELUME_LIBFUZZER"
CFLAGS='' CXXFLAGS='' make -j"$(nproc)" config=fuzzer CC="$CC" CXX="$CXX" ${flags:+fuzzer="$flags"} \
    FUZZ_ENGINE="$LIB_FUZZING_ENGINE" fuzzers
for target in tests/fuzz/fuzz_*.c; do
    name=$(basename "$target" .c)
    seeds=$(mktemp -d)
    RELUME_FUZZ_SEEDS=$seeds "build/fuzzer/tests/fuzz/$name" -runs=0 >/dev/null 2>&1
    mv "$seeds/words.dict" "$OUT/$name.dict"
    (cd "$seeds" && zip -q "$OUT/${name}_seed_corpus.zip" ./*)
    rm -r "$seeds"
    cp "build/fuzzer/tests/fuzz/$name" "$OUT"
done
# Libraries of the system that the targets need where they run, and the modules of relume
mkdir -p "$OUT/lib"
cp build/fuzzer/librelume-*.so.* "$OUT/lib"
for name in "$OUT"/fuzz_*; do
    [ -x "$name" ] && [ ! -d "$name" ] || continue
    ldd "$name" | awk '$3 ~ /^\// { print $3 }' | grep -vE '/lib(c|m|dl|pthread|rt)\.so' | xargs -r cp -n -t "$OUT/lib"
    command -v patchelf >/dev/null && patchelf --set-rpath '$ORIGIN/lib' "$name"
done
