#!/bin/sh
# Files that earlier versions wrote (tests/kept/VERSION) are read as they were: every pixel that was stored with them is
# the same now, and they say the same about themselves. scripts/kept.sh made them; `make kept` adds files of new kinds.
. "$(dirname "$0")/lib.sh"
kept=$TOP/tests/kept

# A value relit from K coefficients differs between CPU types by 2 (K + 1) 2^-24 of the sum of its terms' sizes
# (docs/architecture.md, "Threads and equal bits"). Most files here have K of at most 13, and terms of up to 25 times 1
# plus the value, which gives 5e-5. Plain C differs from AVX2 with FMA by 1e-6.
tolerance=5e-5

# differs STORED FOUND NAME: prints the first line of NAME that was stored and is not found near it
differs() {
    awk -v name="$3: " -v tolerance=$tolerance -v found="$2" '
        function size(v) { return v < 0 ? -v : v }
        index($0, name) != 1 { next }
        {
            if ((getline now <found) <= 0) now = "nothing"
            while (index(now, name) != 1 && (getline now <found) > 0) {}
            same = split(now, b) == NF
            for (i = 1; i <= NF; i++)
                if (i <= NF - 3 ? $i != b[i] : !(b[i] ~ /^-?[0-9]/ && size($i - b[i]) <= tolerance * (1 + size($i))))
                    same = 0
            if (!same) { print "expected " $0 "; found " now; exit }
        }' "$1"
}

# members of a JSON object, one a line
members() { sed -n "s|^$2: {\(.*\)}$|\1|p" "$1" | sed 's/, "/\n"/g'; }

for version in "$kept"/*; do
    v=$(basename "$version")
    "$TOP/scripts/kept.sh" values "$BUILD" "$version" >values.txt 2>err.txt || not_ok "$v: values" "$(cat err.txt)"
    "$TOP/scripts/kept.sh" info "$BUILD" "$version" >info.txt 2>err.txt || not_ok "$v: info" "$(cat err.txt)"
    for name in $(cut -d: -f1 "$version/values.txt" | uniq); do
        [ -e "$version/$name" ] || not_ok "$v/$name is kept" 'it is gone; files of a version stay'
        why=$(differs "$version/values.txt" values.txt "$name")
        if [ "$why" ]; then not_ok "$v/$name shows what it showed" "$why"; else ok "$v/$name shows what it showed"; fi
        members "$version/info.txt" "$name" >stored.txt
        members info.txt "$name" >found.txt
        why=$(grep -vxFf found.txt stored.txt)
        if [ "$why" ]; then not_ok "$v/$name says what it said" "no $why"; else ok "$v/$name says what it said"; fi
        case $name in relit/*.exr) check "$v/$name is whole" "$RELUME" check "$version/$name" -q ;; esac
    done
    names=$(cut -d: -f1 values.txt | uniq)
    [ "$names" = "$(cut -d: -f1 "$version/values.txt" | uniq)" ] || not_ok "$v: values of each file" 'run make kept'
done

# A list of edits and notes are read, too.
check 'notes inside a file' sh -c '"$0" notes "$1" --json | grep -q "\"text\": \"a scratch\""' "$RELUME" "$kept/0.1/relit/notes.exr"
grep '^materials/gbrdf.exr' "$kept/0.1/values.txt" | cut -d: -f2- >plain.txt
grep '^materials/gbrdf-edited.exr' "$kept/0.1/values.txt" | cut -d: -f2- >edited.txt
differ 'edits of a g-BRDF are seen' plain.txt edited.txt

# What this version can write is kept: a new kind adds its file (make kept).
cat "$kept"/*/info.txt >all.txt
is_kept() { # member, words...
    member=$1
    shift
    for word in "$@"; do
        check "$member $word is kept" grep -q "\"$member\": \"$word\"" all.txt
    done
}
words_of() { "$RELUME" "$@" zzz 2>&1 | sed -n "s/.* 'zzz'; expected one of: //p"; } # what an option can be
# Storage log is half in a file, and the octahedral interpolant that of objects/table.exr.
for option in basis bits interpolant compression; do
    words=$(words_of encode few -o few.exr --$option)
    [ "$words" ] || not_ok "words of --$option" "$("$RELUME" encode few -o few.exr --$option zzz 2>&1)"
    is_kept $option $(echo "$words" | sed 's/auto//; s/ log / /; s/ octahedral//')
done
words=$(words_of btf fit few -o few --model)
[ "$words" ] || not_ok 'models' "$("$RELUME" btf fit few -o few --model zzz 2>&1)"
is_kept model $words
finish
