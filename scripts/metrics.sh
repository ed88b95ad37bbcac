#!/bin/sh
# Print docs/measurements/house.md, the sources in numbers: metrics.sh BUILD. Symbols come from what BUILD holds,
# the rest from the tree. --small, --copies, --without-comment, --structs and, with BUILD, --state, --arrows and
# --inside list what is counted. Functions are recognised by the layout that clang-format gives them: the name at
# the left, a brace alone on a line at either end.
set -eu
cd "$(dirname "$0")/.."
wings="core image capture format relight material encode exchange shape world site"

sources() { find src viewer \( -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.glsl' \) | LC_ALL=C sort; }
programs() { find src viewer \( -name '*.c' -o -name '*.cpp' \) | LC_ALL=C sort; }

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
    END { close_file() }' $(programs)
}

# Bodies of functions, of 3 lines or more, that stand in the sources twice to the letter: the second of each.
copies() {
    awk '
    FNR == 1 { inside = 0 }
    /^[a-z].*\(/ && !/[;=]/ {
        name = $0
        sub(/\(.*/, "", name)
        sub(/.*[ *]/, "", name)
    }
    /^\}/ && inside {
        if (lines > 2 && body in first)
            print FILENAME ": " name " is " first[body]
        else if (lines > 2)
            first[body] = FILENAME ": " name
        inside = 0
    }
    inside {
        body = body $0 "\n"
        lines++
    }
    /^\{$/ {
        inside = 1
        body = ""
        lines = 0
    }' $(programs)
}

# Members of every struct, declarators counted one by one, those of structs inside included: MEMBERS FILE: NAME.
structs() {
    awk '
    /^(static |const |typedef )*struct [a-z_0-9]+ \{$/ {
        name = $0
        sub(/.*struct /, "", name)
        sub(/ .*/, "", name)
        members = 0
        next
    }
    /^\}/ && name != "" {
        print members, FILENAME ": " name
        name = ""
    }
    name != "" {
        text = $0
        sub(/\/\/.*/, "", text)
        while (gsub(/\([^()]*\)|\[[^][]*\]/, "", text))
            ;
        members += gsub(/[,;]/, "", text)
    }' $(sources | grep -v '[.]glsl$') | sort -k1,1nr -k2
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

# Variables that are neither constant nor of one call, in the objects of the sources: FILE: NAME. What only the
# linker fills in (.data.rel.ro) is constant.
state() {
    programs | while read -r source; do
        object=$1/obj/${source%.*}.o
        [ ! -f "$object" ] || echo "$object"
    done | xargs objdump -t | awk -v skip="$1/obj/" '
        /file format/ {
            file = substr($1, length(skip) + 1)
            sub(/[.]o:$/, "", file)
        }
        / O [.]t?(bss|data)([.][^r][^[:space:]]*)?[[:space:]]/ && $NF !~ /^_ZGV/ {
            name = $NF
            sub(/[.][0-9]+$/, "", name)
            sub(/^_Z.*[0-9]/, "", name)  # the last part of a name of C++
            print file ": " name
        }' | LC_ALL=C sort -u
}

# Symbols that objects of a wing take from a wing above: WING/FILE takes SYMBOL of WING/FILE.
arrows() {
    nm -A --format=posix $(find "$1"/obj/src -name '*.o' ! -path '*/obj/src/cli/*') 2>/dev/null |
        sed "s|^$1/obj/src/||; s|[.]o: | |" |
        awk -v wings="$wings" '
        BEGIN {
            n = split(wings, order, " ")
            for (i = 1; i <= n; i++)
                number[order[i]] = i
        }
        function wing(file) {
            sub("/.*", "", file)
            return number[file]
        }
        $3 ~ /^[TDBRVW]$/ { home[$2] = $1 }
        $3 == "U" { wants[++m] = $1 " " $2 }
        END {
            for (i = 1; i <= m; i++) {
                split(wants[i], w, " ")
                if (w[2] in home && wing(home[w[2]]) > wing(w[1]))
                    print w[1] " takes " w[2] " of " home[w[2]]
            }
        }' | LC_ALL=C sort
}

# Functions of public headers, by name
declared() { # headers...
    cat "$@" | awk '/^RELUME_(API|RESULT)/ { on = 1; text = "" } on { text = text " " $0 } on && /;/ {
        if (match(text, /[a-z_0-9]+\(/))
            print substr(text, RSTART, RLENGTH - 1)
        on = 0
    }' | LC_ALL=C sort -u
}
core_headers() { find include/relume -maxdepth 1 -name '*.h' | LC_ALL=C sort; }
extension_headers() { find include/relume -mindepth 2 -name '*.h' | LC_ALL=C sort; }
# Functions that the shared library exports beside those of public headers
inside() { # BUILD
    known=$(mktemp)
    declared $(core_headers) $(extension_headers) >"$known"
    nm -D --defined-only "$1/librelume.so" | awk '$2 == "T" { print $3 }' | LC_ALL=C sort -u | grep -vxF -f "$known" || true
    rm -f "$known"
}

case ${1:-} in
--small) small_once; exit ;;
--copies) copies; exit ;;
--structs) structs; exit ;;
--without-comment) without_comment; exit ;;
--state) state "$2"; exit ;;
--arrows) arrows "$2"; exit ;;
--inside) inside "$2"; exit ;;
esac

build=${1:?metrics: expected a folder that make has filled}
[ -f "$build/librelume.so" ] || { echo "metrics: $build/librelume.so is not there; run make first" >&2; exit 1; }
lines() { xargs -r cat | wc -l; }
count() { wc -l | tr -d ' '; }
commit=$(git log -1 --format='%h of %cs' 2>/dev/null || echo 'no commit')
cat <<END
<!-- kind: measurement -->
# The house in numbers

Made by \`make metrics\` from commit $commit; do not edit. [Building and testing](building.md) has what is
measured with a clock.

| measure | now |
|---|---|
| wings, beside the programs | $(echo $wings | wc -w) |
| rooms of the wings | $(for w in $wings; do find "src/$w" -mindepth 1 -maxdepth 1 -type d; done | count) |
| arrows up, by symbols (\`scripts/metrics.sh --arrows build\`) | $(arrows "$build" | count) |
| include loops between files | $(scripts/layers.sh 2>&1 | grep -c 'include each other' || true) |
| public functions: core, $(core_headers | count) headers | $(declared $(core_headers) | count) |
| public functions: extensions, $(extension_headers | count) headers | $(declared $(extension_headers) | count) |
| functions inside that \`librelume.so\` exports (\`--inside build\`) | $(inside "$build" | count) |
| ... of which do not begin with \`relume_\` | $(inside "$build" | grep -vc '^relume_' || true) |
| public declarations without a comment (\`--without-comment\`) | $(without_comment | count) |
| static functions of at most 8 lines, called once (\`--small\`) | $(small_once | count) |
| bodies of functions that stand twice (\`--copies\`) | $(copies | count) |
| variables that outlive a call ([listed with reasons](../architecture.md#state-of-the-process)) | $(state "$build" | count) |
| fuzz targets | $(find tests/fuzz -name 'fuzz_*.c' | count) |
| commands | $("$build/relume" --help | grep -c '^  [a-z]') |
| lines of src and viewer (.c .h .cpp .glsl) | $(sources | lines) |

| lines of | files | lines |
|---|---|---|
$({
    for w in $wings cli; do echo "src/$w"; done
    echo viewer
} | while read -r folder; do
    echo "| $folder | $(sources | grep -c "^$folder/") | $(sources | grep "^$folder/" | lines) |"
done)
| include | $(core_headers | count) + $(extension_headers | count) | $({ core_headers; extension_headers; } | lines) |
| web (.js .css) | $(find web -name '*.js' -o -name '*.css' | count) | $(find web -name '*.js' -o -name '*.css' | lines) |
| tests (.c .h .sh) | $(find tests -name '*.[ch]' -o -name '*.sh' | count) | $(find tests -name '*.[ch]' -o -name '*.sh' | lines) |

| largest structs | members |
|---|---|
$(structs | sed 's/^\([0-9]*\) \(.*\): \(.*\)/| `\3` (\2) | \1 |/' | head -n 12)
END
