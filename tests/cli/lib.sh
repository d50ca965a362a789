# Sourced by the scripts here: a folder for files, and checks that say what went wrong.
set -u
scenes=tests/cli/scenes
small=$scenes/small.yaml
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

problem() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}

# expect CODE COMMAND...: runs it, output in $work/out and $work/err, and checks its exit code.
expect() {
    local code=$1 got=0
    shift
    "$@" >"$work/out" 2>"$work/err" </dev/null || got=$?
    if [ "$got" -ne "$code" ]; then
        problem "exit code $got instead of $code: $*"
        head -n 5 "$work/err" >&2
        return 1
    fi
}

# says FILE PATTERN: an extended regular expression must match a line of the last command's out or err.
says() {
    grep -qE -e "$2" "$work/$1" || {
        problem "no /$2/ in its $1:"
        head -n 5 "$work/$1" >&2
    }
}

# one_line: the last command printed one line on stderr, nothing on stdout.
one_line() {
    [ "$(wc -l <"$work/err")" -eq 1 ] || problem "more or less than one line: $(cat "$work/err")"
    [ ! -s "$work/out" ] || problem "unexpected output: $(head -n 1 "$work/out")"
}

# nothing_in FOLDER: no file was left there, not even a hidden one.
nothing_in() {
    [ -z "$(ls -A "$1")" ] || problem "left behind: $(ls -A "$1")"
}

same() {
    cmp -s "$1" "$2" || problem "$1 and $2 differ"
}

# sha256_in FILE: the hash of the linear pixels in a render's statistics.
sha256_in() {
    python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["picture"]["sha256"])' "$1"
}

need_device() {
    "$LAVARAY" doctor >/dev/null 2>&1 || { echo "no usable Vulkan device" >&2; exit 77; }
}

finish() {
    [ "$failures" -eq 0 ] || { echo "$failures checks failed" >&2; exit 1; }
    exit 0
}
