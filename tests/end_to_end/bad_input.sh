#!/bin/sh
# Whatever is sent, the answer is a 4xx problem with a pointer or a remedy, and the service goes on.
# shellcheck source-path=SCRIPTDIR disable=SC2119
. "$(dirname "$0")/service.sh"
start_service
cd "$WORK"

refused() # STATUS CODE(grep -E) CURL_ARGUMENTS...
{
    wanted=$1 code=$2
    shift 2
    seen=$(curl -sS -o answer -D headers -w '%{http_code}' "$@")
    equal "$wanted" "$seen" "curl $* answered $(head -c 400 answer)"
    grep -qi '^content-type: application/problem+json' headers || fail "curl $*: no problem document"
    jq -re .code answer | grep -qE "^($code)\$" || fail "curl $*: code is $(jq -r .code answer)"
    jq -e '.detail | length > 10' answer >/dev/null || fail "curl $*: no detail"
}

refused 400 malformed_json --json '{"scene":' "$U/v1/jobs"
refused 400 malformed_json --json '{"scene":{"objects":[]},"seed":1e400}' "$U/v1/jobs"
refused 400 malformed_json --json '{"seed":NaN}' "$U/v1/jobs"
python3 -c "print('['*100000, end='')" >deep.json
refused 400 'malformed_json|too_deep' --json @deep.json "$U/v1/jobs"
python3 -c "print('{\"a\":'*100000, end='')" >deep.json
refused 400 'malformed_json|too_deep' --json @deep.json "$U/v1/jobs"
head -c 2000000 /dev/zero | tr '\0' ' ' >long.json
refused 413 '.*' --json @long.json "$U/v1/jobs"
refused 415 '.*' -H 'Content-Type: application/xml' -d '<a/>' "$U/v1/jobs"
refused 422 'invalid_scene' --json '{"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":30000,"height":30000}}' "$U/v1/jobs"
refused 422 'invalid_scene' --json '{"scene":{"objects":[{"shape":"sphere","colour":1}]}}' "$U/v1/jobs"
jq -e '.errors[0].pointer == "/scene/objects/0/colour"' answer >/dev/null || fail "pointer: $(cat answer)"
refused 422 'invalid_scene' --json "{\"scene\":{\"objects\":[{\"mesh\":\"sha256:$(printf '%064d' 0)\"}]}}" "$U/v1/jobs"
jq -e '.errors[0].code == "missing_asset"' answer >/dev/null || fail "missing asset: $(cat answer)"
refused 422 'digest_mismatch' -T "$ASSETS/knot.obj" "$U/v1/assets/sha256:$(printf '%064d' 0)"
refused 404 '.*' "$U/v1/jobs/nobody"
refused 404 '.*' "$U/nowhere"
refused 405 '.*' -X PUT "$U/v1/jobs"

# Every broken mesh is refused as a fault of the client's, by its job and by its info.
broken=0
for mesh in "$ASSETS"/broken/*.obj "$ASSETS"/broken/*.ply "$ASSETS"/broken/*.stl "$ASSETS"/broken/*.glb "$ASSETS"/broken/*.gltf; do
    name=$(basename "$mesh")
    wanted=$(awk -F '\t' -v name="$name" '$1 == name {print $2}' "$ASSETS/broken/manifest.tsv")
    case $wanted in "" | *ok*) continue ;; esac
    code=$(curl -sS -o answer -w '%{http_code}' -F 'scene={"scene":{"objects":[{"mesh":"'"$name"'"}]},"image":{"width":8,"height":8}}' \
        -F "$name=@$mesh" -H 'Prefer: wait=30' -H 'Accept: image/png' "$U/v1/jobs")
    case $code in 4??) ;; *) fail "$name: $code $(head -c 300 answer)" ;; esac
    jq -r .errors[0].code answer | grep -qE "^($(echo "$wanted" | tr , '|'))\$" || fail "$name: wanted one of $wanted: $(cat answer)"
    jq -e '.errors[0].pointer == "/scene/objects/0/mesh" and (.errors[0].detail | length > 10)' answer >/dev/null || fail "$name: $(cat answer)"
    broken=$((broken + 1))
done
[ $broken -ge 30 ] || fail "only $broken broken meshes were tried"

# And it goes on.
mesh=$(upload "$ASSETS/knot.obj")
curl --fail -sS --json "{\"scene\":{\"objects\":[{\"mesh\":\"$mesh\"}]},\"image\":{\"width\":16,\"height\":16},\"quality\":{\"samples\":1}}" \
    -H 'Prefer: wait=30' -H 'Accept: image/png' -o after.png "$U/v1/jobs"
is_png after.png
