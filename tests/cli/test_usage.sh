# The command line itself: help, mistakes and what is said about them. Needs no device.
. tests/cli/lib.sh
lavaray=$LAVARAY
out=$work/x.ppm

expect 0 "$lavaray" --version && says out '^lavaray [0-9]+\.[0-9]+\.[0-9]+$'
for words in --help help -h; do
    expect 0 "$lavaray" "$words" && says out '^Exit codes:'
done
for command in render merge explain devices doctor validate info convert schema compare; do
    expect 0 "$lavaray" "$command" --help && says out "^Usage: lavaray $command"
    [ ! -s "$work/err" ] || problem "$command --help prints on stderr"
    awk 'length > 80 { exit 1 }' "$work/out" || problem "$command --help is wider than 80 columns"
    expect 0 "$lavaray" help "$command"
done
expect 0 "$lavaray" render --help
says out '^For tests: the picture does not depend on these:'
for flag in output format size spp depth seed maxval transfer half exposure tone white denoise camera crop \
    sample-range time noise checkpoint device stats quiet \
    verbose tile chunk storage-loads; do
    says out "--$flag( |$)"
done

expect 2 "$lavaray" && says err '^Usage'
expect 2 "$lavaray" rendr && says err "did you mean 'render'"
expect 2 "$lavaray" help rendr && says err "did you mean 'render'"
expect 2 "$lavaray" frobnicate && says err 'see lavaray --help'
expect 2 "$lavaray" --frobnicate && says err "unknown flag '--frobnicate'"

# wrong PATTERN ARGUMENTS...: one line that says so and where help is.
wrong() {
    local pattern=$1
    shift
    expect 2 "$lavaray" "$@" || return
    says err "$pattern"
    says err 'see lavaray [a-z]+ --help'
    one_line
}
wrong 'did you mean --size' render $small -o "$out" --sise 3x3
wrong 'did you mean --spp' render $small -o "$out" --samples 3
wrong 'did you mean --exposure' render $small -o "$out" --expo 3
wrong "unknown flag '-z'" render $small -o "$out" -z
wrong "unknown flag '--frobnicate'" render $small -o "$out" --frobnicate
wrong 'no scene given' render -o "$out"
wrong 'one scene at a time' render $small $small -o "$out"
wrong 'where to' render $small
wrong '\.ppm, \.png, \.pfm or \.exr' render $small -o "$work/x.gif"
wrong '\.ppm, \.png, \.pfm or \.exr' render $small -o "$work/ppm"
wrong '--output needs a value' render $small -o
wrong '--output needs a value' render $small -o --spp 4
wrong '--spp is given twice' render $small -o "$out" --spp 4 --spp=5
wrong '--quiet takes no value' render $small -o "$out" --quiet=1
wrong 'from 1 to 65536' render $small -o "$out" --spp 0
wrong 'from 1 to 65536' render $small -o "$out" --spp 65537
wrong 'from 1 to 65536' render $small -o "$out" --spp 1e3
wrong 'from 1 to 65536' render $small -o "$out" --spp ''
wrong 'from 1 to 65536' render $small -o "$out" --spp 99999999999999999999
wrong 'from 0 to 64' render $small -o "$out" --depth -1
wrong 'from 0 to 4294967295' render $small -o "$out" --seed 4294967296
wrong 'from -64 to 64' render $small -o "$out" --exposure nan
wrong 'from -64 to 64' render $small -o "$out" --exposure 65
wrong 'such as 640x480' render $small -o "$out" --size 640
wrong 'such as 640x480' render $small -o "$out" --size 640x480x2
wrong 'such as 640x480' render $small -o "$out" --size 0x480
wrong 'such as 640x480' render $small -o "$out" --size 40000x480
wrong 'such as 10,20,64,48' render $small -o "$out" --crop 1,2,3
wrong 'such as 10,20,64,48' render $small -o "$out" --crop 1,2,3,0
wrong 'srgb\|linear' render $small -o "$out" --transfer sRGB
wrong 'contradict' render $small -o "$out" -q -v
wrong '255 or 65535' render $small -o "$work/x.png" --maxval 1000
wrong 'from 1 to 65535' render $small -o "$out" --maxval 65536
wrong 'PFM' render $small -o "$work/x.pfm" --maxval 255
wrong 'PFM' render $small -o "$work/x.pfm" --transfer srgb
wrong 'EXR' render $small -o "$work/x.exr" --maxval 255
wrong 'EXR' render $small -o "$work/x.exr" --transfer srgb
wrong 'for EXR alone' render $small -o "$out" --half
wrong 'none\|reinhard\|aces\|agx' render $small -o "$out" --tone filmic
wrong 'not for PFM and EXR' render $small -o "$work/x.exr" --tone aces
wrong 'not for PFM and EXR' render $small -o - --format pfm --tone agx
wrong 'from 1667 to 25000' render $small -o "$out" --white 1666
wrong 'did you mean --tone' render $small -o "$out" --tonemap aces
wrong 'for EXR alone' render $small -o "$work/x.exr" --format ppm --half
wrong 'must be ppm\|png\|pfm\|exr' render $small -o - --format jpg
wrong 'standard output' render $small -o - --stats -
wrong 'same name' render $small -o "$out" --stats "$out"
wrong "unexpected 'x'" devices x
wrong 'do not go together' devices --json --self-test
wrong 'no scene given' validate
ln -s "$PWD/$small" "$work/scene.ppm"
wrong 'replace the scene' render "$work/scene.ppm" -o "$work/scene.ppm"
rm "$work/scene.ppm" "$work/out" "$work/err"
nothing_in "$work"

expect 0 "$lavaray" validate $small && says out ': ok, 3 objects, 1 light, '
expect 0 "$lavaray" validate -q $small && [ ! -s "$work/out" ] || problem 'validate -q prints'
expect 3 "$lavaray" validate $small $scenes/bad.yaml
says out ': ok' && says err 'bad\.yaml:1:' && says err 'bad\.yaml:3:'
expect 5 "$lavaray" validate "$work/missing.yaml" && says err 'missing\.yaml'
expect 5 "$lavaray" validate "$work" && says err 'folder'
"$lavaray" validate - <$small >/dev/null || problem 'validate - does not read standard input'
expect 5 "$lavaray" validate -- --quiet # a file of this name, not a flag
says err 'quiet'
expect 0 "$lavaray" schema
python3 -m json.tool "$work/out" >/dev/null || problem 'the schema is no JSON'
finish
