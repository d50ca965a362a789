# Parts of a render and what lavaray merge makes of them: the same bytes as one run, whatever the split
# and the order, and a clear message for everything that is no part or does not belong.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
args=(-q --size 60x44)

# part NAME RANGE FLAGS...: renders samples RANGE of $scene into $work/NAME.exr.
part() {
    local name=$1 range=$2
    shift 2
    "$lavaray" render "$scene" "${args[@]}" -o "$work/$name.exr" --sample-range "$range" "$@" ||
        problem "part $name"
}

scene=$small
for integrator in whitted path; do
    flags=(--spp 9 --integrator $integrator)
    "$lavaray" render "$scene" "${args[@]}" "${flags[@]}" -o "$work/one.png" || problem "$integrator"
    "$lavaray" render "$scene" "${args[@]}" "${flags[@]}" -o "$work/one.pfm" || problem "$integrator"
    part a 0-3 "${flags[@]}"
    part b 4 "${flags[@]}" --tile 7 --chunk 100
    part c 5-8 "${flags[@]}" --storage-loads
    expect 0 "$lavaray" merge "$work"/{c,a,b}.exr -o "$work/merged.png"
    says err '60×44, 9 samples from 3 parts'
    same "$work/merged.png" "$work/one.png"
    expect 0 "$lavaray" merge -q "$work"/{b,c,a}.exr -o "$work/merged.pfm"
    same "$work/merged.pfm" "$work/one.pfm"
    for samples in {0..8}; do
        part "each-$samples" $samples "${flags[@]}"
    done
    expect 0 "$lavaray" merge -q "$work"/each-*.exr -o "$work/merged.png"
    same "$work/merged.png" "$work/one.png"
done

# All that render can do to the file, merge can; the scene's exposure is the default.
scene=$work/exposed.yaml
sed 's/^image: {/&exposure: -1.3, tone: agx, white: 5000, /' $small >"$scene"
grep -q exposure "$scene" || problem 'the scene has no image line'
part a 0-1 --spp 3
part b 2 --spp 3
for look in '' '--exposure 0.7' '--maxval 65535' '--transfer linear' '--format ppm --maxval 1000' \
    '--tone none --white 6000' '--format exr' '--format exr --half'; do
    "$lavaray" render "$scene" "${args[@]}" --spp 3 $look -o "$work/one.png" || problem "render $look"
    "$lavaray" merge -q "$work"/{a,b}.exr $look -o "$work/merged.png" || problem "merge $look"
    same "$work/one.png" "$work/merged.png"
done
"$lavaray" merge -q "$work"/{a,b}.exr -o - --format png >"$work/merged.png"
"$lavaray" render "$scene" "${args[@]}" --spp 3 -o "$work/one.png"
same "$work/one.png" "$work/merged.png"
# A crop is of the same picture.
"$lavaray" render "$scene" "${args[@]}" --spp 3 --crop 5,6,20,10 -o "$work/one.png"
part crop-a 0-1 --spp 3 --crop 5,6,20,10
part crop-b 2 --spp 3 --crop 5,6,20,10
expect 0 "$lavaray" merge -q "$work"/crop-{b,a}.exr -o "$work/merged.png"
same "$work/one.png" "$work/merged.png"

# no CODE PATTERN ARGUMENTS...: merge refuses with one line, and writes nothing.
no() {
    local code=$1 pattern=$2
    shift 2
    rm -f "$work/none.png"
    expect "$code" "$lavaray" merge "$@" -o "$work/none.png" || return
    says err "$pattern"
    one_line
    [ ! -e "$work/none.png" ] || problem "a picture in spite of: $pattern"
}
part c 0-2 --spp 3 --depth 1
part d 2 --spp 4
part e 2 --spp 3 --seed 5
part f 2 --spp 3 --integrator path
part g 2 --spp 3 --filter tent
no 5 'different settings.*depth 5.*depth 1' "$work"/{a,c}.exr
no 5 'different settings.*3 samples.*4 samples' "$work"/{a,d}.exr
no 5 'different settings.*seed' "$work"/{a,e}.exr
no 5 'different settings.*path' "$work"/{a,f}.exr
no 5 'different settings.*tent' "$work"/{a,g}.exr
no 5 'different settings.*crop 5,6,20,10' "$work"/{a,crop-b}.exr
no 5 'samples in common, from 0 on' "$work"/{a,a,b}.exr
no 5 'samples 2 of 3 are missing.*--sample-range.*--partial' "$work/a.exr"
no 5 'samples 0-1 of 3 are missing' "$work/b.exr"
# Only the numbers of a scene count, not its comments.
{ echo '# a comment'; cat "$scene"; } >"$work/comment.yaml"
scene=$work/comment.yaml
part b2 2 --spp 3
expect 0 "$lavaray" merge -q "$work"/{a,b2}.exr -o "$work/merged.png"
sed '$a ambient: 0.31' "$scene" >"$work/other.yaml"
scene=$work/other.yaml
part other 2 --spp 3
no 5 'different scenes' "$work"/{a,other}.exr
# What is no part.
no 5 'it is no EXR' $small
no 5 'holds no sums' "$work/one.png"
"$lavaray" render $small -q --size 8x8 -o "$work/picture.exr"
no 5 'holds no sums' "$work/picture.exr"
no 5 'No such file' "$work/missing.exr"
head -c 4000 "$work/a.exr" >"$work/short.exr"
no 5 'truncated' "$work/short.exr"
python3 - "$work/a.exr" "$work/bad.exr" <<'PY'
import sys
data = bytearray(open(sys.argv[1], 'rb').read())
at = data.index(b'seed 0')
data[at + 5] = ord('1')
open(sys.argv[2], 'wb').write(data)
PY
no 5 'checksum' "$work/bad.exr"

expect 0 "$lavaray" merge "$work/a.exr" --partial -o "$work/merged.png"
says err 'samples 2 are missing' && says err '2 samples from 1 part'

# wrong PATTERN ARGUMENTS...
wrong() {
    local pattern=$1
    shift
    expect 2 "$lavaray" "$@" && says err "$pattern" && one_line
}
wrong 'EXR file' render $small -o "$work/x.png" --sample-range 0-1
wrong 'lavaray merge' render $small -o "$work/x.exr" --sample-range 0-1 --half
wrong 'lavaray merge' render $small -o "$work/x.exr" --sample-range 0-1 --exposure 1
wrong 'lavaray merge' render $small -o "$work/x.exr" --sample-range 0-1 --white 6000
for range in 3-2 -1 a 1- 1-2-3 0-65536 ''; do
    wrong 'A-B such as 0-15' render $small -o "$work/x.exr" --sample-range "$range"
done
wrong 'not all among' render $small -o "$work/x.exr" --spp 4 --sample-range 2-4
wrong 'not all among' render $small -o "$work/x.exr" --spp 4 --sample-range 7
wrong 'expected PART' merge -o "$work/x.png"
wrong 'replace a part' merge "$work/a.exr" -o "$work/a.exr"
wrong 'where to' merge "$work/a.exr"
finish
