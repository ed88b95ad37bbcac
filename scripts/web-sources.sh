#!/bin/sh
# web-sources.sh MODULE.wasm SCRIPT <RULES: sources.txt beside a module that `make web` has made, by the rules that a compiler
# writes for make: check sums of the module, of the script that made it, and of all sources and headers of the tree
# that are in it. A test compares (tests/cli/test_build.sh), so that nobody forgets to make it again.
set -eu
{
    echo "$1"
    echo "$2"
    tr ' \\' '\n\n' | grep -E '^(web|src|include)/'
} | sort -u | xargs sha256sum >"$(dirname "$1")/sources.txt"
