# --aov: what it takes, what it refuses, and what files and statistics then say.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
folder=$work/folder
mkdir "$folder"

# channels FILE: those that an EXR's header lists, each with the type of its samples.
channels() {
    python3 - "$1" <<'END_OF_CHECK'
import struct, sys

data = open(sys.argv[1], "rb").read()
assert data[:4] == b"\x76\x2f\x31\x01"
at = 8
while data[at]:
    name, kind, rest = data[at:at + 400].split(b"\0", 2)
    at += len(name) + len(kind) + 2
    size, = struct.unpack_from("<i", data, at)
    if kind == b"chlist":
        value = data[at + 4:at + 4 + size]
        while value[0]:
            channel, value = value.split(b"\0", 1)
            kind_of, = struct.unpack_from("<i", value)
            print(channel.decode(), ("uint", "half", "float")[kind_of])
            value = value[16:]
    at += 4 + size
END_OF_CHECK
}

expect 0 "$lavaray" render -q $small --spp 4 -o "$work/plain.exr" --stats "$work/plain.json"
expect 0 "$lavaray" render -q $small --spp 4 -o "$work/all.exr" --aov all --stats "$work/all.json"
[ "$(sha256_in "$work/plain.json")" = "$(sha256_in "$work/all.json")" ] || problem 'layers change the picture'
channels "$work/all.exr" | tr '\n' ',' >"$work/out"
says out '^B float,G float,R float,albedo.B float,.*,depth float,.*,id uint,.*,normal.X float,.*,samples uint,variance.B float'
[ "$(tr , '\n' <"$work/out" | wc -l)" -eq 25 ] || problem "other channels: $(cat "$work/out")"
python3 - "$work/plain.json" "$work/all.json" <<'END_OF_CHECK' || problem 'the statistics are wrong'
import json, sys

plain, every = (json.load(open(path)) for path in sys.argv[1:3])
assert every["picture"]["layers"] == ["albedo", "normal", "depth", "position", "alpha", "id",
                                      "direct", "indirect", "variance", "samples"]
assert every["seconds"]["layers"] > 0
assert "layers" not in plain["picture"] and "layers" not in plain["seconds"]
assert plain["rays"] == every["rays"]
END_OF_CHECK

expect 0 "$lavaray" render -q $small --half -o "$work/some.exr" --aov id,depth
channels "$work/some.exr" | tr '\n' ',' >"$work/out"
says out '^B half,G half,R half,depth float,id uint,$'
expect 0 "$lavaray" render $small -v -o "$work/some.exr" --aov normal,albedo
says err '^layers   albedo, normal; [0-9.]+ s more$'
expect 0 "$lavaray" render -q $small --format exr -o - --aov depth
channels "$work/out" | grep -q '^depth float$' || problem 'no layer in standard output'

# refused PATTERN FLAGS...: one message, no picture.
refused() {
    local pattern=$1
    shift
    expect 2 "$lavaray" render -q $small "$@" || return
    says err "$pattern"
    one_line
    nothing_in "$folder"
}
refused 'which only EXR files have: -o FILE.exr' -o "$folder/x.png" --aov depth
refused "unknown layer 'normals', did you mean normal\?" -o "$folder/x.exr" --aov depth,normals
refused "unknown layer 'xyzzy'; there are albedo, .*, samples, or all of them: all" -o "$folder/x.exr" --aov xyzzy
refused "unknown layer ''" -o "$folder/x.exr" --aov depth,
refused "unknown layer 'a{39}'" -o "$folder/x.exr" --aov "$(printf 'a%.0s' {1..5000})"
refused 'neither --sample-range nor' -o "$folder/x.exr" --aov id --spp 4 --sample-range 0-1
refused 'nor --checkpoint' -o "$folder/x.exr" --aov id --checkpoint "$folder/c"
refused "'variance' needs 2 samples" -o "$folder/x.exr" --aov variance --spp 1
refused "'variance' needs a number of samples" -o "$folder/x.exr" --aov variance --integrator path --time 1s
refused "'direct' and 'indirect' need" -o "$folder/x.exr" --aov indirect --integrator path --noise 0.1 --spp 16
expect 0 "$lavaray" render -q $small --integrator path --noise 0.5 --spp 32 --aov samples,albedo -o "$work/noise.exr"

for file in depth-0 depth-1; do rm -f "$work/$file.exr"; done
expect 0 "$lavaray" render -q $small --frames 0-1 -o "$work/depth-%d.exr" --aov depth
channels "$work/depth-1.exr" | grep -q '^depth float$' || problem 'no layer in a frame'
finish
