#!/bin/sh
# Mirador and the Universal Viewer as their makers built them, without what they were built of, for
# tests/cli/test_iiif.sh: iiif-viewers.sh FOLDER
set -eu
for viewer in mirador@4.0.0 universalviewer@4.4.0; do
    to=$1/${viewer%@*}
    [ ! -e "$to" ] || continue
    rm -rf "$to.part"
    mkdir -p "$to.part"
    npm pack --silent --pack-destination "$to.part" "$viewer" >/dev/null
    tar -xzf "$to.part"/*.tgz -C "$to.part" --strip-components 1
    rm "$to.part"/*.tgz
    mv "$to.part" "$to"
done
