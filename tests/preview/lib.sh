# Sourced by the scripts here: a display and a window manager of their own, lavaray view on it, and
# what hands and eyes do. Nothing waits for a time: everything for what must come.
. tests/cli/lib.sh
pictures=$BUILD_DIR/preview # kept, to be looked at
mkdir -p "$pictures"

for tool in Xvfb openbox xdotool xwd xwdtopnm pngtopnm pnmtopng xprop; do
    command -v $tool >/dev/null || { echo "no $tool" >&2; exit 77; }
done
need_device

view_process=
cleanup() {
    local process
    for process in $view_process $(jobs -p); do
        kill "$process" 2>/dev/null
    done
    wait
    rm -rf "$work"
}
trap cleanup EXIT
trap 'exit 1' INT TERM

# await SECONDS COMMAND...: until it succeeds; false, with a word about it, when it does not.
await() {
    local until=$((SECONDS + $1))
    shift
    while ! "$@"; do
        [ "$SECONDS" -le "$until" ] || { problem "waited in vain: $*" && return 1; }
        sleep 0.05
    done
}

start_display() {
    Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp 3>"$work/display" 2>"$work/xvfb" &
    await 60 test -s "$work/display" || { cat "$work/xvfb" >&2 && finish; }
    DISPLAY=:$(cat "$work/display")
    export DISPLAY
    unset WAYLAND_DISPLAY
    start_manager
    await 60 has_manager || { cat "$work/xvfb" "$work/openbox" >&2 && finish; }
}

start_manager() {
    openbox --sm-disable >>"$work/openbox" 2>&1 &
    manager=$!
}

# Should it have ended early, it is started again.
has_manager() {
    kill -0 "$manager" 2>/dev/null || start_manager
    timeout 5 xprop -root _NET_SUPPORTING_WM_CHECK 2>/dev/null | grep -q 0x
}

# ---- The program ------------------------------------------------------------------------------

# launch ARGUMENTS...: lavaray view in the background, with VIEW_ENV=(NAME=VALUE...); its process is
# $view_process, its log $events.
events=$work/events
VIEW_ENV=()
launch() {
    : >"$events"
    # What a shell starts in the background would not be reached by SIGINT.
    env --default-signal=INT "${VIEW_ENV[@]}" "$LAVARAY" view "$@" --events "$events" >"$work/said" 2>"$work/err" &
    view_process=$!
}

find_window() {
    window=$(xdotool search --onlyvisible --class lavaray 2>/dev/null | tail -n 1)
    [ -n "$window" ] || ! running
}

running() {
    kill -0 "$view_process" 2>/dev/null
}

# view ARGUMENTS...: ... and waits for its picture and the keyboard's focus; the window is $window.
view() {
    launch "$@"
    await 60 find_window && await 60 is_done && await 10 has_focus || {
        cat "$work/err" >&2
        finish
    }
}

has_focus() {
    [ "$(xdotool getwindowfocus 2>/dev/null)" = "$window" ] || ! running
}

# ended SECONDS CODE: that it ends so soon and with this code.
ended() {
    await "$1" has_ended || kill -KILL "$view_process" 2>/dev/null
    local code=0
    wait "$view_process" 2>/dev/null || code=$?
    view_process=
    [ "$code" -eq "$2" ] || {
        problem "exit code $code instead of $2"
        head -n 5 "$work/err" >&2
    }
}

has_ended() {
    ! running
}

# quit: by its key, and without a word.
quit() {
    press q
    ended 20 0
    [ ! -s "$work/err" ] || problem "it said $(cat "$work/err")"
}

# ---- Hands and eyes -----------------------------------------------------------------------------

# Not faster: GLFW takes two presses of a key in one millisecond for one.
press() {
    xdotool key --delay 12 "$@"
}

# at X Y: the pointer over the window's pixel.
at() {
    xdotool mousemove --window "$window" "$1" "$2"
}

# drag BUTTON DX DY: from where the pointer is, in four moves.
drag() {
    local i
    xdotool mousedown "$1"
    for i in 1 2 3 4; do
        xdotool mousemove_relative --sync -- $(($2 / 4)) $(($3 / 4))
    done
    xdotool mouseup "$1"
}

# count PATTERN: of the log's lines.
count() {
    grep -cE "$1" "$events"
}

# more PATTERN COUNT: there are more than so many.
more() {
    [ "$(count "$1")" -gt "$2" ]
}

# is_done: the last picture that was wished for is on the screen, all of it.
is_done() {
    local last
    last=$(sed -n 's/^[0-9.]* wish //p' "$events" | tail -n 1)
    { [ -n "$last" ] && grep -q " shown $last .* finished" "$events"; } || ! running
}

# After what hands did: p's line comes when all before it has been seen to. camera: that line.
settle() {
    local before
    before=$(wc -l <"$work/said")
    press p
    await 20 said_more "$before" && await 60 is_done
    camera=$(tail -n 1 "$work/said")
    press Escape
}

said_more() {
    [ "$(wc -l <"$work/said")" -gt "$1" ]
}

# window_picture FILE.ppm: what the window shows, by the X server.
window_picture() {
    xwd -silent -id "$window" >"$work/window.xwd" 2>/dev/null && xwdtopnm "$work/window.xwd" >"$1" 2>/dev/null
}

shows() {
    window_picture "$work/window.ppm" && cmp -s "$1" "$work/window.ppm"
}

differs() {
    ! shows "$1"
}

differs_file() {
    ! cmp -s "$1" "$2"
}

# sized WxH: the size of the window.
sized() {
    [ "$(xdotool getwindowgeometry "$window" | sed -n 's/.*Geometry: //p')" = "$1" ]
}

hidden() {
    xprop -id "$window" WM_STATE | grep -q Iconic
}

# shows_soon FILE.ppm NAME: the window comes to show that picture; what it shows is kept as NAME.png.
shows_soon() {
    await 20 shows "$1"
    keep "$2"
}

keep() {
    window_picture "$work/window.ppm"
    pnmtopng "$work/window.ppm" >"$pictures/$1.png" 2>/dev/null
}
