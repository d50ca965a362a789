# Two minutes of a moving camera leave the memory as it was, and a window that has nothing to do does
# nothing.
. tests/preview/lib.sh
unset LAVARAY_VALIDATION # the layer keeps records
start_display
duration=${LAVARAY_VIEW_SECONDS:-120}

# drive.py PROCESS WINDOW SECONDS LIMIT: moves the camera and reads the resident memory four times a
# second. The first third is for buffers and allocators to find their sizes. Growth is then the
# difference of the medians of the second and the last third, so peaks of single pictures do not count;
# it may be LIMIT KiB, which allocators keep or return by chance (up to 1.5 MiB was seen on a machine that
# did much else), or 1 MiB an hour where that is more. A leak of 6 KiB a picture, at 18 pictures a second,
# is more in the 40 s between the two. LAVARAY_VIEW_SECONDS=3600 sees smaller ones.
cat >"$work/drive.py" <<'END_OF_PYTHON'
import itertools, random, re, statistics, subprocess, sys, time

process, window, duration, limit = sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4])

def resident():
    with open("/proc/%s/status" % process) as file:
        return int(re.search(r"VmRSS:\s*(\d+)", file.read())[1])

def move(round):
    steps = []
    for i in range(12):
        x = 100 + (round * 7 + i * 5) % 120
        y = 80 + (round * 3 + i * 3) % 80
        steps += ["mousemove", "--window", window, str(x), str(y), "sleep", "0.02"]
    button = "123"[round % 3]
    wheel = "45"[round // 2 % 2]
    subprocess.run(["xdotool", "mousedown", button, *steps, "mouseup", button, "click", wheel,
                    *(["key", "r"] if round % 10 == 9 else [])], check=True)

start = time.monotonic()
samples = []
for round in itertools.count():
    now = time.monotonic() - start
    if now > duration:
        break
    move(round)
    samples.append((now, resident()))

third = len(samples) // 3
middle, last = samples[third:2 * third], samples[2 * third:]
growth = statistics.median(r for _, r in last) - statistics.median(r for _, r in middle)
hours = (statistics.median(t for t, _ in last) - statistics.median(t for t, _ in middle)) / 3600
pairs = random.Random(1).choices(samples[third:], k=4000), random.Random(2).choices(samples[third:], k=4000)
slope = statistics.median((b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(*pairs) if a[0] != b[0])
print("%d samples in %.0f s, %d KiB in the middle, %+d KiB after; median slope %+.0f KiB an hour" % (
    len(samples), duration, statistics.median(r for _, r in middle), growth, slope * 3600))
sys.exit(growth > max(limit, 1024 * hours))
END_OF_PYTHON

view scenes/showcase.yaml --size 320x240
files=$(ls "/proc/$view_process/fd" | wc -l)
threads=$(ls "/proc/$view_process/task" | wc -l)
pictures_before=$(count ' shown ')
python3 "$work/drive.py" "$view_process" "$window" "$duration" 4096 || problem 'memory grew'
echo "$(($(count ' shown ') - pictures_before)) pictures"
[ "$(ls "/proc/$view_process/fd" | wc -l)" -le "$((files + 1))" ] || problem 'files stay open'
[ "$(ls "/proc/$view_process/task" | wc -l)" -le "$((threads + 1))" ] || problem 'threads stay'

# ticks: hundredths of a second that all threads have computed.
ticks() {
    awk '{print $14 + $15}' "/proc/$view_process/stat"
}

# rests: over five seconds it computes less than 0.05.
rests() {
    local before
    before=$(ticks)
    sleep 5
    local spent=$(($(ticks) - before))
    [ "$spent" -lt 5 ] || problem "$1, it computed ${spent}0 ms in 5 s"
}

press r
settle
sleep 4.5 # until a message would be gone
rests 'with its picture finished'
quit

launch scenes/showcase.yaml --size 640x480 --spp 65536
await 60 find_window && await 60 more ' shown ' 3
xdotool windowminimize "$window"
await 20 hidden
sleep 0.5
rests 'minimised'
kill -TERM "$view_process"
ended 20 130
finish
