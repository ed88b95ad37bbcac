#!/bin/sh
# Draws docs/data/growth.csv (tests/bench/growth.sh) as docs/pictures/growth.svg: time, memory and bytes
# over pixels, lights, views and coefficients, all axes logarithmic; a line for each command.
set -eu
cd "$(dirname "$0")/.."
awk -F, '
function text(x, y, s, more) { printf "<text x=\"%.1f\" y=\"%.1f\"%s>%s</text>\n", x, y, more, s }
function x_of(v) { return left + (log(v) - log(least_x)) / (log(most_x) - log(least_x)) * wide }
function y_of(v) { return top + (log(high) - log(v)) / (log(high) - log(low)) * tall }
function widen(v, m) { if (!most[m] || v < least[m]) least[m] = v; if (v > most[m]) most[m] = v }
function axes(   i, d) {
    printf "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" class=\"box\"/>\n", left, top, wide, tall
    for (d = 10 ^ int(log(low) / log(10) - 1); d <= high; d *= 10)
        if (d >= low) {
            printf "<path d=\"M%.1f %.1fh%.1f\" class=\"grid\"/>\n", left, y_of(d), wide
            text(left - 6, y_of(d) + 4, d + 0, " text-anchor=\"end\"")
        }
}
function panel(g, m,   i, c, n, x, line, last) {
    left = 70 + (g - 1) * (wide + 50); top = 40 + (m - 1) * (tall + 24)
    least_x = 1e30; most_x = 0; low = least[m] / 1.5; high = most[m] * 1.5
    for (i = 1; i <= rows; i++)
        if (of[i] == growth[g]) { if (size[i] < least_x) least_x = size[i]; if (size[i] > most_x) most_x = size[i] }
    axes()
    for (c = 1; c <= commands; c++) {
        line = ""; last = ""
        for (i = 1; i <= rows; i++)
            if (of[i] == growth[g] && command[i] == name[c] && !(m == 3 && name[c] == "relight")) {
                x = x_of(size[i])
                printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.5\" fill=\"%s\"/>\n", x, y_of(value[i, m]), colour[c]
                line = line (line == "" ? "M" : "L") sprintf("%.1f %.1f", x, y_of(value[i, m]))
            }
        printf "<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\"/>\n", line, colour[c]
    }
    if (m == 3)
        for (i = 1; i <= rows; i++)
            if (of[i] == growth[g] && command[i] == "encode")
                text(x_of(size[i]), top + tall + 15, g == 1 ? sprintf("%dK", size[i] / 1024) : size[i], " text-anchor=\"middle\"")
    if (m == 1) text(left + wide / 2, top - 10, growth[g], " text-anchor=\"middle\" class=\"title\"")
    if (g == 1) printf "<text transform=\"translate(18 %.1f) rotate(-90)\" text-anchor=\"middle\" class=\"title\">%s</text>\n", top + tall / 2, measure[m]
}
NR > 1 {
    rows++
    of[rows] = $1; size[rows] = $2; command[rows] = $3
    for (m = 1; m <= 3; m++) { value[rows, m] = $(3 + m); widen($(3 + m), m) }
}
END {
    wide = 170; tall = 120
    split("pixels lights views coefficients", growth, " ")
    split("seconds of one core,memory in MB,file in MB", measure, ",")
    commands = split("encode,relight,encode --psnr 36", name, ",")
    split("#1f5fa8,#3a7d2c,#b35900", colour, ",")
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 930 520\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<style>.box{fill:#fff;stroke:#444}.grid{stroke:#ddd}.title{font-weight:bold}</style>"
    print "<rect width=\"930\" height=\"520\" fill=\"#fff\"/>"
    for (m = 1; m <= 3; m++)
        for (g = 1; g <= 4; g++) panel(g, m)
    for (c = 1; c <= commands; c++)
        text(300 + 130 * c, 510, name[c], sprintf(" text-anchor=\"end\" fill=\"%s\"", colour[c]))
    print "</svg>"
}' docs/data/growth.csv >docs/pictures/growth.svg
