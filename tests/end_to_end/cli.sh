#!/bin/sh
# The remote commands of heliograph against a real service: what they print, what they leave, their exit codes.
# shellcheck source-path=SCRIPTDIR disable=SC2119
. "$(dirname "$0")/service.sh"

code_of() # COMMAND...: its exit code; what it prints goes to $WORK/out and $WORK/err
{
    code=0
    "$@" >"$WORK/out" 2>"$WORK/err" || code=$?
    echo "$code"
}

start_service
cd "$WORK"
export HELIOGRAPH_URL="$U"
helio="$BIN/heliograph"
mkdir scenes meshes
cp "$ASSETS"/knot.ply "$ASSETS"/knot.gltf "$ASSETS"/knot.bin "$ASSETS"/box.obj "$ASSETS"/box.mtl "$ASSETS"/checker.png meshes/
# Meshes in another folder than the scene, with an MTL and a glTF buffer that only they name.
cat >scenes/scene.json <<'JSON'
{"scene": {"objects": [{"mesh": "../meshes/box.obj"},
                       {"mesh": "../meshes/knot.gltf", "transform": [{"translate": [0, 1.2, 0]}]},
                       {"mesh": "../meshes/knot.ply", "transform": [{"translate": [1.5, 0, 0]}]}]},
 "image": {"width": 80, "height": 60}, "quality": {"samples": 4}}
JSON

equal 0 "$(code_of "$helio" health)" health
equal ready "$(cat out)" "what health says"
equal 0 "$(code_of env HELIOGRAPH_URL="$HEALTH" "$helio" health --quiet)" "health on the listener of its own"

# run gives the bytes that render gives, and uploads each file once.
"$helio" render scenes/scene.json -o local.png
equal 0 "$(code_of "$helio" run scenes/scene.json -o remote.png)" "run: $(cat err)"
cmp local.png remote.png || fail "run and render differ"
equal 6 "$(grep -c uploaded err)" "uploads of the first run (3 meshes, with 3 companions)"
equal 0 "$(code_of "$helio" run scenes/scene.json -o again.png --force)" "run --force"
equal 0 "$(grep -c uploaded err)" "uploads of the second run"
cmp local.png again.png || fail "run --force differs"

# submit, wait, status, fetch, list, rm.
id=$("$helio" submit scenes/scene.json --label batch=seven --priority 60 --idempotency-key k1)
equal "$id" "$("$helio" submit scenes/scene.json --label batch=seven --priority 60 --idempotency-key k1)" "the same key again"
equal 3 "$(code_of "$helio" submit meshes/knot.ply --idempotency-key k1)" "the same key for another job"
equal 0 "$(code_of "$helio" wait "$id" --timeout 60)" "wait: $(cat err)"
equal 0 "$(code_of "$helio" status "$id")" status
for line in '^state *succeeded' '^labels *batch=seven' '^priority *60'; do
    grep -q "$line" out || fail "status says: $(cat out)"
done
equal succeeded "$("$helio" status "$id" --json | jq -r .state)" "status --json"
equal 0 "$(code_of "$helio" fetch "$id" -o fetched.png)" "fetch: $(cat err)"
cmp local.png fetched.png || fail "the fetched picture differs"
"$helio" fetch "$id" -o - | cmp - local.png || fail "fetch to standard output differs"
# Layers: run asks for them, fetch gets them; render gives the same bytes.
"$helio" render scenes/scene.json -o local.exr --layer depth=local_depth.pfm --layer albedo=local_albedo.png
equal 0 "$(code_of "$helio" run scenes/scene.json -o remote.exr --layer depth=depth.pfm --layer albedo=albedo.png --label batch=layers)" \
    "run --layer: $(cat err)"
cmp local.exr remote.exr || fail "run and render of layers differ"
cmp local_depth.pfm depth.pfm || fail "the fetched depth differs"
cmp local_albedo.png albedo.png || fail "the fetched albedo differs"
layered=$("$helio" list --label batch=layers | cut -d' ' -f1)
equal 0 "$(code_of "$helio" fetch "$layered" --layer depth=again.pfm)" "fetch --layer: $(cat err)"
cmp local_depth.pfm again.pfm || fail "the depth fetched alone differs"
equal 5 "$(code_of "$helio" fetch "$layered" --layer normal=no.exr)" "fetch of a layer that was not asked for"
[ ! -e no.exr ] || fail "a failed fetch left a file"
equal 0 "$(code_of "$helio" rm "$layered")" "rm of the job with layers"

"$helio" list --label batch=seven >out
equal "$id" "$(cut -d' ' -f1 out)" "list --label"
equal 3 "$("$helio" list | wc -l)" "jobs in the list"
equal 1 "$("$helio" list --limit 1 | wc -l)" "list --limit 1"
equal 0 "$(code_of "$helio" rm "$id")" rm
equal 5 "$(code_of "$helio" status "$id")" "status of what was removed"
equal 5 "$(code_of "$helio" fetch "$id" -o no.png)" "fetch of what was removed"
[ ! -e no.png ] || fail "a failed fetch left a file"

# A bare mesh; a scene on standard input.
id=$("$helio" submit meshes/knot.ply)
equal 0 "$(code_of "$helio" rm "$id")" "rm of a job that runs"
echo '{"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":8,"height":8},"quality":{"samples":1}}' >sphere.json
"$helio" run - -o - <sphere.json >piped.png
is_png piped.png

# A long job: not finished within the time, no picture yet, cancelled; an interrupted run cancels its own.
echo '{"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":800,"height":600},"quality":{"samples":60000}}' >long.json
id=$("$helio" submit long.json)
equal 6 "$(code_of "$helio" wait "$id" --timeout 0.5)" "wait --timeout"
equal 6 "$(code_of "$helio" fetch "$id" -o no.png)" "fetch too early"
equal 0 "$(code_of "$helio" cancel "$id")" cancel
equal 1 "$(code_of "$helio" wait "$id")" "wait for a cancelled job"
equal 1 "$(code_of "$helio" fetch "$id" -o no.png)" "fetch of a cancelled job"
"$helio" run long.json -o no.png --label by=run 2>err &
runner=$!
tries=0
until "$helio" list --label by=run | grep -q .; do
    tries=$((tries + 1))
    [ $tries -lt 100 ] || fail "the run did not submit"
    sleep 0.05
done
kill -TERM $runner
code=0
wait $runner || code=$?
equal 130 $code "an interrupted run"
wait_for "$("$helio" list --label by=run | cut -d' ' -f1)" canceled
[ ! -e no.png ] || fail "there is a picture of nothing"

# A local render that is interrupted leaves nothing. It is ready for signals once its second thread is there.
"$helio" render long.json -o no.png 2>err &
runner=$!
tries=0
until [ "$(find "/proc/$runner/task" -mindepth 1 -maxdepth 1 | wc -l)" -gt 1 ]; do
    tries=$((tries + 1))
    [ $tries -lt 200 ] || fail "the render did not start"
    sleep 0.05
done
kill -TERM $runner
code=0
wait $runner || code=$?
equal 130 $code "an interrupted render: $(cat err)"
equal "" "$(find . -name 'no.png*')" "what an interrupted render leaves"

# Faults: told before anything is sent, with pointers; and those that only the service finds.
echo '{"scene":{"objects":[{"mesh":"absent.obj"},{"shape":"sphere"}]}}' >bad.json
equal 3 "$(code_of "$helio" submit bad.json)" "a mesh that is not there"
grep -q '/scene/objects/0/mesh' err || fail "no pointer: $(cat err)"
echo '{"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":30000,"height":30000}}' >huge.json
equal 3 "$(code_of "$helio" submit huge.json)" "a picture over the service's limit"
grep -q '/image' err || fail "no pointer: $(cat err)"
mkdir other
sed 's/newmtl checker/newmtl other/' meshes/box.mtl >other/box.mtl
cp meshes/box.obj other/
echo '{"scene":{"objects":[{"mesh":"meshes/box.obj"},{"mesh":"other/box.obj"}]}}' >two.json
equal 3 "$(code_of "$helio" submit two.json)" "two files of one name"
grep -q name_conflict err || fail "no name_conflict: $(cat err)"

# The service goes away while wait waits, and comes back on the same port.
id=$("$helio" submit long.json)
"$helio" wait "$id" 2>waiting &
waiter=$!
tries=0
until grep -q "GET.*$id" log; do
    tries=$((tries + 1))
    [ $tries -lt 200 ] || fail "wait does not ask"
    sleep 0.05
done
stop_service
PORT=${U##*:}
start_service
equal 0 "$(code_of "$helio" cancel "$id")" "cancel after the restart: $(cat err)"
code=0
wait $waiter || code=$?
equal 1 $code "wait over a restart: $(cat waiting)"

stop_service
equal 4 "$(code_of "$helio" list)" "no service"
equal 1 "$(code_of "$helio" health)" "health of no service"
