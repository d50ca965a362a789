# Files of other programs at the command line: exit codes, notes, flags.
. tests/cli/lib.sh
lavaray=$LAVARAY
inner=$work/inner
mkdir "$inner"
cat >"$work/quad.obj" <<'END'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
f 1 2 3 4
f 1 1 2
END
cp "$work/quad.obj" "$inner/Quad.OBJ"
cat >"$inner/scene.yaml" <<'END'
camera: {from: [0.5, 0.5, 3], to: [0.5, 0.5, 0]}
objects:
  - mesh: {file: ../quad.obj}
END

expect 0 "$lavaray" validate "$work/quad.obj"
says out 'quad\.obj: ok, 1 object, 1 light, 1 material, 1 camera, 1 mesh, 2 triangles$'
says err '^lavaray: note: .*quad\.obj: mesh 0 .*: 1 faces left out: they have no area$'
expect 0 "$lavaray" validate -q "$inner/Quad.OBJ"
[ ! -s "$work/err" ] || problem "-q prints notes: $(cat "$work/err")"

# Errors of models are errors of files; where a scene names them, of the scene at that place.
expect 5 "$lavaray" validate "$work/none.glb" && one_line
printf 'glTF' >"$work/cut.glb"
expect 5 "$lavaray" validate "$work/cut.glb" && one_line
says err 'cut\.glb: is no GLB file'
expect 3 "$lavaray" validate "$inner/scene.yaml"
says err 'scene\.yaml:3:18: \.\./quad\.obj lies outside of the folder .*--allow-path'
expect 0 "$lavaray" validate --allow-path "$inner/scene.yaml"
expect 5 "$lavaray" validate --max-triangles 1 "$work/quad.obj" && one_line
says err 'more than 1 triangles; allow more with --max-triangles$'
head -c 3000000 /dev/zero | tr '\0' '#' >>"$work/quad.obj"
expect 4 "$lavaray" validate --max-memory 4M "$work/quad.obj" && one_line
says err 'more memory than the 4 MiB allowed; allow more with --max-memory$'
expect 0 "$lavaray" validate --max-memory 1g "$work/quad.obj"
for size in 0 1 M 4X -1M 1e9 99999999T; do
    expect 2 "$lavaray" validate --max-memory=$size "$work/quad.obj" && one_line
done

"$lavaray" doctor >/dev/null 2>&1 || finish # the rest needs a device
for i in 1 2; do
    expect 0 "$lavaray" render -q "$inner/Quad.OBJ" -o "$work/$i.ppm" --size 32x24
done
same "$work/1.ppm" "$work/2.ppm"
finish
