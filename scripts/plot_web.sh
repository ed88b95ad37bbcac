#!/bin/sh
# Draws docs/data/web.csv as docs/pictures/web.svg: quality of plane folders on unseen lights against
# their bytes, a panel for each set of surfaces, with the upper edge of every curve.
set -eu
cd "$(dirname "$0")/.."
awk '
function x_of(b) { return left + (log(b) - log(0.2)) / (log(16) - log(0.2)) * wide }
function y_of(d) { return top + (high - d) / (high - low) * tall }
function text(x, y, s, more) { printf "<text x=\"%.1f\" y=\"%.1f\"%s>%s</text>\n", x, y, more, s }
function axes(   b, d, n, ticks) {
    printf "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" class=\"box\"/>\n", left, top, wide, tall
    n = split("0.25 0.5 1 2 4 8 16", ticks, " ")
    for (b = 1; b <= n; b++) {
        printf "<path d=\"M%.1f %.1fv%.1f\" class=\"grid\"/>\n", x_of(ticks[b]), top, tall
        text(x_of(ticks[b]), top + tall + 16, ticks[b], " text-anchor=\"middle\"")
    }
    for (d = low; d <= high; d++) {
        printf "<path d=\"M%.1f %.1fh%.1f\" class=\"grid\"/>\n", left, y_of(d), wide
        text(left - 6, y_of(d) + 4, d, " text-anchor=\"end\"")
    }
}
# points of one curve, then the steps up that they make from few bytes to many
function curve(name, colour, set, label_y,   i, j, n, order, best, line, swap) {
    for (i = 1; i <= rows; i++)
        if (of[i] == set && curve_of[i] == name) order[++n] = i
    if (!n) return
    for (i = 2; i <= n; i++)
        for (j = i; j > 1 && bytes[order[j]] < bytes[order[j - 1]]; j--) {
            swap = order[j]; order[j] = order[j - 1]; order[j - 1] = swap
        }
    for (i = 1; i <= n; i++) {
        printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", x_of(bytes[order[i]]), y_of(db[order[i]]), colour
        if (line == "" || db[order[i]] > best) {
            best = db[order[i]]
            line = line (line == "" ? "M" : "L") sprintf("%.1f %.1f", x_of(bytes[order[i]]), y_of(best))
        }
    }
    printf "<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\"/>\n", line, colour
    text(left + wide - 8, top + tall - label_y, name, sprintf(" text-anchor=\"end\" fill=\"%s\"", colour))
}
function panel(set, title, x, y, a, b,   n) {
    left = x; top = y; low = a; high = b
    axes()
    text(left, top - 8, title, " class=\"title\"")
    curve("relume export", "#b35900", set, 44)
    curve("relume export, chord", "#c62828", set, 60)
    curve("prototype", "#1f5fa8", set, 28)
    curve("relight", "#3a7d2c", set, 12)
}
NR > 1 {
    rest = $0
    if (rest ~ /^"/) { name = substr(rest, 2); sub(/".*/, "", name); sub(/^"[^"]*",/, "", rest) }
    else { name = rest; sub(/,.*/, "", name); sub(/^[^,]*,/, "", rest) }
    split(rest, f, ",")
    rows++
    curve_of[rows] = name; of[rows] = f[1] " " f[6]; bytes[rows] = f[4]; db[rows] = f[5]
}
END {
    wide = 330; tall = 190
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 800 520\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<style>.box{fill:#fff;stroke:#444}.grid{stroke:#ddd}.title{font-weight:bold}</style>"
    print "<rect width=\"800\" height=\"520\" fill=\"#fff\"/>"
    panel("Single 1 and 2", "Single, Object1 and 2", 50, 30, 33, 38)
    panel("Single 3", "Single, Object3", 440, 30, 23, 31)
    panel("Multi 1 and 2", "Multi, Object1 and 2", 50, 280, 26, 30)
    panel("Multi 3", "Multi, Object3", 440, 280, 20, 26)
    text(400, 512, "bytes per pixel of all plane JPEGs; dB on 20 unseen lights", " text-anchor=\"middle\"")
    print "</svg>"
}' docs/data/web.csv >docs/pictures/web.svg
