# The hashes of all scenes of scenes/ against hashes.txt, ray-traced and path-traced, on the driver the tests run on, and on
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

# hash_of SCENE INTEGRATOR: SHA-256 of its linear pixels.
hash_of() {
    timeout 60 "$LAVARAY" render "$1" -q --integrator "$2" --size 160x120 --spp 2 -o "$work/picture.pfm" --stats - </dev/null |
        python3 -c 'import json, sys; print(json.load(sys.stdin)["picture"]["sha256"])' 2>/dev/null
}

# check DRIVER: every scene's hashes are the table's.
check() {
    local scene name integrator want got
    for scene in scenes/*.yaml; do
        name=$(basename "$scene" .yaml)
        for integrator in whitted path; do
            want=$(awk -v name="$name" -v by="$integrator" '$2 == by && $3 == name { print $1 }' $table)
            got=$(hash_of "$scene" "$integrator")
            if [ -z "$got" ]; then
                problem "$scene does not render on $1 ($integrator)"
            elif [ -z "$want" ]; then
                problem "$scene has no line in $table; on $1 it is $got ($integrator)"
            elif [ "$got" != "$want" ]; then
                problem "$scene on $1 is $got; in $table it is $want ($integrator)"
            fi
        done
    done
}

if [ "${UPDATE:-0}" = 1 ]; then
    for scene in scenes/*.yaml; do
        for integrator in whitted path; do
            got=$(hash_of "$scene" "$integrator")
            [ -n "$got" ] || { echo "FAILED: $scene does not render" >&2; exit 1; }
            printf '%s  %-7s  %s\n' "$got" "$integrator" "$(basename "$scene" .yaml)"
        done
    done >"$work/table" || exit 1
    cp "$work/table" $table
fi
check 'the default driver'
if [ -n "${LAVARAY_SWIFTSHADER_ICD:-}" ]; then
    unset LAVARAY_VALIDATION VK_DRIVER_FILES
    export VK_ICD_FILENAMES=$LAVARAY_SWIFTSHADER_ICD
    check SwiftShader
fi
while read -r _ _ name; do
    [ -f "scenes/$name.yaml" ] || problem "$table has a line for $name, which is no scene"
done <$table
[ "$failures" -eq 0 ] || { echo "$failures checks failed" >&2; exit 1; }
