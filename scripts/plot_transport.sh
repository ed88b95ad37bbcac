#!/bin/sh
# Draws docs/data/transport.csv as docs/pictures/transport-growth.svg: processor time of ism over its
# lights, the points of a map and triangles (FOLDER/growth.csv of bench_transport FOLDER), and of
# one small picture of micro over points of a tree (1000 over the rates that bench_micro prints);
# both axes logarithmic, and a line of proportion.
set -eu
cd "$(dirname "$0")/.."
awk -F, '
function text(x, y, s, more) { printf "<text x=\"%.1f\" y=\"%.1f\"%s>%s</text>\n", x, y, more, s }
function x_of(v) { return left + (log(v) - log(least[p])) / (log(most[p]) - log(least[p])) * wide }
function y_of(v) { return top + (log(high) - log(v)) / (log(high) - log(low)) * tall }
function line(name, colour, dots,   i, d) {
    for (i = 1; i <= rows; i++)
        if (of[i] == panel[p] && what[i] == name) {
            d = d (d == "" ? "M" : "L") sprintf("%.1f %.1f", x_of(size[i]), y_of(ms[i]))
            printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.5\" fill=\"%s\"/>\n", x_of(size[i]), y_of(ms[i]), colour
        }
    printf "<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\"/>\n", d, colour
}
function number(v) { return v >= 1048000 ? sprintf("%.3gM", v / 1e6) : v >= 10000 ? sprintf("%.0fk", v / 1e3) : v }
NR > 1 {
    rows++
    of[rows] = $1; size[rows] = $2; what[rows] = $3; ms[rows] = $4
    if (!($1 in most) || $2 > most[$1]) most[$1] = $2
    if (!($1 in least) || $2 < least[$1]) least[$1] = $2
}
END {
    wide = 175; tall = 190; top = 40
    panels = split("lights,points of a map,triangles,points of a tree", panel, ",")
    kinds = split("all,maps,exact shadows,8 x 8,24 x 24", kind, ","); split("ism,ism: its maps,exact shadows,micro 8 x 8,micro 24 x 24", label, ",")
    split("#1f5fa8,#3a7d2c,#b35900,#7a3d9c,#a8322d", colour, ",")
    for (p = 1; p <= panels; p++) { most[p] = most[panel[p]]; least[p] = least[panel[p]] }
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 950 300\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<style>.box{fill:#fff;stroke:#444}.grid{stroke:#ddd}.even{stroke:#999;stroke-dasharray:4 4}.title{font-weight:bold}</style>"
    print "<rect width=\"950\" height=\"300\" fill=\"#fff\"/>"
    for (p = 1; p <= panels; p++) {
        left = 60 + (p - 1) * (wide + 48)
        high = p == 4 ? 1 : 10000; low = p == 4 ? 0.01 : 10
        printf "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" class=\"box\"/>\n", left, top, wide, tall
        for (d = low; d <= high * 1.01; d *= 10) {
            printf "<path d=\"M%.1f %.1fh%.1f\" class=\"grid\"/>\n", left, y_of(d), wide
            text(left - 6, y_of(d) + 4, d, " text-anchor=\"end\"")
        }
        # in proportion, from the lower left
        end = low * most[p] / least[p]
        if (end > high) printf "<path d=\"M%.1f %.1fL%.1f %.1f\" class=\"even\"/>\n", left, top + tall, x_of(least[p] * high / low), top
        else printf "<path d=\"M%.1f %.1fL%.1f %.1f\" class=\"even\"/>\n", left, top + tall, left + wide, y_of(end)
        for (k = 1; k <= kinds; k++) line(kind[k], colour[k])
        text(left, top + tall + 15, number(least[p]), "")
        text(left + wide, top + tall + 15, number(most[p]), " text-anchor=\"end\"")
        text(left + wide / 2, top - 10, panel[p], " text-anchor=\"middle\" class=\"title\"")
    }
    printf "<text transform=\"translate(16 %.1f) rotate(-90)\" text-anchor=\"middle\" class=\"title\">milliseconds of a core</text>\n", top + tall / 2
    for (k = 1; k <= kinds; k++) text(130 * k - 60, 285, label[k], sprintf(" fill=\"%s\"", colour[k]))
    text(130 * k - 60, 285, "in proportion (dashed)", " fill=\"#777\"")
    print "</svg>"
}' docs/data/transport.csv >docs/pictures/transport-growth.svg
