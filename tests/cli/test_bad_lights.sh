#!/bin/sh
# Captures that say too little for what is asked of them: more coefficients than lights, lights on a
# ring or on both hemispheres, pixels that are black, saturated, NaN or infinite.
. "$(dirname "$0")/lib.sh"
psnr() { "$RELUME" eval "$1" "$2" --json >eval.json && field psnr_db eval.json; }
finite() { # name, file, light: three numbers of ordinary size
    "$RELUME" query "$2" --eye 0.1,0.1,4 --direction 0,0,-1 --light "$3" -q >rgb.txt 2>err.txt
    check "$1" awk 'NF == 3 && $1 > -9 && $1 < 9 && $2 > -9 && $2 < 9 && $3 > -9 && $3 < 9 { n++ }
        END { exit n != 1 }' rgb.txt
}

# ---- more coefficients than lights
"$sphere" few --size 16 --lights 5 --hemisphere || exit 1
for basis in 'ptm 6' 'hsh 9' 'sh 9' 'dct 10' 'dct-resampled 10'; do
    set -- $basis
    not_encoded "$1: more coefficients than lights" \
        "few: $2 coefficients of basis $1 need at least $2 lights; found 5" few --basis $1 --coefficients $2
    encoded "forced-$1" "warning: few: 5 lights are too few for $2 coefficients of basis $1" few \
        --basis $1 --coefficients $2 --force
    finite "$1: forced and looked at from aside" "forced-$1.exr" "dir 1 -1 0.2"
    [ $1 = dct-resampled ] || # which fits nothing: it averages
        above "$1: the lights it had are met" "$(psnr forced-$1.exr few)" 30
done
not_encoded 'pca: more components than samples' 'few: basis pca takes at most 15 coefficients for 5 lights; found 16' \
    few --basis pca --coefficients 16
not_encoded 'table: any number but that of the lights' 'few: basis table takes 5 coefficients for 5 lights; found 4' \
    few --basis table --coefficients 4
expect_fail 'ptm has 3 or 6' 2 'basis ptm cannot have 4 coefficients; the nearest number is 3' out.exr \
    "$RELUME" encode few -o out.exr --basis ptm --coefficients 4
expect_fail 'no luminance of components' 2 'pca cannot be fitted to luminance only; leave out --colour' out.exr \
    "$RELUME" encode few -o out.exr --basis pca --colour luminance

# ---- lights on one ring: exact, and as files with three decimals say it
"$sphere" ring --size 8 --lights 12 --hemisphere
ring() { awk -v f="$1" 'NR == 1 { print; next } { a = 0.5235988 * NR
    printf "%s " f " " f " " f "\n", $1, cos(a) * 0.8, sin(a) * 0.8, 0.6 }' ring/dirs.lp >ring/$2.lp; }
ring %.9f exact
ring %.2f rounded
for ring in 'exact hsh 4' 'exact sh 4' 'exact dct 6' 'exact dct-resampled 6' 'exact pca 6' \
    'exact table 12' 'exact ptm 3' 'rounded sh 4' 'rounded pca 6'; do
    set -- $ring
    encoded "$1-$2" "warning: ring/$1.lp: all 12 lamps stand on one ring or arc; light from other directions is guessed" \
        ring/$1.lp --basis $2 --coefficients $3 --force
    finite "$2, $1: from the pole" "$1-$2.exr" "dir 0 0 1"
done
not_encoded 'ptm on a ring' 'determine only 5 of 6 coefficients' ring/exact.lp --basis ptm --coefficients 6
awk 'NR == 1 { print; next } { a = 0.24 * (NR - 7); print $1, sin(a), 0, cos(a) }' ring/dirs.lp >ring/arc.lp
encoded arc 'all 12 lamps stand on one ring' ring/arc.lp --basis pca

# ---- bases of one hemisphere
"$sphere" sky --size 16 --lights 20
for basis in ptm hsh; do
    not_encoded "$basis for a whole sphere" "sky: basis $basis covers one hemisphere of lights; found lights on both sides" \
        sky --basis $basis
done
not_encoded 'hsh between lights of a whole sphere' 'interpolant hsh covers one hemisphere' sky --basis pca --interpolant hsh

# ---- NaN and infinity: named, counted, repaired on demand
"$sphere" float --size 24 --lights 20 --hemisphere --mask
poke() { # light, x, y, value: changes c
    cp c/view00/light$1.exr whole.exr
    "$mkimage" poke whole.exr c/view00/light$1.exr $2 $3 $4
}
fresh float c; poke 0003 12 12 nan
not_encoded 'one NaN' 'c/view00/light0003.exr: 1 pixel is NaN or infinite; .*--repair' c
poke 0003 20 23 inf; poke 0007 12 12 -inf
for basis in sh pca; do
    not_encoded "three broken pixels, $basis" \
        'c/view00/light0003.exr: 2 pixels are NaN or infinite, and some of 1 more image;' c --basis $basis
    encoded repaired-$basis 'warning: c/view00/light0003.exr: 2 pixels are NaN or infinite; repaired' c \
        --basis $basis --repair
    encoded intact-$basis - float --basis $basis
    encoded nothing-to-repair-$basis - float --basis $basis --repair
    same "$basis: nothing to repair changes nothing" intact-$basis.exr nothing-to-repair-$basis.exr
    above "$basis: repaired pictures are near the intact ones" "$(psnr repaired-$basis.exr float)" \
        "$(psnr intact-$basis.exr float | awk '{ print $1 - 1 }')"
done

# ---- black and saturated
"$sphere" photos --size 24 --lights 10 --hemisphere --format png
fresh photos c
for i in c/view00/light*.png; do "$mkimage" gain "$i" "${i%png}exr" 0; rm "$i"; done
sed 's/\.png/.exr/g' photos/capture.json >c/capture.json
encoded black 'warning: c: 576 of 576 pixels are black under every light' c --basis pca
encoded black-sh 'warning: c: 10 images are black' c --basis sh
finite 'black stays black' black.exr "dir 0 0 1"
check 'black is 0 0 0' grep -qx '0 0 0' rgb.txt
encoded saturated 'photos: [1-9][0-9]* of 576 pixels are overexposed in at least one photograph' photos
finish
