# Vulkan calls of the window fail, once, now and then, or always: it goes on as soon as it can and then
# shows the right picture, or it ends with exit code 4 and one message that names the call.
. tests/preview/lib.sh
unset LAVARAY_VALIDATION # the layer's own calls are none of lavaray's
shim=$BUILD_DIR/tests/faults
real=$(ldconfig -p 2>/dev/null | sed -n 's/.*libvulkan\.so\.1 .*=> //p' | head -n 1)
[ -n "$real" ] || real=$(find /usr/lib /lib -name 'libvulkan.so.1' 2>/dev/null | head -n 1)
[ -f "$shim/libvulkan.so.1" ] && [ -n "$real" ] || { echo 'no shim or no loader' >&2; exit 77; }
start_display
scene=$work/scene.yaml
cp scenes/shapes.yaml "$scene"
expect 0 "$LAVARAY" render -q "$scene" --size 120x90 -o "$work/want.ppm"
"$LAVARAY" render -q "$scene" --size 90x70 -o "$work/want-small.ppm"
shimmed=(LD_LIBRARY_PATH="$shim" LAVARAY_REAL_VULKAN="$real")

# All that the window does: shows, is resized, reads its scene again, and makes other kernels ready and
# those for light again.
shows_or_ends() {
    shows "$1" || ! running
}

more_or_ends() {
    more "$@" || ! running
}

act() {
    await 20 find_window && await 20 shows_or_ends "$work/want.ppm" && running || return
    xdotool windowsize "$window" 90 70
    await 20 shows_or_ends "$work/want-small.ppm" && running || return
    xdotool windowsize "$window" 120 90
    local before
    before=$(count ' scene ')
    cp scenes/shapes.yaml "$scene"
    await 20 more_or_ends ' scene ' "$before" && running || return
    before=$(count ' scene read')
    press v
    await 20 more_or_ends ' session ' "$before" && running || return
    before=$(count ' scene read')
    press v v v v
    await 20 more_or_ends ' session ' "$before" && running || return
    press Escape
    await 20 shows_or_ends "$work/want.ppm" && running || return
    ! running || press q
}

ends_well() {
    local code=0
    await 20 has_ended || { kill -KILL "$view_process" && keep faults; }
    wait "$view_process" 2>/dev/null || code=$?
    view_process=
    case $code in
    0) [ ! -s "$work/err" ] || problem "it said $(cat "$work/err")" ;;
    4)
        : >"$work/out"
        one_line
        grep -q "${1:-no failure}" "$work/err" || problem "no $1 in $(cat "$work/err")"
        ;;
    *) problem "exit code $code, $(head -n 3 "$work/err")" ;;
    esac
    [ "$code" -eq "${2:-$code}" ] || problem "exit code $code instead of $2"
}

# fault NAME CALLS RESULT [CODE [PATTERN]]: of the message, else it is to have the name.
fault() {
    local before=$failures
    VIEW_ENV=("${shimmed[@]}" LAVARAY_FAULT="$1:$2:$3")
    launch "$scene" --size 120x90
    act
    ends_well "${5:-$1}" "${4:-}"
    [ "$failures" -eq "$before" ] || echo "  with $1:$2:$3" >&2
}

VIEW_ENV=("${shimmed[@]}" LAVARAY_FAULT_LOG="$work/calls")
launch "$scene" --size 120x90
act
ends_well '' 0
grep -q '^vkQueuePresentKHR ' "$work/calls" || { problem 'the shim was not used' && finish; }

# Only functions without a result may pass by the shim.
sed -n 's/ unwrapped$//p' "$work/calls" | sort -u |
    grep -vE '^vk(Destroy|Cmd|FreeMemory|FreeCommandBuffers|UnmapMemory|UpdateDescriptorSets)' |
    grep -vE '^vkGet(PhysicalDevice(Properties|Features|Memory|Queue)|DeviceQueue|.*MemoryRequirements)' |
    grep -vE 'PresentationSupportKHR$' >"$work/unwrapped"
[ ! -s "$work/unwrapped" ] || problem "not wrapped by the shim: $(cat "$work/unwrapped")"

out_of_date=-1000001004 suboptimal=1000001003 surface_lost=-1000000000
device_lost=-4 out_of_memory=-2 not_ready=1 in_use=-1000000001

# What windows do to a swapchain costs nothing but time.
for call in vkAcquireNextImageKHR vkQueuePresentKHR; do
    for result in $out_of_date $suboptimal $surface_lost; do
        fault $call 2/ $result 0
    done
done
fault vkQueuePresentKHR 1+ $suboptimal 0
fault vkAcquireNextImageKHR 2/ $not_ready 0
fault vkGetPhysicalDeviceSurfaceCapabilitiesKHR 2/ $surface_lost 0
fault vkCreateSwapchainKHR 2 $surface_lost 0

# A device that is lost once is opened anew; one that always is ends it.
for call in vkAcquireNextImageKHR vkQueuePresentKHR vkQueueSubmit vkWaitForFences; do
    fault $call 9 $device_lost 0
done
fault vkQueuePresentKHR 1+ $device_lost 4
fault vkQueueSubmit 30+ $device_lost 4
fault vkCreateSwapchainKHR 1 $out_of_memory 0
fault vkCreateSwapchainKHR 1+ $out_of_memory 4
fault vkCreateSwapchainKHR 1 $in_use 0
fault vkGetSwapchainImagesKHR 2 $out_of_memory 0
fault vkGetPhysicalDeviceSurfaceCapabilitiesKHR 3 $out_of_memory 0
fault vkGetPhysicalDeviceSurfaceFormatsKHR 1 $out_of_memory
fault vkCreateXcbSurfaceKHR 1 $out_of_memory 0
fault vkCreateXcbSurfaceKHR 1+ $out_of_memory 4 'surface'

# Every other call, at its first and a later one.
[ -n "${LAVARAY_FULL:-}" ] || finish
grep -v unwrapped "$work/calls" >"$work/counts"
while read -r name count; do
    for call in $(printf '%s\n' 1 $((count / 2)) "$count" | sort -nu); do
        # GLFW asks for extensions too, and does not say what it was told.
        [ "$call" -lt 1 ] || fault "$name" "$call" $out_of_memory '' "$name\|no Vulkan driver can"
    done
done <"$work/counts"
finish
