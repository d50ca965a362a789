# A still view converges to the very bytes that render writes: after the mouse has moved the camera,
# the window's pixels and its screenshot are those of a render with the camera that p prints.
. tests/preview/lib.sh
start_display
cp -r scenes "$work/scenes"

# same_as_render SCENE KEYS [FLAGS...]: FLAGS are those of render that KEYS stand for.
same_as_render() {
    local name=$1 keys=$2 scene=$work/scenes/$1.yaml before=$failures
    shift 2
    view "$scene" --size 160x120 --screenshot "$work/$name.png"
    local first
    settle
    first=$camera
    at 60 60
    drag 1 36 -20
    [ -z "$keys" ] || press $keys
    settle
    [ "$camera" != "$first" ] || problem 'the camera has not moved'
    sed "s/^camera:.*/$camera/" "$scene" >"$work/scenes/moved.yaml"
    expect 0 "$LAVARAY" render -q "$work/scenes/moved.yaml" --size 160x120 "$@" -o "$work/want.ppm"
    shows_soon "$work/want.ppm" "same-$name"
    press F12
    await 20 test -s "$work/$name.png"
    pngtopnm "$work/$name.png" >"$work/got.ppm"
    same "$work/want.ppm" "$work/got.ppm"
    [ -z "$(find "$work" -maxdepth 1 -name '*.tmp*')" ] || problem 'temporary files are left'
    quit
    [ "$failures" -eq "$before" ] || echo "  with $name" >&2
}

same_as_render showcase ''
same_as_render meshes ''
same_as_render textures 'Up Up Up' --exposure 1
same_as_render nested 'Left Left' --depth 8
same_as_render extremes 'Down' --exposure 19.666666666666668
finish
