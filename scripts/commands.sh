#!/bin/sh
# Write the table of commands into docs/user-guide.md, between its two marks, as PROGRAM --help lists them:
# commands.sh PROGRAM. --print shows the table alone.
set -eu
table() {
    echo '| command | |'
    echo '|---|---|'
    "$1" --help | sed -n 's/^  \([a-z]*\)  *\(.*\)/| `\1` | \2 |/p'
    echo '| `relume-view` | show files in a window and edit what they show |'
}
if [ "${1:-}" = --print ]; then
    table "$2"
    exit
fi
page=$(dirname "$0")/../docs/user-guide.md
made=$(mktemp)
trap 'rm -f "$made"' EXIT
table "$1" >"$made"
sed -i -e "/^<!-- commands/r $made" -e '/^<!-- commands/,/^<!-- end/{/^|/d}' "$page"
