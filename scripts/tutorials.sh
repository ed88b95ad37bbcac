#!/bin/sh
# The tutorials of docs/tutorials, word for word: every fenced sh block of one, run in this folder.
#   tutorials.sh NAME                 run docs/tutorials/NAME.md here
#   tutorials.sh pictures BUILD OUT   run all in temporary folders and make their pictures in OUT
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)

run() { # name: the blocks, each stopping at its first error
    awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' "$top/docs/tutorials/$1.md" >tutorial.sh
    [ -s tutorial.sh ]
    sh -e tutorial.sh
}
strip() { # name, pictures: side by side, 250 pixels high
    name=$1
    shift
    convert "$@" -resize x250 -bordercolor white -border 2 +append -quality 88 "$out/tutorial-$name.jpg"
}

if [ "$1" != pictures ]; then
    run "$1"
    exit
fi
PATH=$(cd "$2" && pwd):$(cd "$2" && pwd)/samples:$top/samples:$PATH
out=$(cd "$3" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for name in photographs lightfield material; do
    mkdir "$work/$name"
    cd "$work/$name"
    run $name
    case $name in
    photographs) strip photographs photos/photo04.jpg photos/photo19.jpg raking.png two.png normals.png ;;
    lightfield) strip lightfield middle.png upper-left.png near.png far.png ;;
    material) strip material grain.png side.png ring.png lamp.png ;;
    esac
done
