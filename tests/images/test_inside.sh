# Of objects with negative radii in NFF only the inside is there: from within they look like those with
# positive radii, from outside one sees what is behind their front.
. tests/cli/lib.sh
need_device

# hash OBJECT FROM: of the linear pixels of one object, seen from a point towards the origin.
hash() {
    cat >"$work/a.nff" <<NFF
v
from $2
at 0 0 0
up 0 0 1
angle 60
hither 0
resolution 40 40
l 0 -0.2 0.3
f 1 1 1 1 0 1 0 1
$1
NFF
    "$LAVARAY" render "$work/a.nff" -q -o "$work/a.ppm" --stats "$work/stats.json" >&2 &&
        sha256_in "$work/stats.json"
}

sphere='s 0 0 0' cone='c 0 0 -1'
for objects in "$sphere 1|$sphere -1" "$cone 1 0 0 1 0.5|$cone -1 0 0 1 -0.5"; do
    outward=${objects%|*} inward=${objects#*|}
    [ "$(hash "$outward" '0 -0.6 0.1')" = "$(hash "$inward" '0 -0.6 0.1')" ] ||
        problem "another inside: $inward"
    [ "$(hash "$outward" '0 -4 0')" != "$(hash "$inward" '0 -4 0')" ] ||
        problem "the outside is there: $inward"
done

# The light within a sphere that is seen from outside shows its far half, and so all of its disc.
hash "$sphere -1" '0 -4 0' >"$work/hash"
python3 - "$work/a.ppm" "$work/stats.json" <<'PYTHON' || problem 'the far side is dark'
import json, sys

pixels = open(sys.argv[1], "rb").read()[-4800:]
lit = sum(1 for i in range(0, 4800, 3) if pixels[i])
assert lit == json.load(open(sys.argv[2]))["rays"]["primary"]["hit"] > 200
PYTHON
finish
