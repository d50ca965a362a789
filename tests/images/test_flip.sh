# Independent judges: the published FLIP, and SSIM by its definition, on the seeded set of faulty
# pictures and on renders, LDR and HDR. Needs LAVARAY_FLIP_PYTHON, which tools/test sets.
set -u
[ -n "${LAVARAY_FLIP_PYTHON:-}" ] || { echo 'no flip-evaluator; tools/get-flip installs it' >&2; exit 77; }
"$LAVARAY" doctor >/dev/null 2>&1 || { echo 'no usable Vulkan device' >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$BUILD_DIR/tests/test_compare_faults" "$work" >/dev/null || exit 1
# render SCENE NAME FLAGS...
render() {
    "$LAVARAY" render "scenes/$1.yaml" -q -o "$work/$2" --size 161x120 "${@:3}" || exit 1
}
for scene in showcase shapes fog; do
    render $scene $scene-a.ppm --spp 4
    render $scene $scene-b.ppm --spp 1 --depth 1
    render $scene $scene-a.pfm --spp 4 --exposure 1.5
    render $scene $scene-b.pfm --spp 1 --exposure 1.6
done
"$LAVARAY_FLIP_PYTHON" tests/images/flip.py "$LAVARAY" "$work"
