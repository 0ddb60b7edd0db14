#!/bin/sh
# kill -9 in the middle of a render loses nothing: after a restart the job is finished, and its picture is the same bytes.
# shellcheck source-path=SCRIPTDIR disable=SC2119
. "$(dirname "$0")/service.sh"
start_service
cd "$WORK"
mesh=$(upload "$ASSETS/knot.obj")
jq -n --arg mesh "$mesh" '{scene: {objects: [{mesh: $mesh}]}, image: {width: 160, height: 120}, quality: {samples: 192}}' >scene.json

for round in 1 2 3; do
    id=$(jq --argjson seed "$round" '.seed = $seed' scene.json | curl --fail -sS --json @- "$U/v1/jobs" | jq -r .id)
    waiting=$(jq '.seed = 99 | .quality.samples = 1' scene.json | curl --fail -sS --json @- "$U/v1/jobs" | jq -r .id)
    wait_for "$id" running
    kill -9 "$SERVICE"
    wait "$SERVICE" 2>/dev/null || true
    SERVICE=
    start_service
    wait_for "$id" succeeded
    wait_for "$waiting" succeeded
    curl --fail -sS -o "after_$round.png" "$U/v1/jobs/$id/image"
    jq --argjson seed "$round" '.seed = $seed' scene.json |
        curl --fail -sS --json @- -H 'Cache-Control: no-cache' "$U/v1/jobs" | jq -r .id >undisturbed
    wait_for "$(cat undisturbed)" succeeded
    equal false "$(curl -sS "$U/v1/jobs/$(cat undisturbed)" | jq .reused)" "the undisturbed render is its own"
    curl --fail -sS -o undisturbed.png "$U/v1/jobs/$(cat undisturbed)/image"
    cmp "after_$round.png" undisturbed.png || fail "round $round: other bytes after the crash"
done
