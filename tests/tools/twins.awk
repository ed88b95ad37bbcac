# twins.awk - what comments call twins. Prints "FILE NAME" for each, FILE as it is named on the command
# line, NAME a function or a file; "FILE NAME of OTHER" where the comment says where the function is.
# A comment says `Twin: NAME` or `Twins: NAME, NAME of OTHER and NAME`.
function put(text, file,    item, n, i, of, list) {
    while (match(text, /Twins?: [A-Za-z0-9_.\/]+((, | and )[A-Za-z0-9_.\/]+)*( of [A-Za-z0-9_.\/]+)?/)) {
        list = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        sub(/^Twins?: /, "", list)
        of = ""
        if (match(list, / of .*/)) {
            of = substr(list, RSTART)
            sub(/\.$/, "", of)
            list = substr(list, 1, RSTART - 1)
        }
        gsub(/ and /, ", ", list)
        n = split(list, item, /, /)
        for (i = 1; i <= n; i++) {
            sub(/\.$/, "", item[i])
            print file, item[i] of
        }
    }
    if (text ~ /[Tt]wins? of /)
        print file, "is not written as Twin:"
}
FNR == 1 { put(comment, last); comment = ""; last = FILENAME }
/\/\// {
    own = $0 ~ /^ *\/\//
    line = $0
    sub(/.*\/\/ */, "", line)
    if (!own) { put(comment, last); comment = "" }
    comment = comment " " line
    next
}
{ put(comment, last); comment = "" }
END { put(comment, last) }
