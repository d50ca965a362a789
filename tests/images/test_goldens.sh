# Every scene of scenes/ against its golden picture, exactly, and against the values in its own
# "# expect" lines, worked out by hand. UPDATE=1 makes the renders the goldens.
set -u
folder=tests/images
kept=$BUILD_DIR/images
command -v pngtopnm >/dev/null && command -v python3 >/dev/null || { echo 'no netpbm or python3' >&2; exit 77; }
"$LAVARAY" doctor >/dev/null 2>&1 || { echo 'no usable Vulkan device' >&2; exit 77; }
rm -rf "$kept"
mkdir -p "$kept" || exit 1
failures=0

problem() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}

# pixels FILE: what a PNG decodes to; a PPM as it is.
pixels() {
    case $1 in
    *.png) pngtopnm "$1" 2>/dev/null || echo "cannot decode $1" ;;
    *) cat "$1" ;;
    esac
}

# golden SCENE NAME FLAGS...: renders to the file NAME and compares it with the golden of that name.
golden() {
    local scene=$1 name=$2
    shift 2
    "$LAVARAY" render "$scene" -q -o "$kept/$name" "$@" || { problem "$scene does not render"; return; }
    if [ "${UPDATE:-0}" = 1 ]; then
        cp "$kept/$name" "$folder/golden/$name"
    elif [ ! -f "$folder/golden/$name" ]; then
        problem "$name: no golden; look at $kept/$name, then accept it with UPDATE=1"
    elif ! cmp -s <(pixels "$folder/golden/$name") <(pixels "$kept/$name"); then
        problem "$name: not the golden's pixels; look at $kept/$name, and if it is right accept it with UPDATE=1"
    fi
}

for scene in $folder/scenes/*.yaml; do
    name=$(basename "$scene" .yaml)
    golden "$scene" "$name.png"
    for maxval in $(sed -n 's/^# code \([0-9]*\) .*/\1/p' "$scene" | sort -nu); do
        golden "$scene" "$name-$maxval.ppm" --maxval "$maxval"
    done
    "$LAVARAY" render "$scene" -q -o "$kept/$name.pfm" || problem "$scene does not render"
    python3 $folder/expect.py "$scene" "$kept" || problem "$scene: not the values worked out by hand"
done
for file in $folder/golden/*; do
    name=$(basename "$file")
    [ -f "$kept/$name" ] || problem "$file belongs to no scene"
done
[ "$failures" -eq 0 ] || { echo "$failures checks failed" >&2; exit 1; }
rm -rf "$kept"
