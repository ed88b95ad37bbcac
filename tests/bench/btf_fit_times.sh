#!/bin/sh
# How long the papers' models take to fit to a sample of stone, all cores.
# Usage: btf_fit_times.sh BUILD FOLDER [SIZE]; the sample (one ray a texel) stays in FOLDER.
set -eu
relume=$1/relume folder=$2 size=${3:-128}
mkdir -p "$folder"
[ -d "$folder/stone-$size" ] ||
    "$relume" synth --btf stone -o "$folder/stone-$size" --size "$size" --samples 1 --bounces 0 -q
echo '| model | seconds | processor seconds |'
echo '|---|---|---|'
for model in rfnl rfnlc lpca vpca; do
    rm -rf "$folder/fit"
    /usr/bin/env time -f "| \`$model\` | %e | %U |" \
        "$relume" btf fit "$folder/stone-$size" --model "$model" -o "$folder/fit" -q
done
rm -rf "$folder/fit"
