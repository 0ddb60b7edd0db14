#!/bin/sh
# clients/curl/render.sh against a real service.
# shellcheck source-path=SCRIPTDIR disable=SC2119
. "$(dirname "$0")/service.sh"
render=$(cd "$(dirname "$0")/../../clients/curl" && pwd)/render.sh

code_of()
{
    code=0
    sh "$render" "$@" >"$WORK/out" 2>"$WORK/err" || code=$?
    echo "$code"
}

start_service
cd "$WORK"
export HELIOGRAPH_URL="$U"
mkdir "a folder"
cp "$ASSETS/knot.gltf" "$ASSETS/knot.bin" "a folder/"
echo '{"scene":{"objects":[{"mesh":"knot.gltf"}]},"image":{"width":80,"height":60},"quality":{"samples":4}}' >"a folder/scene.json"
equal 0 "$(code_of "a folder/scene.json" "out file.png" "a folder/knot.gltf" "a folder/knot.bin")" "scene with files: $(cat err)"
"$BIN/heliograph" render "a folder/scene.json" -o local.png
cmp local.png "out file.png" || fail "the script's picture differs from the local one"

echo '{"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":8,"height":8},"quality":{"samples":1}}' >sphere.json
sh "$render" - - <sphere.json >piped.png
is_png piped.png

equal 3 "$(code_of "a folder/scene.json" no.png)" "the mesh was not sent"
grep -q '/scene/objects/0/mesh' err || fail "no pointer: $(cat err)"
cp "$ASSETS/broken/nan.ply" knot.gltf
equal 3 "$(code_of "a folder/scene.json" no.png knot.gltf)" "a mesh with a fault: $(cat err)"
equal 2 "$(code_of sphere.json)" "no output named"
equal 2 "$(code_of absent.json no.png)" "no scene"
equal 2 "$(code_of sphere.json no.png absent.obj)" "no mesh"
equal 2 "$(code_of sphere.json absent/no.png)" "no folder for the picture"
echo '{"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":800,"height":600},"quality":{"samples":60000}}' >long.json
export HELIOGRAPH_TIMEOUT=3
equal 6 "$(code_of long.json no.png)" "not finished in time: $(cat err)"
[ ! -e no.png ] || fail "there is a picture of nothing"
stop_service
equal 4 "$(code_of sphere.json no.png)" "no service"
