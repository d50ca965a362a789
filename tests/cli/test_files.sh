# Where the picture goes, and what happens when it cannot go there.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
folder=$work/folder
mkdir "$folder"

expect 0 "$lavaray" render $small -o "$folder/a.ppm"
says err '^wrote .*/a\.ppm, 64×48, 2 samples, [0-9.]+ Mray/s on .*, [0-9.]+ s$'
one_line
expect 0 "$lavaray" render $small -o "$folder/b.ppm" -q
[ ! -s "$work/err" ] || problem "-q prints: $(cat "$work/err")"
same "$folder/a.ppm" "$folder/b.ppm"

# Flags may stand anywhere and be written in every usual way.
expect 0 "$lavaray" render -q "-o$folder/c.ppm" --spp=2 --depth 5 -- $small
same "$folder/a.ppm" "$folder/c.ppm"
"$lavaray" render -q - -o "$folder/d.ppm" <$small || problem 'cannot read standard input'
same "$folder/a.ppm" "$folder/d.ppm"

# -o - is the picture and nothing else.
expect 0 "$lavaray" render $small -o - -v
same "$folder/a.ppm" "$work/out"
says err '^wrote standard output'

# The formats hold the same picture.
expect 0 "$lavaray" render -q $small -o "$folder/e.png"
pngtopnm "$folder/e.png" >"$work/e.ppm" 2>/dev/null
same "$folder/a.ppm" "$work/e.ppm"
expect 0 "$lavaray" render -q $small -o "$folder/f.pfm"
head -c 2 "$folder/f.pfm" | grep -q PF || problem 'not a PFM'
expect 0 "$lavaray" render -q $small -o "$folder/f.exr" && expect 0 "$lavaray" render -q $small -o - --format exr
same "$folder/f.exr" "$work/out"
expect 0 "$lavaray" render -q $small -o "$folder/h.exr" --half
[ "$(wc -c <"$folder/h.exr")" -lt "$(wc -c <"$folder/f.exr")" ] || problem 'halves take more room than floats'
if command -v exrheader >/dev/null; then
    expect 0 exrheader "$folder/f.exr"
    says out '^displayWindow .*: \(0 0\) - \(63 47\)$' && says out '^    R, 32-bit floating-point, sampling 1 1$'
    expect 0 exrheader "$folder/h.exr" && says out '^    R, 16-bit floating-point, sampling 1 1$'
fi
expect 0 "$lavaray" render -q $small -o "$folder/picture" --format png
same "$folder/e.png" "$folder/picture"
expect 0 "$lavaray" render -q $small -o "$folder/g.ppm" --maxval 65535 --transfer linear
pnmfile "$folder/g.ppm" | grep -q 'maxval 65535' || problem 'not 16 bits'

# A link is written through, its target replaced.
ln -s a.ppm "$folder/link.ppm"
expect 0 "$lavaray" render -q $small -o "$folder/link.ppm"
[ -L "$folder/link.ppm" ] || problem 'the link was replaced'
rm -r "$folder"
mkdir "$folder"

# What cannot be written is said before anything is rendered, and leaves nothing.
refused() {
    local pattern=$1
    shift
    expect 5 "$lavaray" render "$@" || return
    says err "$pattern"
    one_line
}
refused 'No such file' $small -o "$work/none/x.ppm"
refused 'folder' $small -o "$small/x.ppm"
mkdir "$work/is.ppm"
refused 'folder' $small -o "$work/is.ppm"
refused 'No such file' $small -o "$folder/x.ppm" --stats "$work/none/s.json"
expect 5 "$lavaray" render "$work/none.yaml" -o "$folder/x.ppm" && says err 'none\.yaml'
expect 3 "$lavaray" render $scenes/bad.yaml -o "$folder/x.ppm" && says err 'bad\.yaml:1:'
if [ "$(id -u)" -ne 0 ]; then
    chmod 555 "$folder"
    refused 'Permission denied' $small -o "$folder/x.ppm"
    chmod 755 "$folder"
elif command -v setpriv >/dev/null; then
    # Root may write anywhere, so another user tries.
    chmod 755 "$work"
    expect 5 setpriv --reuid 65534 --regid 65534 --clear-groups \
        "$lavaray" render $small -o "$folder/x.ppm" && says err 'Permission denied'
fi
nothing_in "$folder"

ln -s /dev/full "$work/full.ppm"
ln -s /dev/full "$work/full.png"
refused 'No space left' $small -q -o "$work/full.ppm"
refused 'No space left' $small -q -o "$work/full.png"
refused 'No space left' $small -q -o "$work/x.ppm" --stats /dev/full

# failing DESCRIPTION: the script's command, run by sh, must end with 5 and a message in $work/err.
failing() {
    local got=0
    sh -c "$2" sh "$lavaray" $small >/dev/null 2>"$work/err" || got=$?
    [ "$got" -eq 5 ] || problem "$1: exit code $got instead of 5"
    [ -z "${3:-}" ] || says err "$3"
}
failing 'picture to /dev/full' '"$1" render -q "$2" -o - >/dev/full' 'No space left'
failing 'picture to a closed stdout' '"$1" render -q "$2" -o - >&-' 'Bad file descriptor'
failing 'schema to /dev/full' '"$1" schema >/dev/full' 'No space left'
failing 'schema to a closed stdout' '"$1" schema >&-' 'standard output'
failing 'validate to /dev/full' '"$1" validate "$2" >/dev/full' 'standard output'
failing 'help to /dev/full' '"$1" --help >/dev/full' 'No space left'
failing 'devices to /dev/full' '"$1" devices >/dev/full' 'No space left'
failing 'statistics to /dev/full' '"$1" render -q "$2" -o '"$folder"'/x.ppm --stats - >/dev/full' \
    'No space left'
failing 'closed stderr' '"$1" render "$2" -o '"$folder"'/x.ppm 2>&-'
failing 'stderr to /dev/full' '"$1" render "$2" -o '"$folder"'/x.ppm 2>/dev/full'
rm -f "$folder/x.ppm"
sh -c '"$1" render -q "$2" -o "$3" <&- >&- 2>&-' sh "$lavaray" $small "$folder/x.ppm" ||
    problem 'cannot render with all streams closed'
[ "$(head -c 2 "$folder/x.ppm")" = P6 ] || problem 'something else got into the picture'

"$lavaray" render -q $small --size 640x480 --spp 1 -o - 2>"$work/err" | head -c 10 >/dev/null
[ "${PIPESTATUS[0]}" -eq 5 ] || problem 'a closed pipe is no error'
says err 'Broken pipe'
finish
