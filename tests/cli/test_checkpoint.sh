# Checkpoints: a render that was killed, interrupted or ran out of disk goes on to the same bytes.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
folder=$work/folder
mkdir "$folder"
args=(render $small --size 160x120 --spp 96)

"$lavaray" "${args[@]}" -q -o "$work/one.png" || problem 'the render to compare with'
"$lavaray" "${args[@]}" -q -o "$folder/x.png" --checkpoint "$folder/c" || problem 'an undisturbed render'
same "$work/one.png" "$folder/x.png"
[ "$(ls -A "$folder")" = x.png ] || problem "left behind: $(ls -A "$folder")"
rm "$folder/x.png"

# Killed as soon as there is a checkpoint, and while later ones are being written, over and over; each run
# goes on from the one before, with other tiles.
cat >"$work/kill.py" <<'PY'
import os, subprocess, sys, time

checkpoint, delay, command = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
def state():
    try:
        info = os.stat(checkpoint)
        return info.st_ino, info.st_mtime_ns
    except FileNotFoundError:
        return None
before = state()
process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
while process.poll() is None and state() == before:
    time.sleep(0.002)
time.sleep(delay)
process.kill()
print(process.wait())
PY
kills=0
for tile in 0 7 32 50 64 13; do
    tiles=()
    [ $tile = 0 ] || tiles=(--tile $tile)
    code=$(python3 "$work/kill.py" "$folder/c" 0.0$tile "$lavaray" "${args[@]}" -q -o "$folder/x.png" \
        --checkpoint "$folder/c" --checkpoint-seconds 0.01 "${tiles[@]}")
    [ "$code" != -9 ] || kills=$((kills + 1))
    [ "$code" != 0 ] || break
    [ ! -e "$folder/x.png" ] || problem 'a picture of a killed render'
done
[ $kills -ge 3 ] || problem "only $kills renders could be killed"
rm -f "$folder"/.lavaray-*.tmp # of renders killed while they wrote
if [ ! -e "$folder/x.png" ]; then
    expect 0 "$lavaray" "${args[@]}" -v -o "$folder/x.png" --checkpoint "$folder/c" --stats "$work/stats.json"
    says err 'of the samples are from the checkpoint'
    python3 -c 'import json, sys; r = json.load(open(sys.argv[1]))["rays"]
assert 0 < r["resumed"] < 1 and r["primary"]["traced"] < 160 * 120 * 96, r' "$work/stats.json" ||
        problem 'the statistics of a render that went on'
fi
same "$work/one.png" "$folder/x.png"
[ "$(ls -A "$folder")" = x.png ] || problem "left behind: $(ls -A "$folder")"
rm "$folder/x.png"

# Ctrl-C, then parts: a part has its checkpoints as well.
# interrupted FLAGS...: leaves a checkpoint at $folder/c behind.
interrupted() {
    cat >"$work/interrupt.py" <<'PY'
import os, signal, subprocess, sys, time

checkpoint, command = sys.argv[1], sys.argv[2:]
process = subprocess.Popen(command, stderr=subprocess.PIPE,
    preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
while process.poll() is None and not os.path.exists(checkpoint):
    time.sleep(0.002)
process.send_signal(signal.SIGINT)
print(process.communicate()[1].decode().strip())
sys.exit(process.returncode)
PY
    expect 130 python3 "$work/interrupt.py" "$folder/c" "$lavaray" "${args[@]}" -q --checkpoint "$folder/c" \
        --checkpoint-seconds 0.01 "$@"
    says out "interrupted; $folder/c holds what has been traced"
}
for integrator in whitted path; do
    flags=(--integrator $integrator)
    "$lavaray" "${args[@]}" "${flags[@]}" -q -o "$work/one.png"
    interrupted -o "$folder/x.exr" --sample-range 0-79 "${flags[@]}"
    expect 5 "$lavaray" merge "$folder/c" -o "$folder/x.png" && says err 'not finished'
    expect 0 "$lavaray" "${args[@]}" "${flags[@]}" -q -o "$folder/x.exr" --sample-range 0-79 \
        --checkpoint "$folder/c"
    expect 0 "$lavaray" "${args[@]}" "${flags[@]}" -q -o "$folder/y.exr" --sample-range 80-95
    expect 0 "$lavaray" merge -q "$folder"/{y,x}.exr -o "$folder/x.png"
    same "$work/one.png" "$folder/x.png"
    rm "$folder"/*
done

# A checkpoint of something else is refused, and stays.
interrupted -o "$folder/x.png"
cp "$folder/c" "$work/kept"
# no PATTERN ARGUMENTS...
no() {
    local pattern=$1
    shift
    expect 5 "$lavaray" "$@" -o "$folder/x.png" --checkpoint "$folder/c" && says err "$pattern" && one_line
    same "$work/kept" "$folder/c"
}
no 'other settings: samples 0-95 of .*depth 5.*this is .*depth 2' "${args[@]}" --depth 2
no 'other settings.*this is samples 3-7' "${args[@]}" --sample-range 3-7 --format exr
no 'other settings' "${args[@]}" --crop 0,0,10,10
no 'another scene' render $scenes/two-cameras.yaml --size 160x120 --spp 96
printf 'no checkpoint' >"$folder/c"
cp "$folder/c" "$work/kept"
no 'the checkpoint .*no EXR file; name another file, or delete it' "${args[@]}"
rm "$folder"/*

# A checkpoint that cannot be written does not end the render: the file may have 200 KiB here.
(
    trap '' XFSZ
    ulimit -f 200
    expect 0 "$lavaray" "${args[@]}" -q -o "$folder/x.png" --checkpoint "$folder/c" --checkpoint-seconds 0.01
    says err 'the checkpoint could not be written: .*folder/c'
    [ $failures = 0 ]
) || problem 'a checkpoint that is too large'
"$lavaray" "${args[@]}" -q -o "$work/one.png"
same "$work/one.png" "$folder/x.png"
[ "$(ls -A "$folder")" = x.png ] || problem "left behind: $(ls -A "$folder")"
rm "$folder/x.png"

expect 5 "$lavaray" "${args[@]}" -o "$folder/x.png" --checkpoint /dev/null && says err 'no regular file'
expect 2 "$lavaray" "${args[@]}" -o "$folder/x.png" --checkpoint "$folder/x.png" && says err 'name of its own'
expect 2 "$lavaray" "${args[@]}" -o "$folder/x.png" --checkpoint - && says err 'needs a file'
expect 2 "$lavaray" "${args[@]}" -o "$folder/x.png" --checkpoint $small && says err 'replace the scene'
expect 5 "$lavaray" "${args[@]}" -o "$folder/x.png" --checkpoint "$work/none/c" && says err 'none'
nothing_in "$folder"
finish
