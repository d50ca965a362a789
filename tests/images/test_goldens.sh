# The scenes of scenes/ against their golden pictures, by the command that docs/ci.md tells others to
# run, and against the values in their own "# expect" and "# code" lines, worked out by hand. The
# report is report/index.html of the build folder.
set -u
folder=tests/images
kept=$BUILD_DIR/images
report=$BUILD_DIR/report
command -v python3 >/dev/null || { echo 'no python3' >&2; exit 77; }
"$LAVARAY" doctor >/dev/null 2>&1 || { echo 'no usable Vulkan device' >&2; exit 77; }
rm -rf "$kept" "$report"
mkdir -p "$kept" || exit 1
failures=0

problem() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}

mapfile -t commands < <(sed -nE 's/^ *(- )?(lavaray test tests.*)/\2/p' docs/ci.md | sort -u)
[ "${#commands[@]}" -eq 1 ] || problem "docs/ci.md has ${#commands[@]} commands that test, not one"
ln -s "$PWD/tests" "$kept/tests"
(cd "$kept" && PATH=$(dirname "$LAVARAY"):$PATH bash -c "${commands[0]}" 2>messages) ||
    problem "not the goldens' pixels; look at $report/index.html"
cat "$kept/messages" >&2
grep 'belongs to no case' "$kept/messages" && problem 'a golden without a case'
for file in index.html junit.xml; do
    [ -s "$kept/report/$file" ] || problem "no report/$file"
done
mv "$kept/report" "$report"

for scene in "$folder"/scenes/*.yaml; do
    name=$(basename "$scene" .yaml)
    for maxval in $(sed -n 's/^# code \([0-9]*\) .*/\1/p' "$scene" | sort -nu); do
        "$LAVARAY" render "$scene" -q -o "$kept/$name-$maxval.ppm" --maxval "$maxval" ||
            problem "$scene does not render"
    done
    "$LAVARAY" render "$scene" -q -o "$kept/$name.pfm" || problem "$scene does not render"
    python3 $folder/expect.py "$scene" "$kept" || problem "$scene: not the values worked out by hand"
done
[ "$failures" -eq 0 ] || { echo "$failures checks failed" >&2; exit 1; }
rm -rf "$kept"
