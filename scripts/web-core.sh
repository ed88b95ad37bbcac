#!/bin/sh
# web-core.sh OUT.wasm SOURCE...: what pages compute by the library itself (web/core/core.c), compiled to WebAssembly, and the
# list of what it was made of (web-sources.sh). Needs emscripten.
set -eu
out=$1
shift
flags='-std=gnu11 -Os -DNDEBUG -ffp-contract=off -Wall -Wextra -Iinclude -Isrc'
emcc $flags "$@" --no-entry -s STANDALONE_WASM=1 -s MALLOC=emmalloc -s ALLOW_MEMORY_GROWTH=1 -s INITIAL_MEMORY=4194304 \
    -s TOTAL_STACK=1048576 -o "$out"
emcc -MM $flags "$@" | scripts/web-sources.sh "$out" "$0"
