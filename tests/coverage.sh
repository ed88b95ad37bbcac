#!/bin/sh
# Print which share of the lines of src and viewer has run, by wing, from what config=coverage left:
# coverage.sh BUILD. A line counts in the file that is compiled, so that inline functions count once; gcov knows
# files by the names that the compiler got.
set -eu
build=$1
cd "$(dirname "$0")/.."
find "$build/obj/src" "$build/obj/viewer" -name '*.gcno' | LC_ALL=C sort | while read -r notes; do
    source=${notes#"$build/obj/"}
    gcov -n "$notes" 2>/dev/null | awk -v name="${source%.gcno}" '
        /^File / { own = index($0, "\047" name ".c") == 6 }
        own && /^Lines executed:/ {
            sub("%", "", $0)
            split($2, part, ":")
            print name, $4, part[2] * $4 / 100
            exit
        }'
done | awk '
    {
        split($1, path, "/")
        folder = path[1] == "src" ? path[1] "/" path[2] : path[1]
        lines[folder] += $2
        run[folder] += $3
        all += $2
        hit += $3
    }
    END {
        for (f in lines)
            printf "%-14s %6d lines %5.1f %%\n", f, lines[f], 100 * run[f] / lines[f] | "sort"
        close("sort")
        printf "%-14s %6d lines %5.2f %%\n", "all", all, 100 * hit / (all ? all : 1)
    }'
