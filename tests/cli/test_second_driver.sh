# SwiftShader makes the same pictures as the usual driver, and compiles the kernels within a minute
# and 8 GB. Skipped without it.
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
