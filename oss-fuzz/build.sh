#!/bin/bash -eu
# What OSS-Fuzz runs: every target of tests/fuzz with the engine and the sanitizer of the environment
# ($CC, $CXX, $CFLAGS, $LIB_FUZZING_ENGINE, $OUT), its seeds and its words. Alone, it builds with clang's
# libFuzzer into $OUT: OUT=/somewhere oss-fuzz/build.sh
[ -d tests/fuzz ] || cd "$(dirname "$0")/.."
: "${OUT:=$PWD/build/oss-fuzz}" "${CC:=clang}" "${CXX:=clang++}" "${LIB_FUZZING_ENGINE:=-fsanitize=fuzzer}"
mkdir -p "$OUT"
flags=
[ -z "${CFLAGS:-}" ] || flags="$CFLAGS -DRELUME_LIBFUZZER"
# An old run path, which libraries of libraries are looked for in too
CFLAGS='' CXXFLAGS='' LDFLAGS="'-Wl,-rpath,\$\$ORIGIN/lib'" make -j"$(nproc)" config=fuzzer CC="$CC" CXX="$CXX" ${flags:+fuzzer="$flags"} \
    FUZZ_ENGINE="$LIB_FUZZING_ENGINE" fuzzers
for target in tests/fuzz/fuzz_*.c; do
    name=$(basename "$target" .c)
    seeds=$(mktemp -d)
    RELUME_FUZZ_SEEDS=$seeds "build/fuzzer/tests/fuzz/$name" -runs=0 >/dev/null 2>&1
    # libFuzzer ends when a dictionary holds no word
    [ ! -s "$seeds/words.dict" ] || cp "$seeds/words.dict" "$OUT/$name.dict"
    rm "$seeds/words.dict"
    find "tests/fuzz/corpus/$name" -type f -exec cp -t "$seeds" {} + 2>/dev/null || true
    (cd "$seeds" && zip -q "$OUT/${name}_seed_corpus.zip" ./*)
    rm -r "$seeds"
    cp "build/fuzzer/tests/fuzz/$name" "$OUT"
done
# Libraries of the system that the targets need where they run, and the module that writes pictures
mkdir -p "$OUT/lib"
cp build/fuzzer/librelume-oiio.so.* "$OUT/lib"
for name in "$OUT"/fuzz_* "$OUT"/lib/librelume-*; do
    [ -x "$name" ] && [ ! -d "$name" ] || continue
    ldd "$name" | awk '$3 ~ /^\// { print $3 }' | grep -vE '/lib(c|m|dl|pthread|rt)\.so' | xargs -r cp -n -t "$OUT/lib"
done
