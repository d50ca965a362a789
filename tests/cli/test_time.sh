# --time: whole samples until the time is up, and the bytes of --spp that many.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
args=(render $small -q --integrator path --size 60x44)

# samples FILE: how many the statistics tell of.
samples() {
    python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["picture"]["samples"])' "$1"
}

for time in 1ms 0.8s; do
    expect 0 "$lavaray" "${args[@]}" -o "$work/timed.png" --time $time --stats "$work/stats.json"
    reached=$(samples "$work/stats.json")
    expect 0 "$lavaray" "${args[@]}" -o "$work/counted.png" --spp "$reached"
    same "$work/timed.png" "$work/counted.png"
    [ $time = 1ms ] && [ "$reached" != 1 ] && problem "$reached samples in a millisecond"
done
[ "$reached" -gt 1 ] || problem "one sample in $time"
expect 0 "$lavaray" "${args[@]}" -o "$work/timed.png" --time 2h --spp 5 --stats "$work/stats.json"
[ "$(samples "$work/stats.json")" = 5 ] || problem "$(samples "$work/stats.json") samples instead of 5"

# wrong PATTERN ARGUMENTS...
wrong() {
    local pattern=$1
    shift
    expect 2 "$lavaray" render $small -o "$work/x.exr" "$@" && says err "$pattern" && one_line
}
for time in 5 5d -1s 0s s 1e3s '' 1..5s; do
    wrong 'such as 500ms' --time "$time"
done
wrong 'needs --integrator path' --time 1s
wrong 'neither --checkpoint nor' --time 1s --integrator path --checkpoint "$work/c"
wrong 'neither --checkpoint nor' --time 1s --integrator path --sample-range 0-1
finish
