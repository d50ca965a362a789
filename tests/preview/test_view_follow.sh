# The window follows its file and the files that this names: edited, broken, mended, renamed over.
. tests/preview/lib.sh
start_display
folder=$work/folder
mkdir "$folder"
cp scenes/models/gem.obj "$folder/mesh.obj"
cp scenes/pictures/tiles.png "$folder/picture.png"
scene=$folder/scene.yaml

# write COLOUR [FILE]: the scene with a ball of this colour.
write() {
    cat >"${2:-$scene}" <<EOF
camera: {from: [0, 1, 7], to: [0, 0.5, 0]}
image: {width: 320, height: 240}
objects:
  - plane: {material: {color: {image: picture.png}}}
  - sphere: {center: [-1.2, 1, 0], radius: 0.9, material: {color: $1}}
  - mesh: {file: mesh.obj, translate: [1.2, 1, 0], material: {color: [0.2, 0.7, 0.3]}}
EOF
}

# comes NAME: the window comes to show what render makes of the files as they are now.
comes() {
    expect 0 "$LAVARAY" render -q "$scene" -o "$work/want.ppm"
    shows_soon "$work/want.ppm" "follow-$1"
}

write red
view "$scene"
comes red
write '[0.1, 0.2, 0.9]'
comes blue

# Broken: the last good picture stays, under a panel that says where; mended, the panel goes.
cp "$work/want.ppm" "$work/good.ppm"
title=$(xdotool getwindowname "$window")
read=$(count ' scene read')
printf '%s\n' 'camera: {from: [0, 1, 7]}' 'objects:' '  - sphere: {radius: lots}' >"$scene"
await 20 more ' scene broken' 0
await 20 differs "$work/good.ppm"
keep follow-broken
[ "$(xdotool getwindowname "$window")" = "$title" ] || problem 'the title changed with a broken file'
head -c 30000 "$work/good.ppm" >"$work/top"
head -c 30000 "$work/window.ppm" | cmp -s - "$work/top" || problem 'the upper part of the picture changed'
[ "$(count ' scene read')" -eq "$read" ] || problem 'a broken file was read'
at 100 40 && drag 1 20 0 # the picture is not stuck
settle
press r
write '[0.1, 0.2, 0.9]'
comes blue

# Gone for a while, and back.
broken=$(count ' scene broken')
mv "$scene" "$folder/away"
await 20 more ' scene broken' "$broken"
keep follow-gone
mv "$folder/away" "$scene"
comes back

# Written beside it and renamed over it, as most editors do; twice, for the second watch.
for color in yellow cyan; do
    write $color "$folder/.scene.yaml.swp"
    mv "$folder/.scene.yaml.swp" "$scene"
    comes $color
done

# A file that stays as it is is none to read again.
read=$(count ' scene ')
: >"$folder/other.yaml"
chmod a+r "$scene"

# The files that it names: a mesh, a picture, in place and by renaming.
sed 's/^v \([^ ]*\)/v 1.4/' "$folder/mesh.obj" >"$folder/new.obj"
cp "$folder/new.obj" "$folder/mesh.obj"
comes mesh
cp scenes/pictures/crate.png "$folder/new.png"
mv "$folder/new.png" "$folder/picture.png"
comes picture
broken=$(count ' scene broken')
echo 'no picture' >"$folder/picture.png"
await 20 more ' scene broken' "$broken"
cp scenes/pictures/tiles.png "$folder/picture.png"
comes mended
[ "$(count ' scene ')" -le "$((read + 8))" ] || problem 'read more often than edited'

# What hands have done stays when the file says the same as before; what it says anew counts.
at 100 40 && drag 1 40 0
settle
moved=$camera
read=$(count ' scene read')
write magenta
await 20 more ' scene read' "$read"
settle
[ "$camera" = "$moved" ] || problem "an edit that is not the camera's moved it: $camera"
sed -i 's/from: \[0, 1, 7\]/from: [0, 2, 7]/' "$scene"
comes camera
quit

# A scene of its own place, by a symbolic link and from another folder.
ln -s folder "$work/link"
cd "$work/link" || exit 1
ln -s scene.yaml entry.yaml
view entry.yaml
cd - >/dev/null || exit 1
write black
comes link
quit
finish
