# Frames: which files they become, and what goes to standard output.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY

cat >"$work/moves.yaml" <<'END'
camera: {from: {keys: {0: [0, 1, 5], 4: [4, 1, 5]}}, shutter: 0.5}
image: {width: 24, height: 16, samples: 4}
objects:
  - plane: {offset: -1}
  - sphere: {material: {color: {keys: {0: red, 4: blue}}}}
END
scene=$work/moves.yaml
root=$PWD
mkdir "$work/frames"
cd "$work/frames" || exit 1
expect 0 "$lavaray" render "$scene" --frames 2-4 -o 'f-%03d.ppm'
says err '^wrote f-003.ppm'
[ "$(ls)" = "f-002.ppm
f-003.ppm
f-004.ppm" ] || problem "other files than the three frames: $(ls)"
for frame in 2 3 4; do
    expect 0 "$lavaray" render -q "$scene" --frame $frame -o "$work/one.ppm"
    same "$work/one.ppm" "f-00$frame.ppm"
done
cmp -s f-002.ppm f-003.ppm && problem 'frames are all the same'
expect 0 "$lavaray" render -q "$scene" --frames 7 -o '%d%%.ppm'
[ -f 7%.ppm ] || problem "no 7%.ppm: $(ls)"

# One behind the other, as video encoders take them.
"$lavaray" render -q "$scene" --frames 2-4 -o - >"$work/stream.ppm" || problem 'no stream'
cat f-002.ppm f-003.ppm f-004.ppm | cmp -s - "$work/stream.ppm" || problem 'the stream is not the frames'
if command -v pamfile >/dev/null; then
    [ "$(pamfile -allimages "$work/stream.ppm" | grep -c '24 by 16')" = 3 ] || problem 'netpbm sees no 3 frames'
fi
# The command lines of docs/scene.md as they stand there: a film of all frames, and one that loses nothing.
if command -v ffmpeg >/dev/null; then
    sed 's/width: 480, height: 300, samples: 64/width: 60, height: 40, samples: 4/' \
        "$root/scenes/animation.yaml" >"$work/scene.yaml"
    grep '^    lavaray render .*| ffmpeg' "$root/docs/scene.md" >"$work/lines"
    [ "$(wc -l <"$work/lines")" = 2 ] || problem 'docs/scene.md has other command lines'
    (
        set -e -o pipefail
        lavaray() { "$LAVARAY" "$@"; }
        cd "$work"
        . "$work/lines"
    ) </dev/null 2>"$work/err" || problem "a command line of docs/scene.md fails: $(tail -n 3 "$work/err")"
    for film in scene.mp4 scene.mkv; do
        ffmpeg -v error -i "$work/$film" -f framecrc - </dev/null >"$work/crc" || problem "$film does not play"
        [ "$(grep -vc '^#' "$work/crc")" = 48 ] || problem "$film has no 48 frames"
    done
    "$lavaray" render -q "$work/scene.yaml" --frames 0-47 -o - >"$work/stream.ppm" || problem 'no stream'
    ffmpeg -v error -i "$work/scene.mkv" -f image2pipe -c:v ppm - </dev/null | cmp -s - "$work/stream.ppm" ||
        problem 'the film is not the frames'
else
    echo 'no ffmpeg: films are not tested' >&2
fi

# What is wrong is said before anything is written.
rm -f -- *
for bad in 4-2 -1 1-2-3 a 1- 1000000; do
    expect 2 "$lavaray" render "$scene" --frames=$bad -o 'f%d.ppm'
    one_line
    says err 'must be A-B, such as 0-47'
done
for name in f.ppm 'f%d-%d.ppm' 'f%s.ppm' 'f%.ppm' 'f%012d.ppm'; do
    expect 2 "$lavaray" render "$scene" --frames 0-1 -o "$name"
    says err 'needs one number: -o frame-%04d.png'
done
expect 2 "$lavaray" render "$scene" --frames 0-1 --frame 3 -o 'f%d.ppm'
expect 2 "$lavaray" render "$scene" --frames 0-1 --stats - -o 'f%d.ppm'
expect 2 "$lavaray" render - --frames 0-1 -o 'f%d.ppm'
says err 'give a file, not -'
expect 2 "$lavaray" render "$scene" --frames 0-1 --format pfm -o -
expect 5 "$lavaray" render "$scene" --frames 0-1 -o "no/f%d.ppm"
expect 5 "$lavaray" render "$scene" --frames 0-1 -o "$(printf '%05000d' 0)%d.ppm"
nothing_in .

cd - >/dev/null || exit 1
expect 0 "$lavaray" render $small --frames 0-1 -o "$work/s%d.ppm"
says err 'all frames are the same'
same "$work/s0.ppm" "$work/s1.ppm"

# Other commands take one frame.
expect 0 "$lavaray" convert "$scene" "$work/at.yaml" --frame 4
says err 'what moves is written as it is in this frame'
expect 0 "$lavaray" render -q "$work/at.yaml" -o "$work/at.ppm"
expect 0 "$lavaray" render -q "$scene" --frame 4 -o "$work/one.ppm"
same "$work/at.ppm" "$work/one.ppm"
finish
