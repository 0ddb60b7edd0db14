#!/bin/sh
# render_all.sh FOLDER [heliograph render options]: every scene of this folder as FOLDER/NAME.png, by the program
# heliograph of the PATH, or the one that HELIOGRAPH names.
set -eu
[ $# -ge 1 ] || { echo "usage: render_all.sh FOLDER [heliograph render options]" >&2; exit 2; }
folder=$1
shift
mkdir -p "$folder"
for scene in "$(dirname "$0")"/*.json; do
    name=$(basename "$scene" .json)
    "${HELIOGRAPH:-heliograph}" render "$scene" -o "$folder/$name.png" "$@"
    echo "$folder/$name.png"
done
