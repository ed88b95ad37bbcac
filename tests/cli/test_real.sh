#!/bin/sh
# Real photographs, when they are there: encoding, and the quality that the contract's figures mean.
. "$(dirname "$0")/lib.sh"
item="$TOP/../shared/data/realrti/item1"
if [ ! -f "$item/dirs.lp" ]; then
    skip 'real photographs' 'no ../shared/data/realrti'
    exit 0
fi
expect_ok 'encode photographs' '' "$RELUME" encode "$item/dirs.lp" -o i1.exr --basis sh --coefficients 9
"$RELUME" eval i1.exr "$item/dirs.lp" --json >e.json 2>err.txt
# other programs reach 22 dB on this data with nine coefficients; far below means swapped axes
above 'photographs come back' "$(field psnr_db e.json)" 20
finish
