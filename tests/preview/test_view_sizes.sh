# The window's size and place: hundreds of resizes, sizes of one pixel, minimised, restored
# and moved. In the end it shows what it did at first.
. tests/preview/lib.sh
start_display
resizes=200
[ -z "${LAVARAY_FULL:-}" ] || resizes=1000
scene=$work/scene.yaml
cp scenes/showcase.yaml "$scene"
expect 0 "$LAVARAY" render -q "$scene" --size 200x150 -o "$work/want.ppm"
view "$scene" --size 200x150
shows_soon "$work/want.ppm" sizes-first
files=$(ls "/proc/$view_process/fd" | wc -l)

# resized COUNT PAUSE: so many sizes, one each PAUSE seconds, and then that of the beginning.
resized() {
    local steps=() i
    for ((i = 0; i < $1; i++)); do
        steps+=(windowsize "$window" $((40 + i * 37 % 400)) $((30 + i * 53 % 300)) sleep "$2")
    done
    xdotool "${steps[@]}" windowsize "$window" 200 150
    await 20 sized 200x150
    shows_soon "$work/want.ppm" sizes-resized
}

resized $((resizes / 2)) 0.002 # while nothing is finished yet, mostly not even begun
resized $((resizes / 2)) 0.03  # with pictures in between

for size in '1 1' '1 150' '200 1' '3000 2' '2 3000'; do
    before=$(count ' shown ')
    xdotool windowsize "$window" $size
    await 20 more " size ${size/ /x} finished" 0
done
xdotool windowsize "$window" 200 150
shows_soon "$work/want.ppm" sizes-after-one

# Minimised, it does nothing, also when it is asked for something.
for i in 1 2 3; do
    xdotool windowminimize "$window"
    await 20 hidden
    cp scenes/showcase.yaml "$scene" # which is read again
    xdotool windowmap "$window" windowactivate "$window"
    await 20 has_focus
    shows_soon "$work/want.ppm" sizes-restored
done

# Moved about, also beyond the screen's edge.
xdotool windowmove "$window" 900 700 windowmove "$window" -100 -60 windowmove "$window" 300 200
shows_soon "$work/want.ppm" sizes-moved

# Larger than the scene's own, to full screen and back, again and again.
for i in 1 2 3; do
    xdotool windowsize "$window" 800 600
    await 20 sized 800x600 # else the window manager may be asked for full screen first
    press F11
    await 20 sized 1280x1024
    press F11
    await 20 sized 800x600
done
xdotool windowsize "$window" 200 150
await 20 sized 200x150
shows_soon "$work/want.ppm" sizes-full
now=$(ls "/proc/$view_process/fd" | wc -l)
[ "$now" -le "$((files + 2))" ] || problem "$now files are open, $files at first"
quit
finish
