# How it ends: by hand, by signal, by the window manager, with and without a display, a device, a
# scene; each with its exit code and its one message.
. tests/preview/lib.sh
start_display
limit=${LAVARAY_INTERRUPT_MS:-1000}

# milliseconds COMMAND...: how long the view lives on after the command, into $took; $1 is the code.
ends_by() {
    local code=$1 start
    shift
    start=$(date +%s%N)
    "$@"
    ended 20 "$code"
    took=$((($(date +%s%N) - start) / 1000000))
}

# Heavy: most of the time there is a kernel on the device.
heavy() {
    launch scenes/meshes.yaml --size 900x700 --spp 65536
    await 60 find_window && await 60 more ' shown ' 2
}

for name in INT TERM HUP; do
    heavy
    ends_by 130 kill -$name "$view_process"
    [ "$took" -le "$limit" ] || problem "SIG$name took $took ms"
    [ "$(cat "$work/err")" = 'lavaray: interrupted' ] || problem "SIG$name: $(cat "$work/err")"
done
for keys in alt+F4 q; do
    heavy
    await 10 has_focus
    ends_by 0 press $keys
    [ "$took" -le "$limit" ] || problem "$keys took $took ms"
    [ ! -s "$work/err" ] || problem "$keys: $(cat "$work/err")"
done
# At any time of its start, also while it reads a long scene: no crash, no hang, no word but the one.
stopped_early() {
    local code=0
    launch "$1" --size 640x480
    sleep "$2"
    kill -TERM "$view_process"
    await 20 has_ended
    wait "$view_process" 2>/dev/null || code=$?
    view_process=
    case "$code $(cat "$work/err")" in
    '130 lavaray: interrupted' | '143 ') ;;
    *) problem "SIGTERM after $2 s of ${1##*/}: exit code $code, $(cat "$work/err")" ;;
    esac
}
for delay in 0.02 0.1 0.15 0.2 0.25 0.3 0.4 0.6; do
    stopped_early scenes/showcase.yaml $delay
done
{
    printf 'lavaray: 1\ncamera: {from: [0, 0, 9], to: [0, 0, 0], fov: 40}\nobjects:\n'
    for ((i = 0; i < 30000; i++)); do echo "  - sphere: {center: [$i, 0, 0], radius: 0.4}"; done
} >"$work/long.yaml"
for delay in 0.05 0.1 0.15; do
    stopped_early "$work/long.yaml" $delay
done

# The loader's thread is busy when it ends: with reading, and with making a session ready.
scene=$work/scene.yaml
for delay in 0 0.05 0.1 0.15 0.2; do
    cp scenes/showcase.yaml "$scene"
    view "$scene" --size 300x200
    sed -i 's/fov: 33/fov: 34/' "$scene"
    sleep $delay
    press q
    ended 20 0
done

# What keeps the window from opening. With nothing to show there is no window, either.
windows() {
    xdotool search --class lavaray >/dev/null 2>&1 && problem 'a window is open'
}
expect 3 "$LAVARAY" view tests/cli/scenes/bad.yaml
says err 'bad.yaml:[0-9]+:[0-9]+: '
windows
expect 5 "$LAVARAY" view "$work/none.yaml"
says err 'none.yaml'
one_line
expect 2 "$LAVARAY" view -
expect 2 "$LAVARAY" view $small --screenshot x.gif
expect 2 "$LAVARAY" view
expect 2 "$LAVARAY" view $small --camera none || says err camera
expect 4 env VK_ICD_FILENAMES=/none "$LAVARAY" view $small
one_line
expect 4 "$LAVARAY" view $small --device 99
one_line
windows

for display in '' :987 nowhere.invalid:0 rubbish; do
    expect 4 env -u WAYLAND_DISPLAY DISPLAY="$display" "$LAVARAY" view $small
    one_line
    says err 'lavaray render'
done
expect 4 env -u WAYLAND_DISPLAY -u DISPLAY "$LAVARAY" view $small
one_line
says err 'DISPLAY.*lavaray render'
expect 4 env -u DISPLAY WAYLAND_DISPLAY=nowhere "$LAVARAY" view $small
one_line

# The events' file and the screenshots' folder cannot be written.
view $small --size 200x150 --screenshot "$work/none/shot.png"
window_picture "$work/want.ppm"
press F12
await 20 differs "$work/want.ppm"
keep ends-screenshot
quit
finish
