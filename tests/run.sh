#!/bin/sh
# `make test`: headers alone, layer rules, then every test of the release build.
set -u
make=$1
results=$(mktemp) || exit 1
trap 'rm -f "$results"' EXIT

"$make" --no-print-directory -j2 all && "$make" -s -j2 headers && "$make" -s layers || { echo "0 passed, 1 failed"; exit 1; }
"$make" -s -j2 check 2>&1 | tee "$results"
grep -qE '^[0-9]+ passed, 0 failed' "$results"
