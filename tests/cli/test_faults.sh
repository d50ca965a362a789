# Each Vulkan call that can fail is made to fail: exit code 4, one message that names the call, no
# picture, no crash.
. tests/cli/lib.sh
need_device
lavaray=$LAVARAY
unset LAVARAY_VALIDATION # the layer's own calls are none of lavaray's
shim=$BUILD_DIR/tests/faults
real=$(ldconfig -p 2>/dev/null | sed -n 's/.*libvulkan\.so\.1 .*=> //p' | head -n 1)
[ -n "$real" ] || real=$(find /usr/lib /lib -name 'libvulkan.so.1' 2>/dev/null | head -n 1)
[ -f "$shim/libvulkan.so.1" ] && [ -n "$real" ] || { echo 'no shim or no loader' >&2; exit 77; }
folder=$work/folder
mkdir "$folder"

shimmed() {
    env LD_LIBRARY_PATH="$shim" LAVARAY_REAL_VULKAN="$real" "$@" \
        "$lavaray" render -q $small -o "$folder/x.ppm" --size 16x12 --spp 1
}

expect 0 shimmed LAVARAY_FAULT_LOG="$work/calls" || finish
rm "$folder/x.ppm"
grep -q '^vkQueueSubmit ' "$work/calls" || problem 'the shim was not used'

# Only functions without a result may pass by the shim.
grep ' unwrapped$' "$work/calls" | sort -u | while read -r name _; do
    case $name in
    vkDestroy* | vkCmd* | vkFreeMemory | vkFreeCommandBuffers | vkUnmapMemory) ;;
    vkGetPhysicalDevice* | vkGetDeviceQueue* | vkGet*MemoryRequirements* | vkUpdateDescriptorSets) ;;
    *) echo "$name" ;;
    esac
done >"$work/unwrapped"
[ ! -s "$work/unwrapped" ] || problem "not wrapped by the shim: $(cat "$work/unwrapped")"

# fault NAME CALL RESULT
fault() {
    local before=$failures
    if expect 4 shimmed LAVARAY_FAULT="$1:$2:$3"; then
        says err "$1"
        one_line
        nothing_in "$folder"
    fi
    [ "$failures" -eq "$before" ] || echo "  with $1:$2:$3" >&2
    rm -rf "$folder"
    mkdir "$folder"
}

# results NAME: what it may return, as numbers of VkResult: out of host memory -1, out of device
# memory -2, initialization failed -3, device lost -4, map failed -5, fragmented pool -12.
results() {
    case $1 in
    vkQueueSubmit | vkGetFenceStatus) echo -4 -2 ;;
    vkWaitForFences) echo -4 -2 2 ;; # the last is VK_TIMEOUT, with the work still running
    vkCreateDevice) echo -3 -4 ;;
    vkMapMemory) echo -5 ;;
    vkAllocateDescriptorSets) echo -12 ;;
    *) echo -1 -2 ;;
    esac
}

grep -v unwrapped "$work/calls" >"$work/counts"
while read -r name count; do
    # Called when all is done: that nothing is left to wait for is no loss then.
    [ "$name" != vkDeviceWaitIdle ] || continue
    # The first and the last call, and those at about thirds: what was built before differs.
    for call in $(printf '%s\n' 1 2 $((count / 3)) $((2 * count / 3)) "$count" | sort -nu); do
        [ "$call" -ge 1 ] && [ "$call" -le "$count" ] || continue
        for result in $(results "$name"); do
            fault "$name" "$call" "$result"
        done
    done
done <"$work/counts"
finish
