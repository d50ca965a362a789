# A hundred edits in ten seconds, every second one broken: the last good state is shown in the end, no
# file stays open, and memory does not grow from one hundred to the next.
. tests/preview/lib.sh
start_display
scene=$work/scene.yaml
cp -r scenes/models "$work/models"

cat >"$work/edit.py" <<'END_OF_PYTHON'
"""edit.py SCENE FIRST: a hundred edits from number FIRST on, one each tenth of a second; half of them
in place, half beside it and renamed."""
import os, sys, time

GOOD = """camera: {from: [0, 1, 7], to: [0, 0.5, 0]}
image: {width: 200, height: 150}
objects:
  - sphere: {center: [%g, 1, 0], material: {color: red}}
  - mesh: {file: models/gem.obj, translate: [1.2, 1, 0]}
"""
BROKEN = "camera: {from: [0, 1, 7]}\nobjects: [{sphere: {center: [%g, 1]}}\n"
path, first = sys.argv[1], int(sys.argv[2])
start = time.monotonic()
for i in range(first, first + 100):
    text = (BROKEN if i % 2 else GOOD) % (-2 + i * 0.005)
    name = path if i % 4 < 2 else path + "~"
    with open(name, "w") as file:
        file.write(text[:40])
        file.flush()
        file.write(text[40:])
    if name != path:
        os.rename(name, path)
    time.sleep(max(0, start + 0.1 * (i - first + 1) - time.monotonic()))
END_OF_PYTHON

resident() {
    sed -n 's/^VmRSS:[[:space:]]*\([0-9]*\).*/\1/p' "/proc/$view_process/status"
}

# hundred FIRST: edits, then the same good scene as ever; memory and open files into $rss, $open.
hundred() {
    python3 "$work/edit.py" "$scene" "$1"
    python3 - "$scene" <<'END_OF_PYTHON'
import sys
text = open(sys.argv[1] + ".good").read()
open(sys.argv[1], "w").write(text)
END_OF_PYTHON
    shows_soon "$work/want.ppm" edits
    rss=$(resident)
    open=$(ls "/proc/$view_process/fd" | wc -l)
}

printf '%s\n' 'camera: {from: [0, 1, 7], to: [0, 0.5, 0]}' 'image: {width: 200, height: 150}' \
    'objects:' '  - sphere: {center: [-1, 1, 0], material: {color: red}}' \
    '  - mesh: {file: models/gem.obj, translate: [1.2, 1, 0]}' >"$scene.good"
cp "$scene.good" "$scene"
expect 0 "$LAVARAY" render -q "$scene" -o "$work/want.ppm"
view "$scene"
hundred 0
first_rss=$rss first_open=$open
broken=$(count ' scene broken')
hundred 100
[ "$(count ' scene broken')" -gt "$((broken + 5))" ] || problem 'the edits were not seen'
[ "$open" -eq "$first_open" ] || problem "$open files are open, $first_open before"
# A scene that leaked would leave its device behind: 10 MB and more an edit, 500 MB in all.
[ "$rss" -lt "$((first_rss + 30000))" ] || problem "memory grew from $first_rss to $rss KiB"
echo "$(count ' scene read') scenes read, $(count ' scene broken') broken, $first_rss KiB, then $rss KiB"
quit
finish
