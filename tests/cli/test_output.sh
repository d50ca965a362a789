# What is reported: statistics, the summary, the progress bar.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY

expect 0 "$lavaray" render $small -o "$work/a.ppm" --stats "$work/a.json" --seed 7 -v
says err '^hash +[0-9a-f]{64}$'
says err '^  primary '
says err '^memory '
cat >"$work/check.py" <<'END'
import json, sys

s = json.load(open(sys.argv[1]))
assert s["version"].count(".") == 2
assert s["scene"].endswith("small.yaml") and s["output"].endswith(".ppm")
for key in "name", "driver", "api_version":
    assert s["device"][key], key
assert isinstance(s["device"]["software"], bool) and isinstance(s["device"]["exact"], bool)
p = s["picture"]
assert (p["width"], p["height"], p["full_size"]) == (64, 48, [64, 48])
assert (p["samples"], p["depth"], p["seed"], p["exposure"]) == (2, 5, 7, 0)
assert len(p["sha256"]) == 64
rays = s["rays"]
assert rays["primary"]["traced"] == 64 * 48 * 2
total = 0
for kind in "primary", "reflected", "refracted", "shadow":
    assert 0 < rays[kind]["traced"] and rays[kind]["hit"] <= rays[kind]["traced"], kind
    total += rays[kind]["traced"]
assert rays["total"] == total
assert all(s["dropped"][k] >= 0 for k in ("depth", "weight", "nesting"))
assert s["non_finite"] == 0 and s["saturated"] == 0 and s["passed"] >= 0
assert s["rays_per_second"] > 0 and s["peak_memory_bytes"] > 1 << 20
t = s["seconds"]
for key in "device", "parse", "upload", "compile", "trace", "read_back", "write":
    assert 0 <= t[key] <= t["total"], key
END
python3 "$work/check.py" "$work/a.json" || problem 'the statistics are wrong'
expect 0 "$lavaray" render -q $small -o "$work/a.ppm" --stats - --seed 7
python3 "$work/check.py" "$work/out" || problem 'the statistics on standard output are wrong'

# The hash is of the linear pixels, so it does not depend on how they are written.
"$lavaray" render -q $small -o "$work/a.png" --maxval 65535 --exposure 3 --stats "$work/a.json"
"$lavaray" render -q $small -o "$work/a.pfm" --stats "$work/b.json"
a=$(sha256_in "$work/a.json") b=$(sha256_in "$work/b.json")
[ -n "$a" ] && [ "$a" = "$b" ] || problem "hashes $a and $b of one picture"

# The scene's exposure holds unless there is a flag; cameras are chosen by name.
cameras=$scenes/two-cameras.yaml
expect 0 "$lavaray" render -q $cameras -o "$work/scene.ppm"
expect 0 "$lavaray" render -q $cameras -o "$work/one.ppm" --exposure 1 --camera front
same "$work/scene.ppm" "$work/one.ppm"
expect 0 "$lavaray" render -q $cameras -o "$work/zero.ppm" --exposure 0
cmp -s "$work/scene.ppm" "$work/zero.ppm" && problem '--exposure changes nothing'
expect 0 "$lavaray" render -q $cameras -o "$work/side.ppm" --camera side
cmp -s "$work/scene.ppm" "$work/side.ppm" && problem '--camera changes nothing'
# So do its tone map and white balance; files of light have no tone map, and say nothing of one.
sed 's/^image: {/&tone: aces, white: 3200, /' $small >"$work/toned.yaml"
grep -q aces "$work/toned.yaml" || problem "no image line in $small"
expect 0 "$lavaray" render -q "$work/toned.yaml" -o "$work/scene.png" --stats "$work/a.json"
grep -q '"tone": "aces"' "$work/a.json" && grep -q '"white": 3200' "$work/a.json" ||
    problem 'the statistics do not tell tone map and white balance'
grep -qa 'seed [0-9]*, tone aces, white 3200' "$work/scene.png" || problem 'neither does the picture'
expect 0 "$lavaray" render -q $small -o "$work/a.ppm" --tone aces --white 3200
expect 0 "$lavaray" render -q "$work/toned.yaml" -o "$work/b.ppm"
same "$work/a.ppm" "$work/b.ppm"
expect 0 "$lavaray" render -q "$work/toned.yaml" -o "$work/c.ppm" --tone none
cmp -s "$work/b.ppm" "$work/c.ppm" && problem '--tone none changes nothing'
expect 0 "$lavaray" render -q "$work/toned.yaml" -o "$work/a.exr" --tone none
expect 0 "$lavaray" render -q "$work/toned.yaml" -o "$work/b.exr"
grep -qa aces "$work/b.exr" && problem 'an EXR speaks of a tone map'
expect 0 "$lavaray" compare "$work/a.exr" "$work/b.exr"

expect 2 "$lavaray" render -q $cameras -o "$work/x.ppm" --camera back && says err 'back'
expect 4 "$lavaray" render -q $small -o "$work/x.ppm" --device 'no such device'
says err 'no such device'
expect 2 "$lavaray" render -q $small -o "$work/x.ppm" --crop 60,0,10,10
[ ! -e "$work/x.ppm" ] || problem 'a picture in spite of an error'

expect 0 "$lavaray" devices && says out 'taken by --device auto'
expect 0 "$lavaray" devices --json
python3 -c 'import json, sys; d = json.load(open(sys.argv[1])); assert sum(x["auto"] for x in d) == 1' \
    "$work/out" || problem 'devices --json'

# Progress is for terminals.
expect 0 "$lavaray" render $small -o "$work/a.ppm"
grep -q $'[\r\033]' "$work/err" && problem 'progress without a terminal'
command -v script >/dev/null && script -qec true /dev/null </dev/null >/dev/null 2>&1 ||
    { echo 'no pseudo-terminals here: progress is not tested' >&2; finish; }

# on_terminal COLUMNS ENVIRONMENT ARGUMENTS: runs a render on a terminal of this width.
on_terminal() {
    script -qec "stty cols $1; env TERM=xterm $2 '$lavaray' render $small -o '$work/a.ppm' \
        --size 640x480 --spp 4 $3" /dev/null </dev/null >"$work/tty" 2>&1
}
on_terminal 80 A=b ''
for phase in 'reading scene' 'opening device' 'building and compiling' 'tracing \[#'; do
    grep -q "$phase" "$work/tty" || problem "no '$phase' on a terminal"
done
grep -q $'\033\\[36m' "$work/tty" || problem 'no colours on a terminal'
on_terminal 80 NO_COLOR=1 ''
grep -q $'\033\\[[0-9;]*m' "$work/tty" && problem 'colours in spite of NO_COLOR'
grep -q 'tracing \[#' "$work/tty" || problem 'no bar with NO_COLOR'
on_terminal 80 A=b -q
[ ! -s "$work/tty" ] || problem "-q on a terminal prints $(cat -v "$work/tty")"
on_terminal 80 TERM=dumb ''
grep -q $'\033' "$work/tty" && problem 'escape sequences for a dumb terminal'
for columns in 5 12 30 45; do
    on_terminal $columns NO_COLOR=1 ''
    # Only what overwrites itself has to fit.
    tr '\r' '\n' <"$work/tty" | sed 's/\x1b\[K//g' | grep -v wrote |
        awk -v max=$columns 'length >= max { exit 1 }' || problem "the bar is too wide for $columns"
done
finish
