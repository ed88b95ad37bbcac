#!/bin/sh
# The loops written for NEON (src/core/kernel/kernels_neon.c) under the tests of every instruction set,
# cross-compiled and run by an emulator. Debian: gcc-aarch64-linux-gnu libc6-dev-arm64-cross
# qemu-user-static. Nothing else needs these packages.
. "$(dirname "$0")/lib.sh"
compiler=$(command -v aarch64-linux-gnu-gcc || true)
emulator=$(command -v qemu-aarch64-static || command -v qemu-aarch64 || true)
if [ "$config" != release ]; then
    skip "NEON" "in the release tree only"
elif [ -z "$compiler" ] || [ -z "$emulator" ]; then
    skip "NEON" "no aarch64-linux-gnu-gcc or no qemu-aarch64-static"
else
    # The table names Eigen's loops, which no test here calls.
    echo 'const char lsq_kernels_plain[1];' >eigen.c
    for t in kernels nearest unpack; do
        check "test_$t compiles for 64-bit ARM" "$compiler" -std=c11 -D_GNU_SOURCE -O2 -static \
            -ffp-contract=off -fno-math-errno -ffunction-sections -Wl,--gc-sections \
            -I"$TOP/tests/tools/small" -I"$TOP/tests" -I"$TOP/src" -I"$TOP/include" \
            -o "test_$t" "$TOP/tests/kernels/test_$t.c" eigen.c "$TOP"/src/core/kernel/*.c \
            "$TOP"/src/core/base/cpu.c "$TOP"/src/core/base/log.c "$TOP"/src/core/base/called.c "$TOP"/src/core/base/printable.c -lm
        check "test_$t passes under the emulator" timeout -k 1 120 "$emulator" "./test_$t"
    done
    check "the set is NEON's" sh -c '"$0" ./test_kernels | grep -qx "set: neon"' "$emulator"
fi
finish
