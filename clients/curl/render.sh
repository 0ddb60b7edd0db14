#!/bin/sh
# render.sh SCENE OUT [FILES...]: has a Heliograph service render a scene, with nothing but sh and curl.
set -eu

usage()
{
    cat <<'TEXT'
usage: render.sh SCENE OUT [FILES...]

Sends the scene (a JSON file, or - for standard input) with the files that it names (meshes, MTL, glTF buffers), waits,
and leaves the picture in OUT. A file is known to the scene by its name without folders.

environment:
  HELIOGRAPH_URL      the service (default http://127.0.0.1:8080)
  HELIOGRAPH_TIMEOUT  seconds to wait for the picture (default 600)

exit status, as of the program heliograph:
  0  OUT is the picture        1  the render failed          2  usage, or a file cannot be read or written
  3  the scene has faults      4  the service cannot be reached, or is too busy
  5  no such job, or its picture is no longer kept           6  not finished within the time; the job goes on
TEXT
}

say() { printf 'render.sh: %s\n' "$*" >&2; }
stop() { code=$1; shift; say "$*"; exit "$code"; }

# The value of a header of the last answer.
header() { tr -d '\r' <"$folder/headers" | sed -n "s/^$1: *//Ip" | tail -n 1; }

# What the service said, for people: the problem's detail and its faults where jq is there, else its text.
explain()
{
    if command -v jq >/dev/null 2>&1 && jq -e .code "$folder/answer" >/dev/null 2>&1; then
        jq -r '"\(.detail) (\(.code))", ((.errors // [])[] | "  \(.pointer): \(.detail) (\(.code))")' "$folder/answer" >&2
    elif [ -s "$folder/answer" ]; then
        head -c 4000 "$folder/answer" >&2
        echo >&2
    else
        say "HTTP $1"
    fi
}

# Ends the script unless the answer is a picture (0) or still to come (1).
judge() # STATUS
{
    case $1 in
    200) return 0 ;;
    504) return 1 ;;
    esac
    explain "$1"
    case $1 in
    400 | 413 | 415 | 422) exit 3 ;;
    404 | 410) exit 5 ;;
    429 | 503) exit 4 ;;
    *) exit 1 ;;
    esac
}

case ${1-} in
-h | --help) usage; exit 0 ;;
esac
[ $# -ge 2 ] || { usage >&2; exit 2; }
scene=$1 out=$2
shift 2
url=${HELIOGRAPH_URL:-http://127.0.0.1:8080}
url=${url%/}
timeout=${HELIOGRAPH_TIMEOUT:-600}
case $timeout in
'' | *[!0-9]*) stop 2 "HELIOGRAPH_TIMEOUT is $timeout, not whole seconds" ;;
esac

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 130' INT TERM

# A copy of the scene under a name of ours: curl reads commas, semicolons and quotes in names as its own language.
if [ "$scene" = - ]; then cat >"$folder/scene.json"; else cat -- "$scene" >"$folder/scene.json" || exit 2; fi
left=$#
while [ "$left" -gt 0 ]; do # turns the names into curl's words, in place
    file=$1
    shift
    left=$((left - 1))
    if [ ! -r "$file" ] || [ -d "$file" ]; then stop 2 "cannot read $file"; fi
    case $file in
    *[\;,\"\\]*) stop 2 "$file: curl cannot send a name with ; , \" or \\" ;;
    esac
    set -- "$@" -F "${file##*/}=@$file;type=application/octet-stream"
done

# The same key again means the same job: so a broken line may be tried again without a second render.
key=$(od -An -N16 -tx1 /dev/urandom | tr -d ' \n')
deadline=$(($(date +%s) + timeout))
fetch() # curl's words; leaves status, the answer and its headers
{
    left=$((deadline - $(date +%s)))
    [ "$left" -gt 0 ] || left=1
    curl_status=0
    status=$(curl --silent --show-error --globoff --connect-timeout 10 --max-time "$left" --retry-max-time "$left" \
        -o "$folder/answer" -D "$folder/headers" -w '%{http_code}' -H 'Accept: image/png' "$@") || curl_status=$?
    case $curl_status in
    0) ;;
    28) status=504 ;; # time is up
    *) stop 4 "no whole answer from $url (HELIOGRAPH_URL)" ;;
    esac
}

fetch --retry 5 -H 'Prefer: wait=30' -H "Idempotency-Key: $key" \
    -F "scene=@$folder/scene.json;type=application/json" "$@" "$url/v1/jobs"
job=$(header Location)
until judge "$status"; do
    [ -n "$job" ] || stop 6 "no answer within $timeout s"
    case $job in
    http://* | https://*) ;;
    *) job=$url$job ;;
    esac
    [ "$(date +%s)" -lt "$deadline" ] ||
        stop 6 "not finished within $timeout s; get it later with: curl --fail -o $out ${job%/image}/image"
    # 504 is one of the answers that --retry waits for, as long as Retry-After says.
    fetch --retry 99 "${job%/image}/image"
done

# Complete or not at all, also where OUT is on another disk.
if [ "$out" = - ]; then
    cat "$folder/answer"
elif ! { cat "$folder/answer" >"$out.part" && mv -- "$out.part" "$out"; }; then
    rm -f -- "$out.part"
    stop 2 "cannot write $out"
fi
