#!/bin/sh
# The lines of the README and the five curl lines of the contract do what they say.
# shellcheck source-path=SCRIPTDIR disable=SC2119
. "$(dirname "$0")/service.sh"
README=$(cd "$(dirname "$0")/../.." && pwd)/README.md
start_service
cd "$WORK"
cp "$ASSETS/knot.obj" .

# The README's own lines, pasted: only the address is ours, and the picture is small.
sed -n '/^U=http/,/^```$/p' "$README" | sed '1d;$d;s/{"scene":/{"image":{"width":96,"height":64},"scene":/' >readme.sh
grep -q /image readme.sh || fail "the README's lines are no longer found"
cp knot.obj bunny.obj
U=$U sh -eu readme.sh >readme.out 2>&1 || fail "the README's lines: $(cat readme.out)"
is_png out.png
# Without `files` there is no id, and the same line says why.
submit=$(grep '^id=' readme.sh | sed 's/job\.json/scene.json/')
! U=$U sh -euc "$submit" >readme.out 2>&1 || fail "a scene without files gave an id"
grep -q missing_asset readme.out || fail "no word of the missing file: $(cat readme.out)"

mesh=$(upload knot.obj)
jq -n --arg mesh "$mesh" '{scene: {objects: [{mesh: "knot.obj"}]}, files: {"knot.obj": $mesh},
    image: {width: 96, height: 64}, quality: {samples: 4}}' >scene.json

curl --fail -sS --json @scene.json -H 'Prefer: wait=30' -H 'Accept: image/png' -o json.png "$U/v1/jobs"
is_png json.png

jq 'del(.files)' scene.json >bare.json
curl --fail -sS -F scene=@bare.json -F knot.obj=@knot.obj -H 'Prefer: wait=30' -H 'Accept: image/png' -o multipart.png "$U/v1/jobs"
cmp json.png multipart.png || fail "multipart gave another picture"

id=$(curl -s --json @scene.json "$U/v1/jobs" | jq -r .id)
curl --fail -sS --retry 99 --retry-delay 1 -o fetched.png "$U/v1/jobs/$id/image"
cmp json.png fetched.png || fail "the fetched picture is another"

equal 200 "$(curl -sS -o /dev/null -w '%{http_code}' -T knot.obj "$U/v1/assets/sha256:$(sha256sum knot.obj | cut -d' ' -f1)")" "a second upload"

# The same film in every format, by GET and as the answer to a POST.
for format in jpeg:ffd8ffe0 vnd.radiance:233f5241 x-exr:762f3101 x-portable-floatmap:50460a39; do
    type=image/${format%%:*}
    curl --fail -sS -H "Accept: $type" -o got "$U/v1/jobs/$id/image"
    equal "${format##*:}" "$(od -An -tx1 -N4 got | tr -d ' ')" "the first bytes of $type"
    curl --fail -sS --json @scene.json -H 'Prefer: wait=30' -H "Accept: $type" -o posted "$U/v1/jobs"
    cmp got posted || fail "$type as the answer to a POST is another file"
done
curl --fail -sS -o deep.png "$U/v1/jobs/$id/image?bits=16"
is_png deep.png
equal 10 "$(od -An -tx1 -j24 -N1 deep.png | tr -d ' ')" "bits a channel"
equal 406 "$(curl -sS -o answer -w '%{http_code}' -H 'Accept: image/webp' "$U/v1/jobs/$id/image")" "a format that is not written"

# Layers beside it, by the links of the job object.
layered=$(jq '.image.layers = ["depth", "normal"]' scene.json |
    curl --fail -sS --json @- -H 'Prefer: wait=30' "$U/v1/jobs" | jq -r .id)
depth=$(curl -sS "$U/v1/jobs/$layered" | jq -r .links.layers.depth)
curl --fail -sS -o depth.exr "$U$depth"
equal 762f3101 "$(od -An -tx1 -N4 depth.exr | tr -d ' ')" "the first bytes of a layer"
curl --fail -sS -H 'Accept: image/png' -o normal.png "$U/v1/jobs/$layered/layers/normal"
is_png normal.png
equal 404 "$(curl -sS -o answer -w '%{http_code}' "$U/v1/jobs/$layered/layers/albedo")" "a layer that was not asked for"

# The classic slip, and with a body far over 8 KiB.
equal 202 "$(curl -sS -o /dev/null -w '%{http_code}' -d @scene.json "$U/v1/jobs")" "form content type"
jq '.labels = ([range(64) | {key: "label_\(.)", value: ("a value that takes room, number \(.), " * 4)}] | from_entries)' scene.json >large.json
[ "$(wc -c <large.json)" -gt 9000 ] || fail "the large scene is small"
equal 202 "$(curl -sS -o answer -w '%{http_code}' -d @large.json "$U/v1/jobs")" "large form body: $(cat answer)"
large=$(jq -r .id answer)
equal 64 "$(curl -sS "$U/v1/jobs/$large" | jq '.labels | length')" "labels of the large form body"

# Polling with an ETag costs nothing.
etag=$(curl -sS -D - -o /dev/null "$U/v1/jobs/$id" | tr -d '\r' | awk 'tolower($1) == "etag:" {print $2}')
equal 304 "$(curl -sS -o /dev/null -w '%{http_code}' -H "If-None-Match: $etag" "$U/v1/jobs/$id")" "a poll with the ETag"
