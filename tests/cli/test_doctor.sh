# What is said when Vulkan, or a part of it, is missing.
. tests/cli/lib.sh
lavaray=$LAVARAY

if "$lavaray" devices >/dev/null 2>&1; then
    expect 0 "$lavaray" doctor && says out '^A render will work' && says out 'lavaray render uses'
fi

mkdir "$work/broken"
echo 'not a library' >"$work/broken/libvulkan.so.1"
cp "$work/broken/libvulkan.so.1" "$work/broken/libvulkan.so"
expect 4 env LD_LIBRARY_PATH="$work/broken" "$lavaray" doctor
says out 'missing.*loader' && says out 'libvulkan1'
for command in "render $small -o $work/x.ppm" devices; do
    expect 4 env LD_LIBRARY_PATH="$work/broken" "$lavaray" $command
    says err 'libvulkan1'
    one_line
done

for variable in VK_ICD_FILENAMES VK_DRIVER_FILES; do
    nowhere="env -u VK_ICD_FILENAMES -u VK_DRIVER_FILES $variable=/nonexistent/icd.json"
    expect 4 $nowhere "$lavaray" doctor
    says out "$variable is set to /nonexistent/icd.json"
    says out 'no such driver file' && says out 'mesa-vulkan-drivers' && says out 'will not work'
    expect 4 $nowhere "$lavaray" render $small -o "$work/x.ppm" && says err 'mesa-vulkan-drivers'
    expect 4 $nowhere "$lavaray" devices && says err 'mesa-vulkan-drivers'
    expect 0 $nowhere "$lavaray" validate $small
done

mkdir "$work/icd"
echo '{"file_format_version": "1.0.0", "ICD": {"library_path": "./gone.so"}}' >"$work/icd/x.json"
expect 4 env VK_ICD_FILENAMES="$work/icd/x.json" "$lavaray" doctor && says out 'gone\.so'
echo '{' >"$work/icd/x.json"
expect 4 env VK_ICD_FILENAMES="$work/icd/x.json" "$lavaray" doctor && says out 'wrong .*x\.json'
[ ! -e "$work/x.ppm" ] || problem 'a picture without a device'
finish
