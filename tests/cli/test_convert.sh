# Scenes in other languages: what is written, by whom it is read, and that no file is lost.
. tests/cli/lib.sh
lavaray=$LAVARAY
folder=$work/folder
mkdir "$folder"
nff=$scenes/round.nff

wrong() {
    local pattern=$1
    shift
    expect 2 "$lavaray" convert "$@" && says err "$pattern" && one_line
}
wrong 'must end in \.yaml, \.pov, \.dat or \.tac' $small "$folder/x.obj"
wrong 'must end in' $small -
wrong 'see lavaray convert --help' $small
cp $small "$folder/in.yaml"
ln -s in.yaml "$folder/link.yaml"
wrong 'would replace the scene' "$folder/in.yaml" "$folder/in.yaml"
wrong 'would replace the scene' "$folder/in.yaml" "$folder/link.yaml"
same $small "$folder/in.yaml"
rm "$folder"/*
expect 5 "$lavaray" convert "$work/none.yaml" "$folder/x.yaml" && says err 'none\.yaml'
expect 5 "$lavaray" convert $small "$work/none/x.yaml" && says err 'No such file'
expect 3 "$lavaray" convert $scenes/bad.yaml "$folder/x.yaml" && says err 'bad\.yaml:1:'
nothing_in "$folder"

# What is left out is told once a kind, with its number, and not with -q.
cat >"$work/sided.yaml" <<'YAML'
camera: {}
objects:
  - sphere: {material: {one_sided: true}}
  - disk: {material: {one_sided: true}}
YAML
expect 0 "$lavaray" convert "$work/sided.yaml" "$folder/a.pov"
says err "a\.pov: one-sided materials are written with two sides \(2\)" && one_line
expect 0 "$lavaray" convert -q "$work/sided.yaml" "$folder/b.pov"
[ ! -s "$work/err" ] || problem "-q prints: $(cat "$work/err")"
same "$folder/a.pov" "$folder/b.pov"
expect 0 "$lavaray" convert -q $nff "$folder/a.tac"
expect 0 "$lavaray" convert -q $nff "$folder/a.yaml"
expect 0 "$lavaray" validate "$folder/a.yaml" && says out ': ok, 5 objects, 2 lights, 3 materials, 1 camera'
"$lavaray" convert - "$folder/c.yaml" <$small || problem 'cannot read standard input'

# Polygons become files beside the scene, which are replaced only with it.
printf 'v from 0 -5 2 at 0 0 0 up 0 0 1 angle 45 hither 0 resolution 32 32\nl 4 3 2\nf 1 1 1 1 0 1 0 1\np 3 0 0 0 1 0 0 0 1 0\n' \
    >"$work/p.nff"
expect 0 "$lavaray" convert -q "$work/p.nff" "$folder/p.yaml"
grep -q 'file: "p-1.ply"' "$folder/p.yaml" || problem 'no mesh file named'
[ "$(head -c 3 "$folder/p-1.ply")" = ply ] || problem 'no PLY'
expect 0 "$lavaray" convert -q "$work/p.nff" "$folder/p.yaml"
rm "$folder/p.yaml"
expect 5 "$lavaray" convert -q "$work/p.nff" "$folder/p.yaml" && says err 'p-1\.ply: exists already' && one_line
[ ! -e "$folder/p.yaml" ] || problem 'a scene without its mesh was written'

# The picture is the same to the byte from our own language, and POV-Ray agrees about its own.
"$lavaray" doctor >/dev/null 2>&1 || finish
for scene in $nff $small scenes/transforms.yaml "$work/p.nff"; do
    expect 0 "$lavaray" convert -q "$scene" "$folder/again.yaml"
    expect 0 "$lavaray" render -q "$scene" --size 80x60 --spp 1 -o "$folder/first.pfm"
    expect 0 "$lavaray" render -q "$folder/again.yaml" --size 80x60 --spp 1 -o "$folder/second.pfm"
    same "$folder/first.pfm" "$folder/second.pfm"
done
if command -v povray >/dev/null && command -v pngtopnm >/dev/null; then
    for scene in $nff scenes/shapes.yaml scenes/patterns.yaml scenes/spots.yaml; do
        # POV-Ray's picture has the size that its camera was written for.
        "$lavaray" convert -q "$scene" "$folder/s.yaml"
        sed -i 's/^image: .*/image: {width: 80, height: 60, depth: 4}/' "$folder/s.yaml"
        expect 0 "$lavaray" convert -q "$folder/s.yaml" "$folder/s.pov"
        expect 0 "$lavaray" render -q "$folder/s.yaml" --transfer linear --maxval 65535 -o "$folder/ours.ppm"
        expect 0 povray "+I$folder/s.pov" "+O$folder/s.png" +W80 +H60 -D -A +FN16 File_Gamma=1.0 || continue
        pngtopnm "$folder/s.png" >"$folder/theirs.ppm" 2>/dev/null
        share=$(python3 tests/images/povray/compare.py "$folder/ours.ppm" "$folder/theirs.ppm")
        awk "BEGIN { exit !($share >= 99.8) }" || problem "$scene: $share % agree with POV-Ray"
    done
else
    echo 'no povray or netpbm: not compared' >&2
fi
if command -v tachyon >/dev/null; then
    expect 0 tachyon "$folder/a.tac" -format PPM -o "$folder/t.ppm"
    [ -s "$folder/t.ppm" ] || problem 'Tachyon wrote no picture'
fi
finish
