#!/bin/sh
# The sources in numbers (make metrics): one `name value` a line. --small and --without-comment list
# what is counted. Functions are recognised by the layout that clang-format gives them: the name at
# the left, a brace alone on a line at either end.
set -eu
cd "$(dirname "$0")/.."

sources() { find src viewer \( -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.glsl' \) | LC_ALL=C sort; }

# Static functions of at most 8 lines, from the name to the brace, that their file calls once, and names nowhere else.
small_once() {
    awk '
    function close_file(name) {
        for (name in lines)
            if (lines[name] <= 8 && said[name] == 2 && called[name] == 2)
                print where[name] ": " name
        split("", lines)
        split("", said)
        split("", called)
        split("", where)
        inside = 0
    }
    FNR == 1 && NR > 1 { close_file() }
    {
        text = $0
        gsub(/"([^"\\]|\\.)*"/, "", text)
        sub(/\/\/.*/, "", text)
        while (match(text, /[A-Za-z_][A-Za-z_0-9]*/)) {
            word = substr(text, RSTART, RLENGTH)
            text = substr(text, RSTART + RLENGTH)
            said[word]++
            called[word] += text ~ /^\(/
        }
    }
    /^static / { begun = FNR }
    /^static / && /\(/ && !/[;=]/ {
        name = $0
        sub(/\(.*/, "", name)
        sub(/.*[ *]/, "", name)
    }
    /^[a-z].*\(/ && !/^static / { name = "" }
    /^\{$/ { inside = 1 }
    /^\}$/ && inside {
        if (name != "") {
            lines[name] = FNR - begun + 1
            where[name] = FILENAME
        }
        name = ""
        inside = 0
    }
    END { close_file() }' $(find src viewer -name '*.c' -o -name '*.cpp')
}

# Functions and types of the public headers without a comment on the lines before them; a line that
# follows another declaration without a gap shares its comment.
without_comment() {
    awk '
    FNR == 1 { said = 0; within = 0 }
    /^\/\// { said = 1 }
    /^$/ { said = 0 }
    # what a brace or a parenthesis holds open is part of what began before it
    !within && /^(RELUME_API|struct [a-z_]+ \{|enum [a-z_]+ \{|typedef )/ && !said && !/\/\// {
        print FILENAME ": " $0
    }
    /^[^ ].*\{$/ { within = 1 }
    /^\}/ { within = 0 }' $(find include/relume -name "*.h" | LC_ALL=C sort)
}

largest() {
    find src viewer -type d | while read -r folder; do
        echo "$(find "$folder" -maxdepth 1 -type f | wc -l) $folder"
    done | sort -rn | head -n 1
}

case ${1:-} in
--small) small_once; exit ;;
--without-comment) without_comment; exit ;;
esac
echo "lines $(sources | xargs cat | wc -l)"
echo "small_static_functions_called_once $(small_once | wc -l)"
echo "loops_of_files $(scripts/layers.sh 2>&1 | grep -c 'include each other' || true)"
echo "largest_folder $(largest)"
echo "public_declarations_without_comment $(without_comment | wc -l)"
