# A pixel explained: the tree adds up to the picture that render makes, text and JSON say the same, on
# both drivers and as the documents show it.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY

# The flags, and what is wrong with them.
expect 2 "$lavaray" explain scenes/sheet.yaml && says err 'Give --pixel X,Y' && one_line
expect 2 "$lavaray" explain --pixel 1,1 && says err 'no scene given'
expect 2 "$lavaray" explain scenes/sheet.yaml --pixel 640,3
says err 'pixel 640,3 is outside the picture of 640x480' && one_line
expect 2 "$lavaray" explain scenes/sheet.yaml --pixel 3,480
expect 0 "$lavaray" explain scenes/sheet.yaml --pixel 640,3 --size 641x4
for at in 1 1,2,3 1x2 -1,2 1,-2 a,b 32768,1 '' ; do
    expect 2 "$lavaray" explain scenes/sheet.yaml --pixel "$at" && says err 'must be X,Y in pixels' && one_line
done
expect 2 "$lavaray" explain scenes/sheet.yaml --pixel 1,2 --sample 4 && says err 'no sample 4: the pixel has 4' && one_line
expect 0 "$lavaray" explain scenes/sheet.yaml --pixel 1,2 --sample 4 --spp 5
expect 2 "$lavaray" explain scenes/sheet.yaml --pixel 1,2 --camera nobody && says err "no camera 'nobody'"
expect 3 "$lavaray" explain $scenes/bad.yaml --pixel 1,2 && says err 'bad.yaml:1:'
expect 4 "$lavaray" explain scenes/sheet.yaml --pixel 1,2 --device nobody && one_line
expect 5 "$lavaray" explain "$work/none.yaml" --pixel 1,2 && says err 'none.yaml' && one_line

# The documents show what is printed.
# shows DOCUMENT ARGUMENTS...: its text block that begins with the scene's name.
shows() {
    local document=$1
    shift
    expect 0 "$lavaray" explain "$@"
    awk -v scene="$1" 'index($0, "```") { on = 0 } /^```text/ { on = 1; next } on' "$document" >"$work/shown"
    same "$work/shown" "$work/out"
}
shows docs/explain.md scenes/refraction.yaml --pixel 400,250 --spp 1
shows README.md scenes/sheet.yaml --pixel 320,340 --spp 1
python3 -c 'import sys; sys.exit(max(map(len, open(sys.argv[1], encoding="utf-8"))) > 101)' "$work/out" ||
    problem 'wider than 100 columns'
LC_ALL=C grep -q "$(printf '\033')" "$work/out" && problem 'escape sequences in the text'

# What the text says, and what JSON says of the same pixel.
expect 0 "$lavaray" explain scenes/nested.yaml --pixel 200,250 --sample 2
for words in '^scenes/nested.yaml: pixel 200,250 of 640×480, sample 2 of 4, depth ' '^camera ray, weight 1 ' \
    'meets [a-z]+, line [0-9]+' '─refracted ray, weight ' 'γ = γ1/γ2 = ' 'the same ray goes on' \
    'the medium around has priority here' 'inside [a-z]+, line [0-9]+' '^The pixel, mean of 4 samples '; do
    says out "$words"
done
steps=$(sed -n 's/^This sample in steps of 2^-36, the sum of all above: //p' "$work/out")
expect 0 "$lavaray" explain scenes/nested.yaml --pixel 200,250 --sample 2 --json
python3 - "$work/out" "$steps" <<'PYTHON' || problem 'text and JSON differ, or JSON is not as docs/explain.md says'
import json, re, sys

said = json.load(open(sys.argv[1]))
assert ", ".join(said["brings"]["steps"]) == sys.argv[2]
known = set(re.findall("`([a-z_]+)`", open("docs/explain.md").read()))


def keys(value):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield key
            yield from keys(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from keys(inner)


missing = set(keys(said)) - known
assert not missing, "not in docs/explain.md: %s" % missing
assert {ray["kind"] for ray in said["rays"]} == {"camera", "reflected", "refracted", "onward"}
assert {ray["cut"] for ray in said["rays"]} == {None, "weight"}
PYTHON

# The sum of the branches, of the samples, and the picture of render.
cat >"$work/check.py" <<'PYTHON'
import json, struct, sys

picture, samples = sys.argv[1], [json.load(open(name)) for name in sys.argv[2:]]
numbers = open(picture, "rb").read().split(b"\n", 3)
assert numbers[0] == b"PF" and float(numbers[2]) == -1, numbers[:3]
pixel = struct.unpack("<3f", numbers[3])


def steps(light):
    return [int(text) for text in light["steps"]]


total = [0, 0, 0]
for said in samples:
    found = [[0, 0, 0] for _ in said["rays"]]
    for ray in reversed(said["rays"]):
        if ray["cut"]:
            continue
        own = [ray["own_brings"], ray["fog_brings"]]
        own += [light["brings"] for light in (ray["hit"] or {}).get("lights", [])]
        for light in own:
            found[ray["id"]] = [a + b for a, b in zip(found[ray["id"]], steps(light))]
        assert found[ray["id"]] == steps(ray["brings"]), ray["id"]
        if ray["parent"] is not None:
            above = found[ray["parent"]]
            found[ray["parent"]] = [a + b for a, b in zip(above, found[ray["id"]])]
    assert found[0] == steps(said["brings"])
    total = [a + b for a, b in zip(total, found[0])]
    assert tuple(said["all_samples"]["color"]) == pixel, (said["all_samples"], pixel)
assert total == steps(samples[0]["all_samples"]["brings"])
for sum_of_samples, value in zip(total, pixel):
    assert struct.unpack("f", struct.pack("f", sum_of_samples / 2**36 / len(samples)))[0] == value
PYTHON
# on_second COMMAND...: on SwiftShader, if it is there.
on_second() (
    ulimit -v 8000000
    export VK_ICD_FILENAMES=$LAVARAY_SWIFTSHADER_ICD
    unset VK_DRIVER_FILES LAVARAY_VALIDATION
    timeout -s KILL 60 "$@"
)
for case in 'sheet 20,14' 'showcase 22,22' 'meshes 36,25' 'textures 30,22' 'fog 24,22' 'nested 15,19' \
    'absorption 25,20' 'shadows 20,26' 'spots 22,30' 'transforms 20,20'; do
    read -r scene at <<<"$case"
    flags="scenes/$scene.yaml --size 48x36 --spp 2"
    expect 0 "$lavaray" render -q $flags --crop "$at,1,1" -o "$work/pixel.pfm"
    for sample in 0 1; do
        expect 0 "$lavaray" explain $flags --pixel "$at" --sample $sample --json
        mv "$work/out" "$work/$sample.json"
        [ -n "${LAVARAY_SWIFTSHADER_ICD:-}" ] || continue
        on_second "$lavaray" explain $flags --pixel "$at" --sample $sample --json >"$work/second.json"
        same "$work/$sample.json" "$work/second.json"
    done
    python3 "$work/check.py" "$work/pixel.pfm" "$work/0.json" "$work/1.json" ||
        problem "$scene, pixel $at: the tree does not add up to the picture"
done

# A tree that is too large is refused, at once.
cat >"$work/large.yaml" <<'YAML'
camera: {from: [0, 0, 1]}
image: {width: 1, height: 1, samples: 1, depth: 18, min_weight: 0}
lights: []
materials: {mirror: {reflect: 1}}
objects:
  - plane: {normal: [0, 0, 1], offset: -2, material: mirror}
  - plane: {normal: [0, 0, -1], offset: -2, material: mirror}
  - rectangle: {corner: [-9, -9, 0], u: [18, 0, 0], v: [0, 18, 0], material: {reflect: 0.5, transmit: 0.5}}
YAML
expect 0 "$lavaray" explain "$work/large.yaml" --pixel 0,0 --depth 6 && says out 'not traced, depth 6 is used up'
expect 4 "$lavaray" explain "$work/large.yaml" --pixel 0,0 --depth 60 && says err 'smaller --depth' && one_line
finish
