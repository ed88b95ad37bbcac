#!/bin/sh
# The tables of docs/measurements/btf.md: every model on every built-in material, as Markdown.
# Usage: btf_tables.sh BUILD FOLDER [SIZE [MATERIAL...]]
# Samples and rows stay in FOLDER and are used again, so that it can be interrupted.
set -eu
relume=$1/relume folder=$2 size=${3:-64}
shift "$(($# < 3 ? $# : 3))"
[ $# -gt 0 ] || set -- stone corduroy leather weave wallpaper aluminium knit

# label | options; the size of lpca 32 x 8 is 1:14 of 64 x 64 texels
rows='lit|--models lit
bump|--models bump
laf|--models laf
slaf|--models slaf
rfp|--models rfp
rfnl|--models rfnl
rfnlc|--models rfnlc
cmf|--models cmf
vpca|--models vpca
vpca16|--models vpca --components 16
lpca|--models lpca
fmf|--models fmf
qmf14|--models qmf --ratio 14
qmf|--models qmf
qmf400|--models qmf --ratio 400'

name_of() {
    case $1 in
    vpca16) echo '`vpca` 16' ;;
    qmf*) ratio=${1#qmf}; echo "\`qmf\` 1:${ratio:-200}" ;;
    *) echo "\`$1\`" ;;
    esac
}

mkdir -p "$folder/rows"
for m; do
    [ -d "$folder/$m" ] || "$relume" synth --btf "$m" -o "$folder/$m" --size "$size" -q
    printf '**%s**, %s x %s texels\n\n' "$m" "$size" "$size"
    echo '| model | mean abs: avg | min | max | RMS % | rel. % | dE | SSIM | B a texel | total MiB | fit s | ops | fetches | frames/s |'
    echo '|---|---|---|---|---|---|---|---|---|---|---|---|---|---|'
    echo "$rows" | while IFS='|' read -r label options; do
        row=$folder/rows/$m-$label.txt
        if [ ! -s "$row" ]; then
            # shellcheck disable=SC2086  # options are words
            "$relume" btf compare "$folder/$m" $options --pictures 9 -q >"$row.part"
            mv "$row.part" "$row"
        fi
        printf '| %s |' "$(name_of "$label")"
        sed -n 2p "$row" | awk '{ for (i = 2; i <= NF; i++) printf " %s |", $i; print "" }'
    done
    echo
done
