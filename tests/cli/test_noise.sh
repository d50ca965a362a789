# --noise: which blocks stop is worked out again here, from pictures of fixed numbers of samples.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
args=(render $small -q --integrator path --size 130x100)
noise=0.05
most=200

for samples in 8 16 32 64 128 $most; do
    "$lavaray" "${args[@]}" -o "$work/$samples.pfm" --spp $samples || problem "$samples samples"
done
expect 0 "$lavaray" "${args[@]}" -o "$work/noise.pfm" --noise $noise --spp $most --stats "$work/stats.json"
for flags in '--tile 7' '--tile 16 --chunk 500' '--tile 1000 --storage-loads'; do
    expect 0 "$lavaray" "${args[@]}" -o "$work/other.pfm" --noise $noise --spp $most $flags
    same "$work/noise.pfm" "$work/other.pfm"
done

cat >"$work/judge.py" <<'PY'
import json, struct, sys

folder, noise, most = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
width, height, block, border = 130, 100, 16, 8

def read(name):
    data = open(f'{folder}/{name}.pfm', 'rb').read()[-12 * width * height:]
    values = struct.unpack(f'<{3 * width * height}f', data)
    pixels = [values[i:i + 3] for i in range(0, len(values), 3)]
    return [pixels[(height - 1 - y) * width:(height - y) * width] for y in range(height)]

levels = [8, 16, 32, 64, 128, most]
pictures = {n: read(n) for n in levels}
count = [[8] * width for _ in range(height)]
blocks = [(x, y) for y in range(0, height, block) for x in range(0, width, block)]
going = set(blocks)
def clip(value, end): return max(0, min(value, end))
for last, level in zip(levels, levels[1:]):
    for x0, y0 in going:
        for y in range(y0, min(y0 + block, height)):
            for x in range(x0, min(x0 + block, width)):
                count[y][x] = level
    if level == most:
        break
    stopped = set()
    for x0, y0 in going:
        total = number = 0
        for y in range(clip(y0 - border, height), clip(y0 + block + border, height)):
            for x in range(clip(x0 - border, width), clip(x0 + block + border, width)):
                n = count[y][x]
                whole, half = pictures[n][y][x], pictures[n // 2][y][x]
                total += sum((a - b) ** 2 for a, b in zip(whole, half)) / max(sum(whole) / 3, 1e-4)
                number += 3
        if total / number < noise ** 2:
            stopped.add((x0, y0))
    going -= stopped
picture = read('noise')
wrong = [(x, y) for y in range(height) for x in range(width) if picture[y][x] != pictures[count[y][x]][y][x]]
assert not wrong, (len(wrong), wrong[:3])
flat = [n for row in count for n in row]
traced = json.load(open(f'{folder}/stats.json'))['picture']['samples_traced']
assert abs(traced['mean'] - sum(flat) / len(flat)) < 1e-6, traced
assert (traced['least'], traced['most']) == (min(flat), max(flat)), traced
assert len(set(flat)) >= 3, set(flat)
print(sorted((n, flat.count(n)) for n in set(flat)))
PY
expect 0 python3 "$work/judge.py" "$work" $noise $most && cat "$work/out"

# No noise to speak of: all samples; any will do: the first decision.
expect 0 "$lavaray" "${args[@]}" -o "$work/other.pfm" --noise 0.000001 --spp 64
same "$work/other.pfm" "$work/64.pfm"
expect 0 "$lavaray" "${args[@]}" -o "$work/other.pfm" --noise 1 --spp 64
same "$work/other.pfm" "$work/16.pfm"
expect 0 "$lavaray" "${args[@]}" -o "$work/other.pfm" --noise 1 --spp 8
same "$work/other.pfm" "$work/8.pfm"

# wrong PATTERN ARGUMENTS...
wrong() {
    local pattern=$1
    shift
    expect 2 "$lavaray" render $small -o "$work/x.exr" "$@" && says err "$pattern" && one_line
}
wrong 'from 0 to 1' --noise 2
wrong 'from 0.000001 to 1' --noise 1e-9 --integrator path
wrong 'needs --integrator path' --noise 0.1
for flags in "--checkpoint $work/c" '--sample-range 0-1' '--time 1s'; do
    wrong 'goes with none of' --noise 0.1 --integrator path $flags
done
finish
