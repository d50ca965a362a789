# SwiftShader makes the same pictures as the usual driver. Skipped without it, and when it cannot
# compile the kernels within a minute and 8 GB: then it is of no use for tests.
. tests/cli/lib.sh
[ -n "${LAVARAY_SWIFTSHADER_ICD:-}" ] || { echo 'LAVARAY_SWIFTSHADER_ICD is not set' >&2; exit 77; }
need_device
unset LAVARAY_VALIDATION

# on_second COMMAND...: with the second driver and bounds on its time and memory.
on_second() (
    ulimit -v 8000000
    export VK_ICD_FILENAMES=$LAVARAY_SWIFTSHADER_ICD
    unset VK_DRIVER_FILES
    timeout -s KILL 60 "$@"
)

expect 0 on_second "$LAVARAY" devices || finish
says out 'SwiftShader.*usable, exact'
code=0
on_second "$LAVARAY" render -q $small --size 8x6 --spp 1 -o "$work/x.pfm" || code=$?
if [ "$code" -gt 128 ]; then
    echo 'SwiftShader cannot compile the kernels in time' >&2
    [ "$failures" -gt 0 ] || exit 77
fi
[ "$code" -eq 0 ] || { problem "exit code $code on SwiftShader"; finish; }

for scene in scenes/*.yaml $scenes/small.yaml $scenes/two-cameras.yaml; do
    [ -f "$scene" ] || continue
    render="$LAVARAY render -q $scene --size 48x36 --spp 2 -o $work/x.pfm --stats"
    $render "$work/first.json" || { problem "$scene: no picture"; continue; }
    on_second $render "$work/second.json" || { problem "$scene: no picture on SwiftShader"; continue; }
    [ "$(sha256_in "$work/first.json")" = "$(sha256_in "$work/second.json")" ] ||
        problem "$scene: SwiftShader makes another picture"
done
expect 0 on_second "$LAVARAY" devices --self-test || cat "$work/out" >&2
finish
