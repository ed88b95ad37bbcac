#!/bin/sh
# Files that every site holds, as one C file: embed-web.sh NAME=FILE... > assets.c
set -eu
echo '#include "site/publish/assets.h"'
n=0
table=
for pair in "$@"; do
    n=$((n + 1))
    echo "static const unsigned char file_$n[] = {"
    od -An -v -tu1 "${pair#*=}" | sed 's/^ *//; s/  */,/g; s/$/,/'
    echo '};'
    table="$table    {\"${pair%%=*}\", file_$n, sizeof file_$n},
"
done
printf 'const struct asset site_assets[] = {\n%s    {0, 0, 0},\n};\n' "$table"
