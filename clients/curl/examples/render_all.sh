#!/bin/sh
# render_all.sh FOLDER [heliograph render options]: every scene of this folder as FOLDER/NAME.png, by the program
# heliograph of the PATH, or the one that HELIOGRAPH names. Meshes and pictures that the scenes name are those that the
# build makes: build/release/assets, or the folder that HELIOGRAPH_ASSETS names.
set -eu
[ $# -ge 1 ] || { echo "usage: render_all.sh FOLDER [heliograph render options]" >&2; exit 2; }
folder=$1
shift
here=$(cd "$(dirname "$0")" && pwd)
assets=${HELIOGRAPH_ASSETS:-$here/../../../build/release/assets}
[ -d "$assets" ] || { echo "render_all.sh: no assets in $assets: ./dev build makes them" >&2; exit 1; }
mkdir -p "$folder"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$here"/*.json "$assets"/knot.obj "$assets"/box.obj "$assets"/box.mtl "$assets"/checker.png "$work"
for scene in "$work"/*.json; do
    name=$(basename "$scene" .json)
    "${HELIOGRAPH:-heliograph}" render "$scene" -o "$folder/$name.png" "$@"
    echo "$folder/$name.png"
done
