#!/bin/sh
# The same job is the same bytes on 1, 2 and 8 threads, in tiles of 1, 16 and 64, through the CLI and the service.
# shellcheck source-path=SCRIPTDIR disable=SC2119
. "$(dirname "$0")/service.sh"
start_service
cd "$WORK"
cp "$ASSETS/knot.obj" .
mesh=$(upload knot.obj)
echo '{"scene":{"objects":[{"mesh":"knot.obj"}]},"image":{"width":100,"height":75},"quality":{"samples":5}}' >scene.json
"$BIN/heliograph" render scene.json -o first.png
for threads in 1 2 8; do
    for tile in 1 16 64; do
        "$BIN/heliograph" render scene.json -o local.png --threads $threads --tile $tile
        cmp first.png local.png || fail "CLI, $threads threads, tiles of $tile"
        jq --arg mesh "$mesh" --argjson threads $threads --argjson tile $tile \
            '.files = {"knot.obj": $mesh} | .acceleration = {threads: $threads, tile: $tile}' scene.json |
            curl --fail -sS --json @- -H 'Cache-Control: no-cache' -H 'Prefer: wait=30' -H 'Accept: image/png' -o remote.png "$U/v1/jobs"
        cmp first.png remote.png || fail "service, $threads threads, tiles of $tile"
    done
done
