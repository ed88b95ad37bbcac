#!/bin/sh
# The contract, end to end, on captures whose pixels are known (samples/sphere.c).
. "$(dirname "$0")/lib.sh"
diff() { "$mkimage" maxdiff "$1" "$2"; }
valid_json() { # name, file
    if [ "$python" ] && "$python" -m json.tool <"$2" >/dev/null 2>&1 && ! grep -qiE 'nan|inf[^o]' "$2" && [ "$(wc -l <"$2")" -eq 1 ]; then
        ok "$1"
    elif [ "$python" ]; then
        not_ok "$1" "$(head -c 400 "$2")"
    else
        skip "$1" 'no python3'
    fi
}

# ---- planar: what is in the span of the basis comes back, down to the quantiser
"$sphere" wrap --size 32 --lights 40 --shade wrap --mask || exit 1
relume encode wrap -o wrap16.exr --basis sh --coefficients 4 --bits 16
# 16-bit steps over a range of about 1 are 1.5e-5; 4 of them and the fit's ridge of 1e-7 stay below
below 'sh 4 holds wrapped Lambert, 16 bits' "$(eval_field wrap16.exr wrap rms)" 1e-4
relume encode wrap -o wrap8.exr --basis sh --coefficients 4
# a step of 8 bits is range/255, range < 2: rms of rounding = step / sqrt 12 x sqrt 4 functions
below 'sh 4 holds wrapped Lambert, 8 bits' "$(eval_field wrap8.exr wrap rms)" 0.0046
"$sphere" held --size 32 --lights 17 --pattern random --seed 5 --shade wrap --mask
below 'at lights not captured as well' "$(eval_field wrap16.exr held rms)" 1e-4
# clamped cosine: the part of its energy above degree 2 is 1/128 of it (Ramamoorthi and Hanrahan
# 2001), mean square over the sphere 1/6, so rms <= albedo sqrt(1/768) = 0.036 albedo; the largest
# albedo is 0.8, least squares on 200 even lights comes within 5 % of the integral
"$sphere" lambert --size 16 --lights 200 --shade lambert
relume encode lambert -o lambert.exr --basis sh --coefficients 9 --bits 16
below 'sh 9 on Lambert: the energy above degree 2' "$(eval_field lambert.exr lambert rms)" 0.0303
above 'and not less than half of the smallest' "$(eval_field lambert.exr lambert rms)" 0.006

# ---- table: a captured light comes back within half a step, in every storage
"$sphere" full --size 32 --lights 24 --half
for bits in 8 16 half; do
    relume encode full -o "t$bits.exr" --basis table --bits "$bits"
    relume relight "t$bits.exr" -o t.exr --light "dir $(sed -n 9p full/dirs.lp | cut -d' ' -f2-)"
    case $bits in # values lie in [0, 1.31]: a light of the lobe; half a step, a little rounding
    8) most=0.00258 ;;
    16) most=0.00002 ;;
    half) most=0.00001 ;; # the images are halves themselves; weights sum to 1 in single precision
    esac
    below "table at a captured light, $bits" "$(diff t.exr full/view00/light0007.exr)" $most
done
relume info t8.exr --json >info.json
valid_json 'info --json' info.json
for f in '"projection": "planar"' '"views": 1,' '"width": 32,' '"lights": 24,' '"basis": "table"' '"depth": true' '"mask": false' '"bits": "8"'; do
    if grep -q "$f" info.json; then ok "info: $f"; else not_ok "info: $f" "$(cat info.json)"; fi
done
"$RELUME" eval t8.exr full --json >eval.json 2>err.txt
valid_json 'eval --json' eval.json
for f in rms psnr_db psnr_pooled_db ssim delta_e file_bytes bits_per_pixel raw_bytes ratio; do
    above "eval: $f" "$(field $f eval.json)" 1e-6
done
below 'eval: raw_bytes' "$(field raw_bytes eval.json)" $((24 * 32 * 32 * 12))
below 'eval: file_bytes' "$(field file_bytes eval.json)" "$(wc -c <t8.exr)"
if [ "$(grep -o '"rms"' eval.json | wc -l)" -eq 25 ]; then ok 'eval: per_light'; else not_ok 'eval: per_light' "$(cat eval.json)"; fi
"$RELUME" compare full/view00/light0001.exr full/view00/light0001.exr --json >c.json
valid_json 'compare --json' c.json
below 'compare with itself: PSNR is capped' "$(field psnr_db c.json)" 200
above 'compare with itself: PSNR is 200' "$(field psnr_db c.json)" 200
above 'compare with itself: SSIM is 1' "$(field ssim c.json)" 1
"$mkimage" poke full/view00/light0001.exr nan.exr 3 3 nan
"$RELUME" compare nan.exr full/view00/light0001.exr --json >c.json
valid_json 'compare with NaN --json' c.json
"$sphere" tiny --size 1 --lights 3
relume encode tiny -o tiny.exr
"$RELUME" eval tiny.exr tiny --json >e.json
valid_json 'a capture of one pixel' e.json
if grep -q '"ssim": null' e.json; then ok 'SSIM of one pixel is null'; else not_ok 'SSIM of one pixel is null' "$(cat e.json)"; fi
"$RELUME" lights -n 7 --json >l.json
valid_json 'lights --json' l.json

# ---- query agrees with relight: pixel (20, 9) of 32 lies at x = 0.28125, y = 0.40625
relume relight t16.exr -o front.exr
"$RELUME" query t16.exr --eye 0.28125,0.40625,4 --direction 0,0,-1 --json >q.json
valid_json 'query --json' q.json
"$RELUME" query t16.exr --eye 0.28125,0.40625,4 --direction 0,0,-1 >q.txt
"$mkimage" read front.exr 20 9 >p.txt
for i in 1 2 3; do
    below "query is the pixel, channel $i" "$(awk -v i=$i 'NR == FNR { a = $i; next } { d = $i - a; print d < 0 ? -d : d }' q.txt p.txt)" 1e-6
done

# ---- lights add up; --exposure
relume relight t16.exr -o a.exr --light 'dir 1 0 1'
relume relight t16.exr -o b.exr --light 'dir 0 1 2 rgb 0.5 2 1'
relume relight t16.exr -o ab.exr --light 'dir 1 0 1' --light 'dir 0 1 2 rgb 0.5 2 1'
"$mkimage" sum sum.exr a.exr b.exr
below 'two lights are the sum of each' "$(diff ab.exr sum.exr)" 1e-5 # single precision sums
relume relight t16.exr -o a2.exr --light 'dir 1 0 1' --exposure 1
"$mkimage" sum aa.exr a.exr a.exr
below 'one stop doubles' "$(diff a2.exr aa.exr)" 0
relume relight t16.exr -o long.exr --light 'dir 100 0 100'
below 'the length of a direction does not matter' "$(diff a.exr long.exr)" 1e-6
relume relight t16.exr -o c.exr --cpu-mask 0
below '--cpu-mask 0 is close to the default' "$(diff c.exr front.exr)" 1e-5

# ---- the display domain sums in linear light too
"$sphere" png --size 32 --lights 24 --format png
relume encode png -o p16.exr --basis table --bits 16
relume info p16.exr --json >info.json
if grep -q '"domain": "display"' info.json; then ok 'PNG captures live in the display domain'; else not_ok 'PNG captures live in the display domain' "$(cat info.json)"; fi
relume relight p16.exr -o a.exr --light 'dir 1 0 1'
relume relight p16.exr -o b.exr --light 'dir 0 1 2'
relume relight p16.exr -o ab.exr --light 'dir 1 0 1' --light 'dir 0 1 2'
"$mkimage" sum sum.exr a.exr b.exr
below 'display domain: two lights are the sum of each' "$(diff ab.exr sum.exr)" 1e-5
# 8-bit codes of the images are kept to 16 bits: the same picture comes back, as the same codes
relume relight p16.exr -o back.png --light "dir $(sed -n 9p png/dirs.lp | cut -d' ' -f2-)"
below 'display domain: a captured light comes back' "$(diff back.png png/view00/light0007.png)" 0.0001

# ---- threads: equal bytes
for bits in 8 half; do
    for n in 1 2 7; do
        relume encode full -o "e$n.exr" --basis sh --coefficients 9 --bits $bits --threads $n
    done
    same "encode --bits $bits with 1 and 2 threads" e1.exr e2.exr
    same "encode --bits $bits with 1 and 7 threads" e1.exr e7.exr
done
relume relight e1.exr -o r1.exr --threads 1
relume relight e1.exr -o r7.exr --threads 7
same 'relight with 1 and 7 threads' r1.exr r7.exr
"$RELUME" eval e1.exr full --json --threads 1 >v1.json
"$RELUME" eval e1.exr full --json --threads 7 >v7.json
same 'eval with 1 and 7 threads' v1.json v7.json

# ---- intensities are divided out; masks; depth
"$sphere" plain --size 24 --lights 12
"$sphere" bright --size 24 --lights 12 --intensities
relume encode plain -o plain.exr --basis table --bits 16
relume encode bright -o bright.exr --basis table --bits 16
relume relight plain.exr -o a.exr --light 'dir 1 1 1'
relume relight bright.exr -o b.exr --light 'dir 1 1 1'
below 'light intensities are divided out' "$(diff a.exr b.exr)" 4e-5 # a step of 16 bits each
below 'and of the capture in eval' "$(eval_field plain.exr bright rms)" 2e-5
relume relight wrap8.exr -o w.exr
# code x step + offset is 0 but for the rounding of single precision
below 'outside the mask is black' "$("$mkimage" read w.exr 0 0 | awk '{ print ($1 * $1 + $2 * $2 + $3 * $3) ^ 0.5 }')" 1e-8
relume info wrap8.exr --json >info.json
if grep -q '"depth": true, "mask": true' info.json; then ok 'depth and mask are stored'; else not_ok 'depth and mask are stored' "$(cat info.json)"; fi

# ---- hemisphere: below the horizon is a warning, and the value at the horizon
"$sphere" dome --size 24 --lights 40 --hemisphere
for basis in 'sh --coefficients 9' table; do
    relume encode dome -o dome.exr --basis $basis --bits 16
    expect_ok "$basis: below the horizon" 'warning: dome.exr: light 1 lies below the horizon' "$RELUME" relight dome.exr -o low.exr --light 'dir 1 2 -1'
    check "$basis: said once" [ "$(grep -c warning err.txt)" = 1 ]
    expect_ok "$basis: at the horizon" - "$RELUME" relight dome.exr -o edge.exr --light 'dir 1 2 0'
    below "$basis: the value at the horizon" "$(diff low.exr edge.exr)" 1e-6
done

# ---- quiet; pipes
"$RELUME" encode full -o quiet.exr -q >out.txt 2>&1
if [ -s out.txt ]; then not_ok '-q is silent' "$(cat out.txt)"; else ok '-q is silent'; fi
relume relight e1.exr -o direct.exr
"$RELUME" relight e1.exr -o /dev/stdout | cat >piped.exr
same 'an EXR through a pipe' direct.exr piped.exr
mkfifo pipe.png
"$RELUME" relight e1.exr -o pipe.png & cat pipe.png >piped.png; wait $!
relume relight e1.exr -o direct.png
same 'a PNG through a named pipe' direct.png piped.png
"$RELUME" encode full -o /dev/stdout --basis sh --coefficients 9 --bits half 2>/dev/null | cat >piped.exr
same 'a relume file through a pipe' e1.exr piped.exr
for e in png jpg tif bmp tga; do
    relume relight e1.exr -o "kind.$e"
    most=0.02 # half an 8-bit step of sRGB near white is 0.0045 in linear light; below 0 is clipped
    [ $e = jpg ] && most=0.25
    "$RELUME" compare "kind.$e" direct.png --json >c.json
    below "relight writes $e" "$(field max_abs c.json)" $most
done
relume relight e1.exr -o kind.hdr # 8-bit mantissas, negative values clipped
"$RELUME" compare kind.hdr direct.exr --json >c.json
above 'relight writes hdr' "$(field psnr_db c.json)" 35

# ---- slab
"$sphere" slab --size 24 --lights 12 --views 3 || exit 1
relume encode slab -o slab.exr --basis table --bits 16
relume relight slab.exr -o view.exr --view 5 --light 'dir 1 1 2'
relume relight slab.exr -o eye.exr --eye 0.5,0,3 --light 'dir 1 1 2' # view 5: second row, third column
same 'an eye at a captured place reproduces the view' view.exr eye.exr
relume relight slab.exr -o middle.exr --light 'dir 1 1 2'
relume relight slab.exr -o view4.exr --view 4 --light 'dir 1 1 2'
same 'the default eye is the middle' middle.exr view4.exr
expect_fail 'an eye beside the grid' 1 'slab.exr: .*eye' out.exr "$RELUME" relight slab.exr -o out.exr --eye 9,0,3
expect_fail 'a ray beside the grid' 1 'slab.exr: .*(grid|window)' - "$RELUME" query slab.exr --eye 0.9,0,3 --direction 0,0,-1
expect_ok 'a ray inside' - "$RELUME" query slab.exr --eye 0.1,0.2,3 --direction 0,0,-1
above 'eval of a slab' "$(eval_field slab.exr slab psnr_db)" 70
if [ "$(field views eval.json)" = 9 ]; then ok 'eval counts the views'; else not_ok 'eval counts the views' "$(cat eval.json)"; fi
finish
