# A scene in motion: in parts, killed and taken up again, by time and noise, while its files change.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
cat >"$work/scene.yaml" <<'END'
camera: {from: {keys: {0: [0, 1, 5], 4: [4, 1, 5]}}, to: [0, 0, 0], shutter: 0.5}
image: {width: 96, height: 64, samples: 24, integrator: path}
lights: [{point: {position: [3, {keys: {0: 2, 2: 6}}, 4], intensity: 40}}]
objects:
  - plane: {offset: -1, material: {color: {image: tiles.png}}}
  - sphere: {radius: 0.5, translate: {keys: {0: [-1, 0, 0], 2: [3, 0, 0]}}}
  - mesh: {file: knot.ply, scale: 0.3, rotate: [{keys: {0: 0, 4: 360}}, 0, 0]}
END
cp scenes/models/knot.ply scenes/pictures/tiles.png "$work"
scene=$work/scene.yaml
folder=$work/folder
mkdir "$folder"

for integrator in path whitted; do
    args=(render "$scene" -q --frame 1 --integrator $integrator)
    "$lavaray" "${args[@]}" -o "$work/one.ppm" || problem 'the render to compare with'
    "$lavaray" render "$scene" -q --frame 2 --integrator $integrator -o "$work/other.ppm" || problem 'frame 2'
    cmp -s "$work/one.ppm" "$work/other.ppm" && problem 'frames are the same'
    expect 0 "$lavaray" "${args[@]}" -o "$folder/b.exr" --sample-range 5-23 --tile 16
    expect 0 "$lavaray" "${args[@]}" -o "$folder/a.exr" --sample-range 0-4
    expect 0 "$lavaray" merge -q "$folder"/{a,b}.exr -o "$folder/x.ppm"
    same "$work/one.ppm" "$folder/x.ppm"
    rm "$folder"/*
done

# In this sample a ray passes a triangle edge-on, and hit it or not by the rays beside it in the packet.
for threads in 2 1 3 5; do
    LP_NUM_THREADS=$threads "$lavaray" render "$scene" -q --frame 1 --sample-range 16-16 -o "$folder/$threads.exr"
    same "$folder/2.exr" "$folder/$threads.exr"
done
rm "$folder"/*

# Killed over and over; each run goes on from the one before, with other tiles.
args=(render "$scene" -q --frame 1 --spp 100)
"$lavaray" "${args[@]}" -o "$work/one.ppm"
cat >"$work/kill.py" <<'PY'
import os, subprocess, sys, time

checkpoint, command = sys.argv[1], sys.argv[2:]
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
time.sleep(0.02)
process.kill()
print(process.wait())
PY
kills=0
for tile in 16 48 13; do
    code=$(python3 "$work/kill.py" "$folder/c" "$lavaray" "${args[@]}" -o "$folder/x.ppm" \
        --checkpoint "$folder/c" --checkpoint-seconds 0.01 --tile $tile)
    [ "$code" != -9 ] || kills=$((kills + 1))
done
[ $kills -ge 1 ] || problem 'no render could be killed'
rm -f "$folder"/.lavaray-*.tmp
sed 's/2: \[3, 0, 0\]/2: [3, 0, 1]/' "$scene" >"$work/changed.yaml"
if [ -e "$folder/c" ]; then
    expect 5 "$lavaray" render "$work/changed.yaml" -q --frame 1 --spp 100 -o "$folder/x.ppm" --checkpoint "$folder/c"
    says err 'a checkpoint of another scene'
fi
expect 0 "$lavaray" "${args[@]}" -o "$folder/x.ppm" --checkpoint "$folder/c"
same "$work/one.ppm" "$folder/x.ppm"
rm "$folder"/*

# As many samples as fit, as many as are needed, and no more than --spp of them.
expect 0 "$lavaray" render "$scene" --frame 1 --time 300ms -o "$work/time.ppm" --stats "$work/stats.json"
samples=$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["picture"]["samples"])' "$work/stats.json")
"$lavaray" render "$scene" -q --frame 1 --spp "$samples" -o "$work/one.ppm"
same "$work/one.ppm" "$work/time.ppm"
expect 0 "$lavaray" render "$scene" -q --frame 1 --noise 0.02 --spp 200 -o "$work/noise.ppm"
expect 0 "$lavaray" render "$scene" -q --frame 1 --noise 0.02 --spp 200 -o "$work/other.ppm" --tile 24
same "$work/noise.ppm" "$work/other.ppm"

# A render goes on with the files that it began with.
args=(render "$scene" -q --frame 1 --spp 200)
"$lavaray" "${args[@]}" -o "$work/one.ppm"
"$lavaray" "${args[@]}" -o "$work/other.ppm" --checkpoint "$folder/c" --checkpoint-seconds 0.01 &
while [ ! -e "$folder/c" ] && kill -0 $! 2>/dev/null; do sleep 0.01; done
mv "$work/knot.ply" "$work/kept.ply" && mv "$work/tiles.png" "$work/kept.png" && sleep 0.3 && printf 'no mesh' >"$work/knot.ply"
sed 's/radius: 0.5/radius: 1/' "$scene" >"$work/changed.yaml" && cp "$work/changed.yaml" "$scene"
wait $! || problem 'a render whose files change'
same "$work/one.ppm" "$work/other.ppm"
mv "$work/kept.ply" "$work/knot.ply" && mv "$work/kept.png" "$work/tiles.png"

# What is told of the motion.
expect 0 "$lavaray" info "$scene" && says out '^  motion     from frame to frame, and while the shutter is open, not of cameras alone$'
expect 0 "$lavaray" info --json "$scene" && says out '"blurs": true'
sed -i 's/shutter: 0.5/shutter: 0/' "$scene"
expect 0 "$lavaray" info "$scene" && says out '^  motion     from frame to frame$'
expect 0 "$lavaray" info $small
grep -q motion "$work/out" && problem 'a scene without keys is in motion'
finish
