# Denoising with a library in place of Open Image Denoise, without one, and with ones that fail.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
shims=$BUILD_DIR/tests/faults
[ -d "$shims/oidn2" ] || { echo 'the libraries in its place are not built' >&2; exit 77; }
folder=$work/folder
mkdir "$folder" "$work/broken"

# with LIBRARIES ARGUMENTS...: a render that finds the libraries of this folder.
with() {
    local libraries=$1
    shift
    env LD_LIBRARY_PATH="$libraries" ${fault:+LAVARAY_FAULT_OIDN=$fault} "$lavaray" render -q $small "$@"
}

expect 0 "$lavaray" render -q $small -o "$work/plain.pfm" --exposure=-1 --stats "$work/plain.json"
for version in 1 2; do
    expect 0 with "$shims/oidn$version" -o "$work/half.pfm" --denoise --stats "$work/half.json"
    same "$work/plain.pfm" "$work/half.pfm" # the library halves
    python3 - "$work/plain.json" "$work/half.json" $version <<'END_OF_CHECK' || problem 'the statistics are wrong'
import json, sys

plain, half = (json.load(open(path))["picture"] for path in sys.argv[1:3])
assert plain["sha256"] == half["sha256"] and "denoised" not in plain
denoised = half["denoised"]
assert denoised["by"] == "Open Image Denoise %s.7.8" % sys.argv[3]
assert len(denoised["sha256"]) == 64 and denoised["sha256"] != plain["sha256"]
assert 0 <= denoised["seconds"] < 60
END_OF_CHECK
done
expect 0 with "$shims/oidn2" -o "$work/x.exr" --denoise
grep -qa 'seed [0-9]*, denoised by Open Image Denoise 2.7.8' "$work/x.exr" || problem 'the file does not say so'
expect 0 "$lavaray" render -q $small -o "$work/y.exr"
grep -qa denoised "$work/y.exr" && problem 'a file says so that is not'

# refused CODE PATTERN LIBRARIES: one message, no picture.
refused() {
    expect "$1" with "$3" -o "$folder/x.png" --denoise || return
    says err "$2"
    one_line
    nothing_in "$folder"
}
for number in 0 1 2; do
    echo 'no library' >"$work/broken/libOpenImageDenoise.so.$number"
done
refused 5 'Open Image Denoise cannot be loaded \(.*broken.*openimagedenoise\.org' "$work/broken"
refused 5 'no function oidnExecuteFilter' "$shims/oidn-incomplete"
fault=device refused 4 'no such device' "$shims/oidn2"
fault=hardware refused 4 'SSE4.1' "$shims/oidn2"
fault=filter refused 4 'no filter RT' "$shims/oidn2"
fault=memory refused 4 'memory' "$shims/oidn2"
expect 0 "$lavaray" render -q $small -o "$work/x.ppm" # without the flag nobody asks for the library

LD_LIBRARY_PATH=$shims/oidn2 LAVARAY_FAULT_OIDN=wait \
    timeout --foreground -s INT 3 "$lavaray" render -q $small -o "$folder/x.png" --denoise 2>"$work/err"
says err '^lavaray: interrupted, nothing written$'
nothing_in "$folder"
finish
