#!/bin/sh
# Make a manual page from a program's own --help, so that it cannot go stale:
#     man.sh PROGRAM [COMMAND] > page.1
# What --help prints is "usage: ...", a summary, "options:", perhaps more text, and "example:".
set -eu
program=$1
command=${2:-}
here=$(cd "$(dirname "$0")" && pwd)
date=$(date -u -r "$here/../include/relume/base.h" +%Y-%m-%d)
version=$(sed -n 's/^#define RELUME_VERSION "\(.*\)"/\1/p' "$here/../include/relume/base.h")
name=$(basename "$program")$(echo "${command:+-$command}" | tr " " -)
tool=$(basename "$program")

"$program" $command --help | awk -v name="$name" -v tool="$tool" -v version="$version" \
    -v date="$date" '
# Roff reads a leading dot or quote as a request and a backslash as an escape.
function plain(s) {
    gsub(/\\/, "\\e", s)
    gsub(/-/, "\\-", s)
    if (s ~ /^[.\x27]/) s = "\\&" s
    return s
}
# A paragraph in lines below 80 columns.
function say(s,    word, n, i, out) {
    n = split(s, word, " ")
    for (i = 1; i <= n; i++) {
        if (out != "" && length(out) + length(word[i]) > 68) { print plain(out); out = "" }
        out = out == "" ? word[i] : out " " word[i]
    }
    if (out != "") print plain(out)
}
function sentence(s) { return toupper(substr(s, 1, 1)) substr(s, 2) (s ~ /\.$/ ? "" : ".") }
function quoted(s) { s = plain(s); gsub(/"/, "\\(dq", s); return "\"" s "\"" }
function section(title) { print ".SH " title }
function literal(first, last,    i) {
    print ".nf"
    for (i = first; i <= last; i++) print line[i] == "" ? "" : plain(line[i])
    print ".fi"
}
function trimmed(s) { sub(/^ +/, "", s); return s }
# "  --size N    what it is": the name is followed by at least two blanks, or stands alone.
function item(s,    left, cut) {
    if (s ~ /^ [^ ]/) {  # a group of options
        sub(/:$/, "", s)
        s = trimmed(s)
        print ".SS " quoted(toupper(substr(s, 1, 1)) substr(s, 2))
        return
    }
    s = trimmed(s)
    cut = match(s, /  +/)
    left = cut ? substr(s, 1, cut - 1) : s
    if (!cut && match(s, /^-[^ ]*( [A-Zxyz][^ ]*)? /)) {
        left = substr(s, 1, RLENGTH - 1)
        cut = RLENGTH
    }
    print ".TP"
    print ".B " quoted(left)
    if (cut) say(trimmed(substr(s, cut)))
}
{ line[NR] = $0 }
END {
    for (i = 1; i <= NR; i++) {
        if (line[i] ~ /^usage: /) usage = substr(line[i], 8)
        else if (line[i] == "options:") options = i
        else if (line[i] ~ /^example:$/) example = i
        else if (!options && !summary && line[i] != "" && usage) summary = line[i]
    }
    overview = !options
    if (overview) {
        summary = line[1]
        sub(/.* - /, "", summary)
    }
    for (last = options; options && line[last + 1] != ""; last++) ;
    print ".TH " toupper(name) " 1 \"" date "\" \"relume " version "\" \"relume manual\""
    section("NAME")
    short = summary  # without what is in brackets and after a comma
    sub(/ \(.*\)/, "", short)
    sub(/, .*/, "", short)
    sub(/\.$/, "", short)
    print plain(name) " \\- " plain(tolower(substr(short, 1, 1)) substr(short, 2))
    section("SYNOPSIS")
    print ".B " quoted(usage)
    section("DESCRIPTION")
    say(sentence(summary))
    if (overview) {
        print "One file holds a scene photographed or rendered under many lights;"
        print "it can be shown under any light and, for light slabs and panoramas, from other"
        print "viewpoints."
        section("COMMANDS")
        for (i = 4; i < NR; i++) if (line[i] ~ /^  [a-z]/) {
            split(trimmed(line[i]), word, " ")
            text = trimmed(line[i]); sub(/^[^ ]+ +/, "", text)
            print ".TP"
            print ".BR " plain(tool "-" word[1]) " (1)"
            say(text)
        }
        section("OPTIONS")
        print ".TP\n.B \"\\-\\-help\"\nThis overview; after a command, what it takes."
        print ".TP\n.B \"\\-\\-version\"\nThe version."
    } else {
        section("OPTIONS")
        for (i = options + 1; i <= last; i++) item(line[i])
        while (last < NR && line[last + 1] == "") last++
        end = example ? example - 1 : NR
        while (end > last && line[end] == "") end--
        if (end > last) { section("USE"); literal(last + 1, end) }
    }
    section("EXAMPLE")
    print ".nf"
    if (overview) print plain("relume encode photos/dirs.lp -o statue.exr\nrelume relight statue.exr -o raking.png --light \"dir 1 0 0.2\"")
    else for (i = example + 1; i <= NR; i++) if (line[i] != "") print plain(trimmed(line[i]))
    print ".fi"
    section("EXIT STATUS")
    print ".TP\n.B 0\nDone."
    print ".TP\n.B 1\nThe input was at fault: a file is missing, broken, or does not fit."
    print ".TP\n.B 2\nWrong usage: an unknown command, option or name, or a value out of range."
    print ".TP\n.B 3\nThe machine was at fault: no memory, an output that cannot be written, no GL\ncontext."
    section("SEE ALSO")
    if (overview) print ".BR relume\\-view (1)"
    else if (tool == "relume") print ".BR relume (1),\n.BR relume\\-view (1)"
    else print ".BR relume (1)"
}'
