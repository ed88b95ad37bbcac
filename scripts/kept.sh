#!/bin/sh
# The files that this version writes, one small file of each kind, kept for every later version to read
# (tests/kept, docs/format.md#compatibility).
#   kept.sh add BUILD_FOLDER FOLDER      makes the files and adds those that FOLDER lacks
#   kept.sh values BUILD_FOLDER FOLDER   prints pixels relit from every file: NAME: LIGHT: x y r g b
#   kept.sh info BUILD_FOLDER FOLDER     prints what every file says about itself: NAME: JSON
# Files that are there stay as they are. A new version has a new folder. Groups of files:
#   relit/      what `relume relight` opens
#   captures/   photographs, encoded without loss before they are relit
#   parts/      folders with the parts of one file, joined before they are relit
#   materials/  BTFs, their models and surfaces, and g-BRDFs
#   objects/    baked objects
set -eu
build=$(cd "$2" && pwd)
mkdir -p "$3"
folder=$(cd "$3" && pwd)
relume=$build/relume sphere=$build/samples/sphere
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
LC_ALL=C
export LC_ALL

# ---------------------------------------------------------------- making files

make_captures() {
    "$relume" synth box -o box -q --size 8 --lights 12 --hemisphere --samples 1
    "$relume" synth box -o rows -q --size 32 --lights 4 --hemisphere --samples 1
    "$relume" synth teapot -o slab -q --size 8 --views 2x2 --lights 4 --samples 1
    "$relume" synth bust -o ring -q --size 6 --slabs 4 --views 2x2 --lights 3 --samples 1
    for p in cylindrical spherical cube; do
        "$relume" synth cornell -o $p -q --projection $p --size 8 --lights 8 --samples 1
    done
    "$relume" synth cornell -o discs -q --projection cylindrical --discs --size 8 --lights 8 --samples 1
    "$relume" synth box -o few -q --size 6 --lights 4 --hemisphere --samples 1
    "$sphere" mask --size 12 --lights 8 --hemisphere --mask --shade wrap >said.txt
    "$sphere" grey --size 8 --lights 6 --hemisphere --grey --intensities --format png >said.txt
    "$sphere" large --size 136 --rows 4 --lights 4 --hemisphere --shade wrap >said.txt
    "$relume" synth box -o glossy -q --size 12 --lights 20 --hemisphere --samples 1
}

# encode NAME CAPTURE OPTION...
encode() {
    name=$1 capture=$2
    shift 2
    "$relume" encode "$capture" -o "relit/$name.exr" -q "$@"
}

make_bases() {
    encode pca box --basis pca --coefficients 3
    encode eigen box --basis eigen --coefficients 3
    encode table box --basis table
    encode sh box --basis sh --coefficients 4
    encode hsh box --basis hsh --coefficients 4
    encode ptm box --basis ptm
    encode dct box --basis dct --coefficients 4
    encode dct-resampled box --basis dct-resampled --coefficients 4
    encode luminance box --basis sh --coefficients 4 --colour luminance
    for i in chord angular tps rbf natural hsh delaunay gaussian; do
        encode interpolant-$i box --basis pca --coefficients 2 --interpolant $i
    done
}

make_storages() {
    for bits in 10 12 16 half log float; do
        encode bits-$bits box --basis sh --coefficients 4 --bits $bits
    done
    for domain in display log log:0.1; do
        encode "domain-$(echo $domain | tr : -)" box --basis pca --coefficients 3 --domain $domain
    done
    for compression in none rle zip; do
        encode $compression box --basis sh --coefficients 1 --compression $compression
    done
}

make_codebooks() {
    encode codebook box --basis sh --coefficients 4 --codebook 16
    encode codebook-stages box --basis sh --coefficients 4 --codebook 8 --stages 2
    encode codebook-product box --basis pca --coefficients 4 --codebook 8 --split product:2
    encode codebook-luma box --basis ptm --codebook 8 --split luma
    encode codebook-shared slab --basis sh --coefficients 1 --codebook 8 --share
    encode codebook-views slab --basis sh --coefficients 1 --codebook 4 --bits 16
    encode codebook-mask mask --basis sh --coefficients 4 --codebook 16
}

make_lossy() {
    encode lossy-joint box --basis pca --coefficients 4 --psnr 30
    encode lossy-colour box --basis sh --coefficients 4 --psnr 30
    encode lossy-luminance box --basis sh --coefficients 4 --colour luminance --psnr 30
    encode lossy-table box --basis table --psnr 30
    encode lossy-slab slab --basis sh --coefficients 4 --psnr 30
    encode lossy-mask mask --basis hsh --coefficients 4 --psnr 30
    encode lossy-levels large --basis sh --coefficients 1 --psnr 30 --pyramid yes
    encode lossy-cube cube --basis sh --coefficients 4 --psnr 30
}

make_views() {
    encode slab slab --basis sh --coefficients 1
    encode slab-ring ring --basis sh --coefficients 1
    for p in cylindrical spherical cube discs; do
        encode panorama-$p $p --basis sh --coefficients 4
    done
    encode depth-none box --basis sh --coefficients 1 --no-depth
    encode mask mask --basis sh --coefficients 4
    encode grey grey --basis table
    encode levels large --basis sh --coefficients 1 --pyramid yes
    encode shadows box --basis table --shadows yes
    encode shadows-lossy box --basis table --shadows yes --psnr 30
    encode highlights glossy --basis pca --coefficients 4 --highlights yes
    encode notes box --basis sh --coefficients 1
    "$relume" notes relit/notes.exr --add 'line 1,2 6,5' --text 'a scratch' -q >said.txt
    "$relume" notes relit/notes.exr --embed -q >said.txt
    "$relume" export relit/ptm.exr -o relit/exported.ptm -q
    "$relume" export relit/hsh.exr -o relit/exported.rti -q
}

# make_parts NAME CAPTURE OPTION...: two parts of one file
make_parts() {
    name=$1 capture=$2
    shift 2
    mkdir -p "parts/$name"
    for i in 1 2; do
        "$relume" encode "$capture" -o "parts/$name/$i.exr" --part $i/2 -q "$@"
    done
}

make_materials() {
    printf '%s\n' '0 0 1' '.6 0 .8' '0 .6 .8' '-.6 0 .8' '0 -.6 .8' '.8 .4 .45' '-.4 .8 .45' >directions.txt
    "$relume" synth --btf wallpaper -o materials/measured -q --size 4 --directions directions.txt --samples 1 --bounces 0
    for m in lit bump laf slaf rfp rfnl rfnlc cmf vpca lpca fmf qmf; do
        "$relume" btf fit materials/measured --model $m --clusters 2 --components 2 -o materials/$m -q
    done
    "$relume" btf fit materials/measured --model lit --levels 2 -o materials/levels -q
    "$relume" btf tile wallpaper --size 16 --directions coarse --model lit --tile 16 --tiles 2 --matrix 3x2 \
        --levels 1 -o materials/surface -q >said.txt
    "$relume" btf plant -o materials/gbrdf.exr --size 4 --directions coarse -q
    cp materials/gbrdf.exr materials/gbrdf-edited.exr
    "$relume" btf edit materials/gbrdf-edited.exr --tint 1,0.8,0.6 --roughness 0.6 --label 1 -q
}

make_objects() {
    cat >fold.obj <<'OBJ'
v -0.5 -0.5 0
v 0.5 -0.5 0
v 0.5 0.5 0
v -0.5 0.5 0
v 0 0 0.5
vt 0 0
vt 0.48 0
vt 0.48 1
vt 0 1
vt 0.52 0
vt 1 0
vt 1 1
vn 0 0 1
vn -1 0 0
f 1/1/1 2/2/1 3/3/1
f 1/1/1 3/3/1 4/4/1
f 2/5/2 3/6/2 5/7/2
OBJ
    describe() { # name, material
        echo "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"fold.obj\",\"parts\":[{\"material\":$2}]}]}" >"$1.json"
    }
    bake() { # name, description, options...
        name=$1 description=$2
        shift 2
        "$relume" bake "$description.json" -o "objects/$name.exr" --rays 4 --size 8x8 -q "$@"
    }
    describe matte '{"diffuse":[0.8,0.4,0.2]}'
    describe glossy '"materials/rfnlc"'
    bake sh matte --coefficients 4 --lights 48
    bake table matte --basis table --coefficients 16 --lights 64
    bake wavelets matte --haar 2 --keep 4
    bake fixed matte --light fixed --light 'dir 0 0.3 1'
    bake views glossy --coefficients 4 --lights 32 --views 2 --clusters 2 --components 2
    bake views-apart glossy --coefficients 4 --lights 32 --views 2 --clusters 2 --components 2 --per-view
    bake fixed-views glossy --light fixed --light 'dir 0 0.3 1' --views 2 --clusters 2 --components 2
}

make_files() {
    make_captures
    mkdir relit captures parts materials objects
    make_bases
    make_storages
    make_codebooks
    make_lossy
    make_views
    make_parts views slab --basis sh --coefficients 1
    make_parts lossy slab --basis sh --coefficients 1 --psnr 30
    make_parts bands rows --basis sh --coefficients 1
    cp -r few captures/exr
    cp -r grey captures/png
    make_materials
    make_objects
}

# ---------------------------------------------------------------- reading files

names() { # of the files in a folder, without what stands beside them
    for path in "$1"/*/*; do
        case $path in *.edits.json | *.txt) continue ;; esac
        echo "${path#"$1"/}"
    done
}

# Prints five pixels of picture.pfm, the middle and four around it, each after NAME: LIGHT:.
# print_pixels NAME LIGHT
print_pixels() {
    set -- "$1" "$2" $(sed -n 2p picture.pfm)
    tail -c $(($3 * $4 * 12)) picture.pfm | od -An -v --endian=little -t f4 -w12 |
        awk -v name="$1" -v light="$2" -v w="$3" -v h="$4" '
            { row[NR - 1] = sprintf("%.6f %.6f %.6f", $1, $2, $3) }
            END {
                for (i = 0; i < 5; i++) {
                    x = int(substr("36475", i + 1, 1) * w / 10); y = int(substr("36745", i + 1, 1) * h / 10)
                    print name ": " light ": " x, y, row[(h - 1 - y) * w + x]
                }
            }'
}

# draw COMMAND...: prints pixels of what the command draws under $light, or why it draws nothing
draw() {
    if "$@" -o picture.pfm --light "$light" -q 2>said.txt; then
        print_pixels "$name" "$light"
    else
        echo "$name: $light: $(cat said.txt)"
    fi
}

has_depth() { grep -q '"depth": true' info.json; }

# values_of FOLDER NAME: what is drawn from one file
values_of() {
    path=$1/$2 name=$2
    rm -f whole.exr
    case $name in
    relit/*)
        "$relume" info "$path" --json >info.json || true
        case $(cat info.json) in
        *'"levels": 1'*) size='--size 68x2' ;; # the level itself
        *) size= ;;
        esac
        for light in 'dir 0.4 0.5 0.7' 'dir -0.6 0.3 0.5 rgb 0.5 1 2' 'point 0.5 0.6 1.5'; do
            case $light in point*) has_depth || continue ;; esac
            draw "$relume" relight "$path" $size
        done ;;
    captures/*)
        "$relume" encode "$path" -o whole.exr --basis table --bits float --shadows no --highlights no -q || true
        light='dir 0.4 0.5 0.7'
        draw "$relume" relight whole.exr ;;
    parts/*)
        "$relume" join "$path"/*.exr -o whole.exr -q || true
        light='dir 0.4 0.5 0.7'
        draw "$relume" relight whole.exr ;;
    materials/*)
        for light in 'dir 0.4 0.5 0.7' 'dir -0.6 0.3 0.5 rgb 0.5 1 2'; do
            draw "$relume" btf render "$path" --eye 0.2,-0.1,1
        done ;;
    objects/*)
        for light in 'dir 0.4 0.5 0.7' 'dir -0.6 0.3 0.5 rgb 0.5 1 2'; do
            draw "$relume" btf render "$path" --picture 12x12
        done ;;
    esac
}

# Prints what a file says about itself, without what later versions may count in another way.
info_of() {
    case $2 in
    captures/* | parts/*) return ;;
    materials/*) "$relume" btf info "$1/$2" --json ;;
    *) (cd "$1/${2%/*}" && "$relume" info "${2##*/}" --json) ;;
    esac | sed -E "s|, \"(file_bytes\|bits_per_pixel\|fit_rms\|store_rms\|source\|tile\|check_sums\|made_from\|codes)\": [^,}]*||g; s|^|$2: |"
}

# ---------------------------------------------------------------- tasks

# print_all VALUES_OR_INFO FOLDER
print_all() {
    for each in $(names "$2"); do
        "$1" "$2" "$each"
    done
}

add_missing() {
    mkdir "$work/new"
    cd "$work/new"
    make_files
    rm -rf ./*.* box few rows slab ring cylindrical spherical cube discs mask grey large glossy
    for group in *; do
        mkdir -p "$folder/$group"
        for path in "$group"/*; do
            [ -e "$folder/$path" ] || cp -r "$path" "$folder/$group/"
        done
    done
    cd "$work"
    for list in values info; do
        touch "$folder/$list.txt"
        for each in $(names "$folder"); do
            grep -q "^$each: " "$folder/$list.txt" || ${list}_of "$folder" "$each" >>"$folder/$list.txt"
        done
    done
}

cd "$work"
case $1 in
add) add_missing ;;
values | info) print_all "$1_of" "$folder" ;;
*) echo "kept.sh: unknown task '$1'; expected add, values or info" >&2 && exit 2 ;;
esac
