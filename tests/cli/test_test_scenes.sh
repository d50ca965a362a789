# `lavaray test` with scenes: what made a golden is in its file, so that a stale one is told from a
# changed renderer.
. tests/cli/lib.sh
need_device
command -v python3 >/dev/null || { echo 'no python3' >&2; exit 77; }
tool=$(realpath "$LAVARAY")
original=$PWD/$small
cd "$work" || exit 1
mkdir -p t/scenes/deep
cp "$original" t/scenes/ball.yaml
cp "$original" t/scenes/deep/ball.yaml
cat >t/tests.yaml <<'END'
defaults: {size: 32x24, samples: 1}
cases:
  deep/ball: {format: exr}
  bright: {scene: scenes/ball.yaml, args: [--exposure, "1"], size: 16x12}
END

# value CASE KEY...: of the last run with --json out.json.
value() {
    python3 -c 'import json, sys
at = {case["name"]: case for case in json.load(open("out.json"))["cases"]}
for key in sys.argv[1:]:
    at = at.get(key, {})
print(at)' "$@"
}

expect 0 "$tool" test t --update-missing
expect 0 "$tool" test t --json out.json
says out '^3 passed'
for file in ball.png bright.png deep/ball.exr; do
    [ -s "t/golden/$file" ] || problem "no golden $file"
done
[ "$(value ball compare size)" = '[32, 24]' ] || problem "size $(value ball compare size)"
[ "$(value bright compare size)" = '[16, 12]' ] || problem "size $(value bright compare size)"
[ "$(value ball golden_stamp scene_sha256)" = "$(sha256sum <t/scenes/ball.yaml | cut -d' ' -f1)" ] ||
    problem 'the golden does not hold the hash of its scene'
[ "$(value deep/ball golden_stamp)" != '{}' ] || problem 'nothing in the EXR about its origin'
value bright golden_stamp settings | grep -q '^16x12, 1 sample, depth .*, exposure 1$' ||
    problem "settings: $(value bright golden_stamp settings)"
for key in device driver; do
    [ -n "$(value ball $key)" ] && [ "$(value ball $key)" != '{}' ] || problem "no $key in the report"
done
value ball command | grep -q '^lavaray render t/scenes/ball.yaml -o ball.png --size 32x24 --spp 1$' ||
    problem "command: $(value ball command)"
"$tool" render t/scenes/ball.yaml -q -o direct.png --size 32x24 --spp 1 --stats stats.json
[ "$(value ball golden_stamp pixels_sha256)" = "$(sha256_in stats.json)" ] || problem 'not the hash of the pixels'

# The same picture from a changed scene passes; another picture tells that the scene changed.
echo '# a comment' >>t/scenes/ball.yaml
expect 0 "$tool" test t
cp t/golden/ball.png old.png
cp "$original" t/scenes/ball.yaml
for scene in ball deep/ball; do
    echo 'ambient: 0.77' >>t/scenes/$scene.yaml
    expect 1 "$tool" test t -k $scene
    says out 'The golden is stale: the scene has changed since lavaray [0-9.]* made it'
    cp "$original" t/scenes/$scene.yaml
    expect 0 "$tool" test t -k $scene
done

sed -i 's/samples: 1}/samples: 2}/' t/tests.yaml
expect 1 "$tool" test t -k ball
says out 'The golden is stale: its settings were 32x24, 1 sample, .* now they are 32x24, 2 samples'
sed -i 's/samples: 2}/samples: 1}/' t/tests.yaml

# A golden of the same scene and settings with other pixels: the renderer, or the file.
cat >forge.py <<'END'
import struct, sys, zlib
"""forge.py FROM TO OUT [pixels]: the picture FROM with the texts of TO; with `pixels` but its hash."""
def chunks(path):
    data, at = open(path, "rb").read(), 8
    while at < len(data):
        size, = struct.unpack_from(">I", data, at)
        yield data[at + 4:at + 8], data[at + 8:at + 8 + size]
        at += 12 + size
texts = {body.split(b"\0")[0]: body for kind, body in chunks(sys.argv[2]) if kind == b"tEXt"}
with open(sys.argv[3], "wb") as out:
    out.write(b"\x89PNG\r\n\x1a\n")
    for kind, body in chunks(sys.argv[1]):
        key = body.split(b"\0")[0]
        if kind == b"tEXt" and (key != b"lavaray.pixels" or len(sys.argv) < 5):
            body = texts[key]
        out.write(struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)))
END
"$tool" render t/scenes/ball.yaml -q -o other.png --size 32x24 --spp 1 --depth 0
python3 forge.py other.png old.png t/golden/ball.png pixels
expect 1 "$tool" test t -k ball
says out 'The scene is unchanged since lavaray [0-9.]* made the golden: the renderer gives other pixels'
python3 forge.py other.png old.png t/golden/ball.png
expect 1 "$tool" test t -k ball
says out 'linear pixels are those of the golden: its file was edited'
pngtopnm other.png 2>/dev/null | pnmtopng >t/golden/ball.png 2>/dev/null
expect 1 "$tool" test t -k ball
says out 'does not say which scene'
cp old.png t/golden/ball.png
expect 0 "$tool" test t -k ball

# A scene that is wrong, and a device that is not there.
echo 'objcets: []' >>t/scenes/ball.yaml
expect 1 "$tool" test t -k ball
says out 'exit code 3'
says out '\| t/scenes/ball.yaml:[0-9]+:1: unknown key "objcets"'
cp "$original" t/scenes/ball.yaml
expect 1 "$tool" test t -k bright --device no-such-device
says out 'exit code 4'
finish
