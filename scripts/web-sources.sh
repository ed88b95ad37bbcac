#!/bin/sh
# web-sources.sh MODULE.wasm SCRIPT <RULES: sources.txt beside a module that `make web` has made, by the rules that a compiler
# writes for make: check sums of the module, of the script that made it, and of all sources and headers of the tree
# that are in it, without their comments and blanks, which make no other module.
# web-sources.sh --check MODULE.wasm: the files that are not as they were then; status 1 if there are any. A test asks
# (tests/cli/test_build.sh), so that nobody forgets to make it again.
set -eu

# FILE...: the check sum of each, before its name
sums() {
    for file in "$@"; do
        case $file in
        *.c | *.h) sum=$(sed 's,\(^\| \)//.*,,' "$file" | tr -d ' \n' | sha256sum) ;;
        *) sum=$(sha256sum <"$file") ;;
        esac
        echo "${sum%% *}  $file"
    done
}

if [ "$1" = --check ]; then
    list=$(dirname "$2")/sources.txt
    changed=$(sums $(sed 's/.* //' "$list") | diff - "$list" | sed -n 's/^< [0-9a-f]*  //p')
    [ -z "$changed" ] && exit
    echo "$changed"
    exit 1
fi
files=$({
    echo "$1"
    echo "$2"
    tr ' \\' '\n\n' | grep -E '^(web|src|include)/'
} | sort -u)
sums $files >"$(dirname "$1")/sources.txt"
