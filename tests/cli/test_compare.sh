# lavaray compare: exit codes, what is said, JSON, heat maps, masks, bad input. Needs no device.
. tests/cli/lib.sh
lavaray=$LAVARAY
# picture NAME R,G,B [X,Y,R,G,B]...: 64 x 48 pixels of one colour, and single pixels of others.
picture() {
    python3 - "$work/$1" "${@:2}" <<'END'
import sys
colors = [[int(v) for v in a.split(",")] for a in sys.argv[2:]]
pixels = bytearray(bytes(colors[0]) * (64 * 48))
for x, y, *rgb in colors[1:]:
    pixels[3 * (64 * y + x):3 * (64 * y + x) + 3] = bytes(rgb)
open(sys.argv[1], "wb").write(b"P6\n64 48\n255\n" + pixels)
END
}
picture a.ppm 100,150,200
picture b.ppm 100,150,200 10,20,100,151,200 40,30,90,150,200
picture mask.ppm 255,255,255 10,20,0,0,0 40,30,0,0,0
head -c 3000 "$work/a.ppm" >"$work/short.ppm"
printf 'P6\n64 47\n255\n' >"$work/small.ppm" && head -c 9024 /dev/zero >>"$work/small.ppm"
a=$work/a.ppm b=$work/b.ppm

expect 0 "$lavaray" compare "$a" "$a" && says out '^same: .*64 x 48 pixels$'
expect 1 "$lavaray" compare "$a" "$b"
says out '^DIFFERENT: '
says out 'FAIL +exact +2 pixels \(0\.0651 %\)'
says out 'first difference at 10,20: 100 151 200 instead of 100 150 200'
says out 'largest at 40,30: 0\.03922 in red'
says out '^  2 regions differ'
[ ! -s "$work/err" ] || problem "compare prints on stderr: $(cat "$work/err")"
expect 1 "$lavaray" compare -q "$a" "$b" && [ ! -s "$work/out" ] || problem 'compare -q prints'
expect 0 "$lavaray" compare "$a" "$b" --max-abs 10/255 && says out '^within limits'
expect 1 "$lavaray" compare "$a" "$b" --max-abs 9/255
expect 0 "$lavaray" compare "$a" "$b" --abs 0 --abs-percent 0.07
expect 1 "$lavaray" compare "$a" "$b" --abs 0 --abs-percent 0.06
expect 1 "$lavaray" compare "$a" "$b" --max-abs 10/255 --exact # any of them
expect 0 "$lavaray" compare "$a" "$b" --rmse 0.001 --psnr 40 --ssim 0.99 --flip-mean 0.001 --flip-p99 0.1
for name in rmse psnr ssim flip-mean flip-p99; do says out "ok +$name "; done
expect 1 "$lavaray" compare "$a" "$b" --flip-max 0.0001 && says out 'FAIL +flip-max'
expect 0 "$lavaray" compare "$a" "$b" --mask "$work/mask.ppm" && says out '2 pixels are masked'
expect 0 "$lavaray" compare "$a" "$b" --ignore 10,20,1,1 --ignore 39,29,900,900
expect 1 "$lavaray" compare "$a" "$b" --ignore 10,20,1,1
"$lavaray" compare - "$a" <"$a" >/dev/null || problem 'compare does not read standard input'

# Sizes are a difference, not an error; what cannot be read is one.
expect 1 "$lavaray" compare "$a" "$work/small.ppm"
says out 'sizes differ: the reference has 64 x 48 pixels, the test 64 x 47'
expect 1 "$lavaray" compare "$a" "$work/small.ppm" --rmse 1000
for bad in short.ppm missing.ppm .; do
    expect 5 "$lavaray" compare "$a" "$work/$bad" && one_line
    says err "$bad"
done
expect 2 "$lavaray" compare "$a" "$b" --mask "$work/small.ppm" && says err 'small\.ppm: has 64 x 47 pixels, but .*a\.ppm has 64 x 48'
expect 2 "$lavaray" compare "$a" "$b" --ignore 0,0,64,48 && one_line && says err 'nothing is left to compare'
for flag in fail:abs failpercent:abs-percent hardfail:max-abs; do # idiff's
    expect 2 "$lavaray" compare "$a" "$b" --"${flag%:*}" 1 && says err "did you mean --${flag#*:}\?"
done
mapfile -t many < <(yes -- --ignore=0,0,1,1 | head -n 65)
expect 2 "$lavaray" compare "$a" "$b" "${many[@]}" && one_line && says err '--ignore is given more than 64 times'
expect 5 "$lavaray" compare "$a" "$b" --mask "$work/missing.ppm"

# JSON.
expect 1 "$lavaray" compare "$a" "$b" --json - --rmse 1 --exact --psnr 10
python3 - "$work/out" <<'END' || problem 'wrong JSON'
import json, sys
r = json.load(open(sys.argv[1]))
assert r["pass"] is False and r["same_size"] is True and r["size"] == [64, 48]
assert r["metrics"]["exact"]["pass"] is False and r["metrics"]["exact"]["pixels"] == 2
assert r["metrics"]["rmse"]["pass"] is True and r["metrics"]["rmse"]["limit"] == 1
assert abs(r["metrics"]["rmse"]["value"] - (101 / 255**2 / (64 * 48 * 3)) ** 0.5) < 1e-9
assert r["difference"]["first"] == {"pixel": [10, 20], "reference": [100, 150, 200], "test": [100, 151, 200]}
assert r["difference"]["largest"]["pixel"] == [40, 30] and r["difference"]["largest"]["channel"] == "red"
assert r["regions"]["count"] == 2 and r["regions"]["largest"][0]["x"] == 40
assert r["cause"]["name"] == "local"
END
expect 0 "$lavaray" compare "$a" "$a" --psnr 90 --json "$work/same.json" && says out '^same'
python3 -c 'import json, sys; r = json.load(open(sys.argv[1])); assert r["pass"] and r["metrics"]["psnr"]["value"] is None' \
    "$work/same.json" || problem 'wrong JSON of equal pictures'
expect 1 "$lavaray" compare "$a" "$work/small.ppm" --json -
python3 -c 'import json, sys; r = json.load(open(sys.argv[1])); assert not r["same_size"] and r["test_size"] == [64, 47]' \
    "$work/out" || problem 'wrong JSON of sizes'

# Heat maps.
expect 1 "$lavaray" compare "$a" "$b" -d "$work/diff.ppm"
head -n 2 "$work/diff.ppm" | grep -aq '^64 48$' || problem 'a narrow heat map has a scale'
expect 1 "$lavaray" compare "$a" "$b" --ignore 0,0,1,1 --diff "$work/diff.pfm"
python3 - "$work/diff.pfm" <<'END' || problem 'wrong error map'
import struct, sys
data = open(sys.argv[1], "rb").read()
values = struct.unpack("<%df" % (64 * 48 * 3), data[-64 * 48 * 12:])
at = lambda x, y: values[3 * (64 * (47 - y) + x)]
assert at(0, 0) == -1 and at(1, 0) == 0
assert abs(at(10, 20) - 1 / 255) < 1e-7 and abs(at(40, 30) - 10 / 255) < 1e-7
END
expect 1 "$lavaray" compare "$a" "$work/small.ppm" --diff "$work/none.png" && says err 'not written'
[ ! -e "$work/none.png" ] || problem 'a heat map of different sizes'

# Noise: pictures of 64 x 48 floats with a standard deviation of 0.1 around 1 and 1.02.
python3 - "$work" <<'END'
import random, struct, sys
random.seed(3)
def write(name, mean, deviation):
    values = [random.gauss(mean, deviation) for _ in range(64 * 48 * 3)]
    with open(sys.argv[1] + "/" + name + ".pfm", "wb") as file:
        file.write(b"PF\n64 48\n-1\n" + struct.pack("<%df" % len(values), *values))
for name in "a1", "a2", "b1", "b2":
    write(name, 1, 0.1)
write("c1", 1.02, 0.1)
write("c2", 1.02, 0.1)
write("v", 0.01, 0)
END
cd "$work" || exit 1
expect 0 "$lavaray" compare a1.pfm b1.pfm --noise 0.001 --reference-half a2.pfm --test-half b2.pfm
says out 'noise explains all'
expect 1 "$lavaray" compare a1.pfm c1.pfm --noise 0.001 --reference-half a2.pfm --test-half c2.pfm
says out 'FAIL +noise'
says out 'does not explain 64 x 48 pixels at 0,0: [0-9.]+ standard deviations'
expect 0 "$lavaray" compare a1.pfm b1.pfm --noise 0.001 --reference-variance v.pfm --test-variance v.pfm
expect 1 "$lavaray" compare a1.pfm c1.pfm --noise 0.001 --reference-variance v.pfm --test-variance v.pfm \
    --diff z.pfm --json - && says out '"standard_deviations"'
expect 1 "$lavaray" compare a1.pfm b1.pfm --noise 0.001 --test-variance v.pfm # too little noise
expect 2 "$lavaray" compare a1.pfm b1.pfm --noise 0.001 --test-variance small.ppm
says err 'small\.ppm: has 64 x 47 pixels'
cd "$OLDPWD" || exit 1

# Mistakes.
wrong() {
    local pattern=$1
    shift
    expect 2 "$lavaray" compare "$@" || return
    says err "$pattern"
    says err 'see lavaray compare --help'
    one_line
}
wrong 'expected REF TEST' "$a"
wrong 'one too many' "$a" "$b" "$b"
wrong 'did you mean --rmse' "$a" "$b" --rmsd 1
wrong 'did you mean --abs-percent' "$a" "$b" --failpercent 1
wrong '--rmse: expected a number from 0 up' "$a" "$b" --rmse=-1
wrong '--ssim: expected a number from 0 to 1' "$a" "$b" --ssim 1.5
wrong '--noise: expected a probability' "$a" "$b" --noise 1
wrong '--noise goes with' "$a" "$b" --noise 0.01
wrong '--noise goes with' "$a" "$b" --test-variance "$a"
wrong 'do not go together' "$a" "$b" --noise 0.01 --test-variance "$a" --test-half "$b"
wrong 'both --reference-half and' "$a" "$b" --noise 0.01 --test-half "$b"
wrong 'abs-percent goes with' "$a" "$b" --abs-percent 1
wrong 'X,Y,W,H in pixels' "$a" "$b" --ignore 1,2,3
wrong 'end in' "$a" "$b" --diff "$work/x.gif"
wrong 'would replace a picture' "$a" "$b" --diff "$b"
wrong 'would replace a picture' "$a" "$b" --json "$a"
wrong 'from standard input' - -
wrong 'same name' "$a" "$b" --json "$work/x.png" --diff "$work/x.png"
expect 5 "$lavaray" compare "$a" "$b" --diff "$work/no/x.png" && says err 'no/x\.png'
same "$a" "$work/a.ppm"
finish
