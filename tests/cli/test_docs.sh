#!/bin/sh
# What docs/ promises exists: every option it names, every file and heading it links to, every relume.* attribute
# that the code writes and no other.
. "$(dirname "$0")/lib.sh"
docs="$TOP/docs"

{
    "$VIEWER" --help
    for c in $("$RELUME" --help | sed -n 's/^  \([a-z]*\) .*/\1/p'); do "$RELUME" "$c" --help; done
    for c in bench btf maps mesh study; do
        for t in $("$RELUME" "$c" --help | sed -n '/^tasks;/,/^$/s/^  \([a-z]*\) .*/\1/p'); do "$RELUME" "$c" "$t" --help; done
    done
} | grep -o -e '--[a-z-]*' | sort -u >known.txt
# options of other programs that the texts use, a mistake that they show, and old spellings
printf '%s\n' --cflags --libs --static --info --version --rm --entrypoint --user --userns --lihgt --table --hdr --slab --panorama --no-build-isolation \
    --coverage --arrows --copies --inside --small --state --without-comment \
    --nearest >>known.txt
# anchors of a page: its headings as web pages of Git hosts name them, once each, and its own <a id>
anchors() { grep '^#' "$1" | sed 's/^#* //' | tr 'A-Z' 'a-z' | sed 's/\[\([^]]*\)\]([^)]*)/\1/g; s/[^a-z0-9 _-]//g; s/ /-/g'
    sed -n 's/.*<a id="\([^"]*\)">.*/\1/p' "$1"; }
for page in "$docs"/*.md "$docs"/*/*.md "$TOP/README.md"; do
    text=${page#"$docs"/} folder=$(dirname "$page")
    unknown=$(grep -o -e '\(^\|[^a-z-]\)--[a-z][a-z-]*' "$page" | sed 's/^[^-]*//' | sort -u |
        grep -v -e '-$' | grep -vxF -f known.txt | tr '\n' ' ')
    if [ -z "$unknown" ]; then ok "$text names options that exist"; else
        not_ok "$text names options that exist" "unknown: $unknown"
    fi
    broken=
    for target in $(grep -o ']([^)]*' "$page" | sed 's/^](//' | grep -v '^http' | sort -u); do
        file=$folder/${target%%#*}
        [ "${target%%#*}" ] || file=$page
        case $target in
        *'#'*) [ -f "$file" ] && anchors "$file" | grep -qxF -e "${target#*#}" || broken="$broken $target" ;;
        *) [ -e "$file" ] || broken="$broken $target" ;;
        esac
    done
    if [ -z "$broken" ]; then ok "$text links to what exists"; else not_ok "$text links to what exists" "broken:$broken"; fi
done

# ... and every option that the help lists is explained.
grep -ohE -e '--[a-z][a-z-]*' "$docs"/*.md "$docs"/*/*.md | sort -u >explained.txt
untold=$({
    "$VIEWER" --help
    for c in $("$RELUME" --help | sed -n 's/^  \([a-z]*\) .*/\1/p'); do "$RELUME" "$c" --help; done
} | sed -n 's/^  \(--[a-z-]*\) .*/\1/p' | sort -u | grep -vxF -f explained.txt | tr '\n' ' ')
if [ -z "$untold" ]; then ok 'docs explain every option'; else not_ok 'docs explain every option' "none of: $untold"; fi

# Pages about the program itself are made of it.
"$TOP/scripts/commands.sh" --print "$RELUME" >commands.txt
sed -n '/^<!-- commands/,/^<!-- end/p' "$docs/user-guide.md" | sed '1d;$d' >documented.txt
same "user-guide.md lists the commands of --help (scripts/commands.sh build/relume writes them)" commands.txt documented.txt
fuzzed=$(sed -n 's/^| \(fuzz_[a-z]*\) .*/\1/p' "$docs/reliability.md" | sort)
check "reliability.md has a row for every fuzz target" \
    test "$fuzzed" = "$(cd "$TOP/tests/fuzz" && ls fuzz_*.c | sed 's/[.]c$//' | sort)"

grep -o '"relume\.[a-z]*"' "$TOP/src/format/pack/format.h" | tr -d '"' | sort -u >written.txt
grep -o '^| `relume\.[a-z]*`' "$docs/format.md" | tr -d '|` ' | sort -u >documented.txt
same "format.md has every attribute and no other" written.txt documented.txt

# A stranger who opens a file reads first what it is: "// name.c - ..." in the program, a sentence in
# tests.
untitled=$(cd "$TOP" && find src viewer samples -name '*.c' -o -name '*.cpp' | while read -r f; do
    case $(head -n 1 "$f") in "// $(basename "$f") - "?*) ;; *) echo "$f" ;; esac
done)
untitled="$untitled$(cd "$TOP" && find tests -name '*.c' | while read -r f; do
    case $(head -n 1 "$f") in '// '?*) ;; *) echo "$f" ;; esac
done)"
if [ -z "$untitled" ]; then ok 'every .c opens with what it is'; else
    not_ok 'every .c opens with what it is' "$(echo $untitled)"
fi

folders=$(sed -n '/^## Layout/,/^## Who/p' "$docs/architecture.md" | sed -n 's|^  \([a-z_/]*\)/ .*|\1|p' | sort)
check "architecture.md has every folder of src and viewer" \
    test "$folders" = "$(cd "$TOP" && find src viewer -mindepth 1 -type d ! -path 'viewer/shaders/*' | cut -d/ -f2- | sort)"
finish
