#!/bin/sh
# Formulas written twice, in GLSL and in C: comments that say `Twin: NAME` name a function or a file that
# is there, and a test says that it compares the two. No function stands in shaders of the viewer and in
# the page's scripts: what both have is in viewer/shaders/shared.
. "$(dirname "$0")/lib.sh"
cd "$TOP" || exit 1

find src viewer web include -name '*.[ch]' -o -name '*.cpp' -o -name '*.glsl' -o -name '*.js' >"$work/files.txt"
# "NAME FILE" of each function with a body; of static ones, too
grep -E '\.(c|h|cpp)$' "$work/files.txt" | xargs awk '
    FNR == 1 { name = "" }
    /^[a-z].*[ *][a-z_0-9]+\(/ { match($0, /[ *][a-z_0-9]+\(/); name = substr($0, RSTART + 1, RLENGTH - 2) }
    name != "" && /;$/ { name = "" }
    name != "" && /^\{/ { print name, FILENAME; name = "" }' >"$work/bodies.txt"
# "FILE: TWIN" of each twin that the files name, TWIN a file of C; "wrong ..." of what names none or several
pairs_of() { xargs awk -f tests/tools/twins.awk | pair; }
pair() {
    awk -v files="$work/files.txt" -v bodies="$work/bodies.txt" '
    function fits(path, end) { return path == end || (length(path) > length(end) &&
        substr(path, length(path) - length(end)) == "/" end) }
    BEGIN {
        while ((getline line < files) > 0) file[++n] = line
        while ((getline line < bodies) > 0) { split(line, p, " "); body[p[1]] = body[p[1]] " " p[2] }
    }
    {
        count = 0
        if ($2 ~ /\.(c|h)$/) {
            for (i = 1; i <= n; i++) if (fits(file[i], $2)) { count++; found = file[i] }
        } else {
            m = split(body[$2], p, " ")
            for (i = 1; i <= m; i++) if ($3 != "of" || fits(p[i], $4)) { count++; found = p[i] }
        }
        if (count == 1) print $1 ": " found
        else print "wrong", $0, "(" count " of that name)"
    }'
}
grep -E '^(src|viewer|web)/' "$work/files.txt" | pairs_of >"$work/pairs.txt"
none() { # name, file of what is wrong
    if [ -s "$2" ]; then not_ok "$1" "$(head -n 12 "$2")"; else ok "$1"; fi
}
grep '^wrong' "$work/pairs.txt" >"$work/wrong.txt"
none 'what comments call twins is there, and one' "$work/wrong.txt"
printf '// A. Twin: transfer.c. B.\n// Twins: no_such_function,\n// stage_reaches of src/relight/shadow/stage.c\n// a twin of none\n' >"$work/made.glsl"
check '... and what is not there is found' [ "$(echo "$work/made.glsl" | pairs_of | cut -d' ' -f1 | sed "s|$work/||" | tr '\n' ' ')" = 'made.glsl: wrong made.glsl: wrong ' ]
check 'there are many' [ "$(wc -l <"$work/pairs.txt")" -gt 150 ]

# "FILE TWIN" of each `Compares: FILE, FILE with TWIN, TWIN.` of a test, whose comment ends with it
grep -rl 'Compares: ' tests --include='*.c' --include='*.sh' | grep -v test_twins | xargs awk '
    function put(    n, m, i, k, a, b) {
        n = split(substr(text, 1, index(text, " with ") - 1), a, /, */)
        m = split(substr(text, index(text, " with ") + 6), b, /, */)
        for (i = 1; i <= n; i++) for (k = 1; k <= m; k++) print a[i], b[k]
        text = ""
    }
    { line = $0; sub(/^(\/\/|#) */, "", line); comment = line != $0 }
    text != "" && comment { text = text " " line }
    comment && sub(/^Compares: /, "", line) { text = line }
    text != "" && /\.$/ { sub(/\.$/, "", text); put() }' | sort -u >"$work/compared.txt"
grep -E '^(viewer/shaders|web)/' "$work/pairs.txt" | sort -u >"$work/asked.txt"
# of `asked` those without a test; of `compared` files that are no twins
awk -v compared="$work/compared.txt" -v stale="$work/stale.txt" '
    function ends(path, end) { return path == end || substr(path, length(path) - length(end)) == "/" end }
    BEGIN { while ((getline line < compared) > 0) { split(line, p, " "); file[++n] = p[1]; twin[n] = p[2] } }
    {
        found = 0
        for (i = 1; i <= n; i++)
            if (ends(substr($1, 1, length($1) - 1), file[i]) && ends($2, twin[i]))
                found = right[file[i]] = right[twin[i]] = 1
        if (!found) print
    }
    END {
        printf "" >stale
        for (i = 1; i <= n; i++)
            if (!right[file[i]] && !told[file[i]]++) print file[i] >stale
            else if (!right[twin[i]] && !told[twin[i]]++) print twin[i] >stale
    }' "$work/asked.txt" >"$work/untested.txt"
none 'a test compares each with its twin' "$work/untested.txt"
none 'and compares what are twins' "$work/stale.txt"

# ---- one text for the viewer and for pages
find viewer/shaders -name '*.glsl' ! -path '*/shared/*' -print0 | xargs -0 sed -n 's/^[a-z][a-z0-9]* \([a-z_0-9]*\)(.*/\1/p' | sort -u >"$work/viewer.txt"
sed -n 's/^[a-z][a-z0-9]* \([a-z_0-9]*\)(.*/\1/p' web/*.js | sort -u >"$work/web.txt"
# of one name only: what a shared file asks the shader for, by a prototype; and these
sed -n 's/^[a-z][a-z0-9]* \([a-z_0-9]*\)(.*);.*/\1/p' viewer/shaders/shared/*.glsl >"$work/own.txt"
cat >>"$work/own.txt" <<'OWN'
cell_value
direction
model_at
show
triangles_find
value
OWN
comm -12 "$work/viewer.txt" "$work/web.txt" | sed '/^main$/d' | while read -r name; do grep -qx "$name" "$work/own.txt" || echo "$name"; done >"$work/twice.txt"
none 'no function stands in the viewer and in pages' "$work/twice.txt"
finish
