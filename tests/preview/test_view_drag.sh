# A hand that moves the camera faster than pictures are made sees pictures all along.
. tests/preview/lib.sh
start_display
view scenes/showcase.yaml --size 900x700
at 300 300
before=$(count ' shown ')
wishes=$(count ' wish ')
steps=()
for ((i = 0; i < 200; i++)); do
    steps+=(mousemove --window "$window" $((300 + i % 50 * 4)) $((300 + i % 20 * 5)) sleep 0.01)
done
xdotool mousedown 1 "${steps[@]}"
pictures=$(($(count ' shown ') - before))
xdotool mouseup 1
wishes=$(($(count ' wish ') - wishes))
echo "$pictures pictures of $wishes moves"
[ "$wishes" -ge 50 ] || problem "only $wishes moves"
[ "$pictures" -ge 8 ] || problem "only $pictures pictures"
settle
quit
finish
