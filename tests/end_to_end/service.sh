# Sourced by the tests of this folder: starts and stops a real heliographd in a folder of its own.
#
# Wants BIN (folder of the programs) and ASSETS (generated meshes) in the environment. Everything lies below $WORK, which is
# removed at the end. A check that fails prints what it saw and ends the test.
# shellcheck shell=sh disable=SC2034
set -eu
WORK=$(mktemp -d)
SERVICE=
trap 'stop_service; rm -rf "$WORK"' EXIT

fail()
{
    echo "FAILED: $*" >&2
    [ ! -f "$WORK/log" ] || { echo "--- end of the service's log:" >&2; tail -n 20 "$WORK/log" >&2; }
    exit 1
}

equal() # WANTED SEEN WHAT
{
    [ "$1" = "$2" ] || fail "$3: wanted '$1', saw '$2'"
}

is_png() # FILE
{
    equal 89504e470d0a1a0a "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" "first bytes of $1"
}

start_service() # [OPTIONS...]: on $PORT, else on a free one; sets U and HEALTH
{
    : >"$WORK/ready" # here, not by the child: what an earlier service said must be gone before the first look
    "$BIN/heliographd" --port "${PORT:-0}" --health-port 0 --data "$WORK/data" "$@" >"$WORK/ready" 2>>"$WORK/log" &
    SERVICE=$!
    tries=0
    until grep -q http "$WORK/ready"; do
        tries=$((tries + 1))
        { kill -0 "$SERVICE" 2>/dev/null && [ $tries -lt 300 ]; } || fail "the service did not come up"
        sleep 0.05
    done
    U=$(grep -o 'http://[0-9.:]*' "$WORK/ready" | head -n 1)
    HEALTH=$(grep -o 'http://[0-9.:]*' "$WORK/ready" | tail -n 1)
}

stop_service()
{
    [ -n "$SERVICE" ] || return 0
    kill "$SERVICE" 2>/dev/null || true
    status=0
    wait "$SERVICE" 2>/dev/null || status=$?
    SERVICE=
}

digest_of() # FILE
{
    echo "sha256:$(sha256sum "$1" | cut -d' ' -f1)"
}

upload() # FILE: prints its digest
{
    curl --fail -sS -T "$1" "$U/v1/assets/$(digest_of "$1")" >/dev/null
    digest_of "$1"
}

wait_for() # ID STATES (a grep -E pattern): until the job is in one of them
{
    tries=0
    until curl --fail -sS -H 'Prefer: wait=5' "$U/v1/jobs/$1" | jq -r .state | grep -qE "^($2)\$"; do
        tries=$((tries + 1))
        [ $tries -lt 600 ] || fail "job $1 did not become $2"
        sleep 0.05
    done
}
