#!/bin/sh
# SIGTERM stops the service in order, a second service on the same folder is refused, and what was running goes on later.
# shellcheck source-path=SCRIPTDIR disable=SC2119
. "$(dirname "$0")/service.sh"
start_service
cd "$WORK"
equal 200 "$(curl -sS -o /dev/null -w '%{http_code}' "$HEALTH/healthz")" healthz
equal 200 "$(curl -sS -o /dev/null -w '%{http_code}' "$HEALTH/readyz")" readyz

status=0
"$BIN/heliographd" --port 0 --health-port 0 --data "$WORK/data" >second 2>second_log || status=$?
[ $status != 0 ] || fail "a second service opened the same folder"
grep -q "$WORK/data" second_log || fail "the refusal does not name the folder: $(cat second_log)"

mesh=$(upload "$ASSETS/knot.obj")
id=$(jq -n --arg mesh "$mesh" '{scene: {objects: [{mesh: $mesh}]}, image: {width: 1024, height: 1024}, quality: {samples: 4096}}' |
    curl --fail -sS --json @- "$U/v1/jobs" | jq -r .id)
wait_for "$id" running
stop_service
equal 0 "$status" "exit status after SIGTERM"
start_service
wait_for "$id" "queued|preparing|running"
curl --fail -sS -X POST "$U/v1/jobs/$id/cancel" >/dev/null
wait_for "$id" canceled
