# One picture, whatever the threads, tiles and chunks. LAVARAY_RERUNS: how often one
# picture is rendered again (20).
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
unset LAVARAY_VALIDATION # it would only cost time here
size=48x36

# hash_of ARGUMENTS...: of a render's linear pixels; says why when there is none.
hash_of() {
    timeout -s KILL 120 "$lavaray" render -q -o "$work/hash.pfm" --stats - "$@" >"$work/stats" &&
        sha256_in "$work/stats" || echo "no picture"
}
# agree EXPECTED NAME ARGUMENTS...
agree() {
    local expected=$1 name=$2 got
    shift 2
    got=$(hash_of "$@")
    [ "$got" = "$expected" ] || problem "$name: $got instead of $expected"
}

for scene in scenes/*.yaml $scenes/small.yaml $scenes/two-cameras.yaml; do
    [ -f "$scene" ] || continue
    flags="$scene --size $size --spp 2"
    expected=$(LP_NUM_THREADS=2 hash_of $flags)
    [ "$expected" != 'no picture' ] || { problem "$scene: no picture"; continue; }
    for threads in 1 8; do
        LP_NUM_THREADS=$threads agree "$expected" "$scene, $threads threads" $flags
    done
    agree "$expected" "$scene, tiles of 8" $flags --tile 8
    agree "$expected" "$scene, tiles of 17, chunks of 500" $flags --tile 17 --chunk 500
    agree "$expected" "$scene, chunks of 4096" $flags --chunk 4096
    agree "$expected" "$scene, storage loads" $flags --storage-loads
done

flags="$small --size $size --spp 2"
expected=$(hash_of $flags)
for run in $(seq "${LAVARAY_RERUNS:-20}"); do
    agree "$expected" "run $run of $small" $flags
done

# A crop is a part of the whole, sample for sample.
"$lavaray" render -q $small -o "$work/whole.ppm"
"$lavaray" render -q $small -o "$work/part.ppm" --crop 20,10,30,25
pamcut -left 20 -top 10 -width 30 -height 25 "$work/whole.ppm" >"$work/cut.ppm"
same "$work/part.ppm" "$work/cut.ppm"
"$lavaray" render -q $small -o "$work/part.ppm" --crop 63,47,1,1 --tile 8
pamcut -left 63 -top 47 -width 1 -height 1 "$work/whole.ppm" >"$work/cut.ppm"
same "$work/part.ppm" "$work/cut.ppm"

# The built-in scenes: exit code 1 when a hash is not the known one.
expect 0 "$lavaray" devices --self-test || cat "$work/out" >&2
finish
