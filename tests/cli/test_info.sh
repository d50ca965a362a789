# What a scene holds, as text and JSON, and the hash of its numbers, which Python computes as well.
. tests/cli/lib.sh
lavaray=$LAVARAY

expect 0 "$lavaray" info $small
says out '^  cameras    1$' && says out '^  objects    3: ' && says out '^  scene      SHA-256 [0-9a-f]{64}$'
says out "^  file       SHA-256 $(sha256sum <$small | cut -c1-64)$"
expect 0 "$lavaray" info scenes/cameras.yaml && says out '^  cameras    5: front, side, above, close, far$'
expect 0 "$lavaray" info scenes/first.yaml && says out '^  lights     1: 1 added to suit the camera$'
expect 3 "$lavaray" info $scenes/bad.yaml && says err 'bad\.yaml:1:'
expect 5 "$lavaray" info "$work/none.yaml"
expect 2 "$lavaray" info
expect 2 "$lavaray" info $small $small

cat >"$work/a.nff" <<'NFF'
b 0.5 0.25 0.125
v
from 0 -5 2
at 0 0 0
up 0 0 1
angle 45
hither 0
resolution 32 16
l 4 3 2
f 1 0.5 0 0.75 0.25 8 0 1
s 1 2 3 -0.5
p 3 0 0 -0.0 1 0 0 0 1 0
f 1 1 1 0 0 1 0.5 1.5
pp 3 0 0 1 0 0 2  1 0 1 0 0 1  0 1 1 0 0 1
p 3 0 0 0 1 1 1 2 2 2
NFF
expect 0 "$lavaray" info "$work/a.nff"
says out '^  objects    3: 1 sphere, 2 mesh$' && says out '^  meshes     2: 2 triangles \(2 shown\), 6 vertices$'
says out '^  bounds     \[0, 0, 0\] to \[1\.5, 2\.5, 3\.5\]$'
says out 'note .*a\.nff:15: polygons without an area, left out: 1 from here on'
expect 0 "$lavaray" info --json "$work/a.nff"
[ ! -s "$work/err" ] || problem "info prints on stderr: $(cat "$work/err")"
python3 - "$work/out" <<'PYTHON' || problem 'the hash is not that of docs/info.md'
import hashlib, json, struct, sys

said = json.load(open(sys.argv[1]))
out = b""


def whole(*values):
    global out
    out += struct.pack("<%dI" % len(values), *values)


def real(*values):
    global out
    out += struct.pack("<%dd" % len(values), *values)


def single(*values):
    global out
    out += struct.pack("<%df" % len(values), *values)


def material(color, diffuse, specular, transmit, shininess, ior, one_sided):
    whole(0, 0)
    real(*color, *color)
    whole(0)
    real(1, 0, 0, 0, 0, 1, 0)
    for value in 0, diffuse, specular, specular, transmit, 0, 0:
        real(value, value, value)
    real(shininess)
    whole(1)
    real(ior)
    whole(0, 0)
    real(0)
    whole(one_sided, 0, 0)
    real(*[0] * 6, *[0] * 9)
    for _ in range(5):
        whole(0, 0, 0)
        real(0)


def instance(kind, material, inward):
    whole(kind, material, 1, 0, inward)
    real(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)


whole(32, 16, 1, 4, 0)
real(0, 0)
whole(0, 0, 0)
real(0, 0, 0, 0)
whole(0)
real(0.5, 0.25, 0.125, 0.5, 0.25, 0.125)
whole(0)
real(*9 * [0])
real(0, 0, 1, 0, 0, 0, 0)
whole(1)
real(0, -5, 2, 0, 0, 0, 0, 0, 1, 45)
whole(1, 0)
real(0, 0, 0)
whole(0)
real(0)
real(0, -5, 2, 0, 0, 0, 0, 0, 1, 45, 0)
whole(0, 1, 0)
real(1, 1, 1, 1, 0, 4, 3, 2, 0, 0, 0, 0, 0, 0)
whole(1)
whole(2)
material((1, 0.5, 0), 0.75, 0.25, 0, 8, 1, 0)
material((1, 1, 1), 0, 0, 0.5, 1, 1.5, 0)
whole(3)
instance(0, 0, 1)
real(1, 2, 3, 0.5)
instance(8, 0, 0)
whole(0)
instance(8, 1, 0)
whole(1)
whole(2, 3, 1, 0, 0, 0, 0)
single(0, 0, 0, 1, 0, 0, 0, 1, 0)
whole(0, 1, 2, 3, 1, 1, 1, 0, 0)
single(0, 0, 1, 1, 0, 1, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1)
whole(0, 1, 2, 0)
assert said["scene_sha256"] == hashlib.sha256(out).hexdigest()
assert said["bounds"] == [[0, 0, 0], [1.5, 2.5, 3.5]]
assert said["objects"]["mesh"] == 2 and said["lights"]["point"] == 1 and len(said["notes"]) == 1
PYTHON
finish
