# What each key and each move of the mouse does. Where the camera comes to stand is checked in
# tests/unit/test_camera_control.c; here, that the hands reach it.
. tests/preview/lib.sh
start_display
scene=$work/cameras.yaml
cat scenes/cameras.yaml - >"$scene" <<<'  - sphere: {center: [-1, 0.5, 1.5], radius: 0.5, material: {reflect: 0.8}}'
cp "$scene" "$work/before.yaml"
view "$scene" --size 320x240 --spp 1 --screenshot "$work/shot.png"
settle
start=$camera
"$LAVARAY" render -q "$scene" --size 320x240 --spp 1 -o "$work/start.ppm"
shows_soon "$work/start.ppm" hands-start

# field NAME: numbers of the printed camera.
field() {
    sed -n "s/.*$1: \[*\([-0-9., e]*\).*/\1/p" <<<"$camera"
}

# moves WHAT FIELDS: the camera differs from the start in these fields alone.
moves() {
    local name got=
    settle
    local now=$camera
    for name in from to up fov; do
        [ "$(camera=$start field $name)" = "$(camera=$now field $name)" ] || got="$got${got:+ }$name"
    done
    [ "$got" = "$2" ] || problem "$1 changed '$got' instead of '$2': $now"
}

back() {
    press "$1"
    settle
    [ "$camera" = "$start" ] || problem "$1 is not back at the start: $camera"
}

at 100 100 && drag 1 40 0
moves 'orbiting' from
back r
at 100 100 && drag 2 40 20
moves 'a drag with the middle button' 'from to'
back Home
at 100 100 && xdotool keydown shift && drag 1 40 20 && xdotool keyup shift
moves 'a drag with Shift' 'from to'
back r
at 100 100 && drag 3 40 20
moves 'looking around' to
back r
at 160 120 && xdotool click 4
moves 'the wheel' 'from'
back r
at 90 90 && xdotool click 5
moves 'the wheel off the middle' 'from to'
back r
at 100 160 && xdotool click --repeat 2 --delay 60 1
await 60 more ' focused' 0
moves 'a double click' 'from to'
back r
# Its rays lie over the picture until Escape.
await 20 shows "$work/start.ppm"
at 100 160 && xdotool click 1
await 60 differs "$work/start.ppm"
keep hands-explained
moves 'a single click' ''
await 20 shows "$work/start.ppm"
at 200 170 && press f
await 60 more ' focused' 1
moves 'f' 'from to'
back r
press Prior
moves 'Page Up' fov
press Next
settle
[ "$camera" = "$start" ] || problem "Page Down did not undo Page Up: $camera"
back r

# With the right button down letters fly, and do nothing else.
at 160 120
before=$(count ' wish ')
xdotool mousedown 3 keydown w
await 20 more ' wish ' $((before + 3))
xdotool keyup w keydown s keyup s mouseup 3
moves 'flying' 'from to'
cmp -s "$scene" "$work/before.yaml" || problem 's saved while flying'
back r

# The scene's cameras, by number; there is no ninth.
for number in 2 3 5 1; do
    press $number
    settle
    want=$(sed -n "$((number + 2))s/^ *[a-z]*: {from: \[\(.*\)\], to.*/\1/p" scenes/cameras.yaml)
    [ "$(field from)" = "$want" ] || problem "camera $number: $camera, not from $want"
done
before=$(count ' wish ')
press 9
settle
[ "$(count ' wish ')" -eq "$before" ] || problem '9 changed the picture'

# What is shown otherwise: exposure, depth; neither moves the camera.
press Up Up Up
settle
"$LAVARAY" render -q "$scene" --size 320x240 --spp 1 --exposure 1 -o "$work/want.ppm"
shows_soon "$work/want.ppm" hands-brighter
press Down Down Down
shows_soon "$work/start.ppm" hands-start
press Left Left Left Left Left Left Left Left
settle
"$LAVARAY" render -q "$scene" --size 320x240 --spp 1 --depth 0 -o "$work/want.ppm"
shows_soon "$work/want.ppm" hands-depth
press Right
settle
[ "$camera" = "$start" ] || problem "it moved: $camera"

# Panels: help over the picture, on and off.
for key in h F1 question; do
    press $key
    await 20 differs "$work/start.ppm"
    keep hands-help
    press Escape
    shows_soon "$work/start.ppm" hands-start
done
press h h
shows_soon "$work/start.ppm" hands-start

# Screenshots: each has its own name, and shows no panel.
press h F12
await 20 test -s "$work/shot.png"
press c
await 20 test -s "$work/shot-1.png"
for name in shot shot-1; do
    pngtopnm "$work/$name.png" >"$work/got.ppm"
    same "$work/start.ppm" "$work/got.ppm"
done
echo mine >"$work/shot-2.png"
press F12
await 20 test -s "$work/shot-3.png"
[ "$(cat "$work/shot-2.png")" = mine ] || problem 'a screenshot replaced a file'
press h Escape

# Full screen and back.
press F11
await 20 sized 1280x1024
await 60 more ' size 1280x1024 finished' 0
keep hands-full
press Escape
await 20 sized 320x240
shows_soon "$work/start.ppm" hands-start
press F11
await 20 sized 1280x1024
press F11
await 20 sized 320x240

# Saving writes the camera where it stands and nothing else, and the window does not read it again.
printf '%s\n' '# mine' 'camera: {from: [0, 1, 5], to: [0, 0, 0]} # front' '' 'objects: # one' \
    '  - sphere: {radius: 1.0}' >"$scene"
before=$(count ' scene read')
await 20 more ' scene read' $((before - 1))
settle
at 100 100 && drag 1 40 20
settle
cp "$scene" "$work/before.yaml"
press s
await 20 differs_file "$scene" "$work/before.yaml"
"$LAVARAY" validate -q "$scene" || problem 'the saved scene is not valid'
diff "$work/before.yaml" "$scene" >"$work/diff"
[ "$(grep -c '^[<>]' "$work/diff")" -eq 2 ] || problem "more than the camera changed: $(cat "$work/diff")"
grep -q '^> camera: {.*} # front$' "$work/diff" || problem "not kept: $(cat "$work/diff")"
grep -qF "from: [$(field from)" "$scene" || problem "saved $(cat "$work/diff"), printed $camera"
before=$(count ' scene ')
settle
[ "$(count ' scene ')" -eq "$before" ] || problem 'what it saved itself was read again'
press r
saved=$camera
settle
[ "$camera" = "$saved" ] || problem "r after saving goes to $camera"
press g
await 20 differs "$work/start.ppm"
quit
finish
