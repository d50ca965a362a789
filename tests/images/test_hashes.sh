# The hashes of all scenes of scenes/ against hashes.txt, on the driver the tests run on, and on
# SwiftShader when LAVARAY_SWIFTSHADER_ICD names its manifest. UPDATE=1 rewrites the table.
set -u
table=tests/images/hashes.txt
command -v python3 >/dev/null || { echo 'no python3' >&2; exit 77; }
"$LAVARAY" doctor >/dev/null 2>&1 || { echo 'no usable Vulkan device' >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

problem() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}

# hash_of SCENE: SHA-256 of its linear pixels.
hash_of() {
    timeout 60 "$LAVARAY" render "$1" -q --size 160x120 --spp 2 -o "$work/picture.pfm" --stats - </dev/null |
        python3 -c 'import json, sys; print(json.load(sys.stdin)["picture"]["sha256"])' 2>/dev/null
}

# check DRIVER: every scene's hash is the table's.
check() {
    local scene name want got
    for scene in scenes/*.yaml; do
        name=$(basename "$scene" .yaml)
        want=$(awk -v name="$name" '$2 == name { print $1 }' $table)
        got=$(hash_of "$scene")
        if [ -z "$got" ]; then
            problem "$scene does not render on $1"
        elif [ -z "$want" ]; then
            problem "$scene has no line in $table; on $1 it is $got"
        elif [ "$got" != "$want" ]; then
            problem "$scene on $1 is $got; in $table it is $want"
        fi
    done
}

if [ "${UPDATE:-0}" = 1 ]; then
    for scene in scenes/*.yaml; do
        got=$(hash_of "$scene")
        [ -n "$got" ] || { echo "FAILED: $scene does not render" >&2; exit 1; }
        echo "$got  $(basename "$scene" .yaml)"
    done >"$work/table" || exit 1
    cp "$work/table" $table
fi
check 'the default driver'
if [ -n "${LAVARAY_SWIFTSHADER_ICD:-}" ]; then
    unset LAVARAY_VALIDATION VK_DRIVER_FILES
    export VK_ICD_FILENAMES=$LAVARAY_SWIFTSHADER_ICD
    check SwiftShader
fi
while read -r _ name; do
    [ -f "scenes/$name.yaml" ] || problem "$table has a line for $name, which is no scene"
done <$table
[ "$failures" -eq 0 ] || { echo "$failures checks failed" >&2; exit 1; }
