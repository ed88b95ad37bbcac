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

# What `capture` makes linear is to be shown as well between the lights as the photographs themselves are.
glossy="$TOP/../shared/data/synthrti/Multi/Object1/material1"
if [ -f "$glossy/Dome/dirs.lp" ]; then
    "$RELUME" capture "$glossy"/Dome/*.jpg --lights "$glossy/Dome/dirs.lp" -o glossy -q 2>/dev/null
    unseen() { "$RELUME" encode "$1" -o g.exr --highlights no --force -q && "$RELUME" eval g.exr "$glossy/Test/dirs.lp" --json >e.json 2>err.txt && field psnr_pooled_db e.json; }
    above 'capturing first costs nothing' "$(unseen glossy)" "$(unseen "$glossy/Dome/dirs.lp" | awk '{ print $1 - 0.5 }')"
else
    skip 'photographs of gloss' 'no ../shared/data/synthrti'
fi
finish
