# Ctrl-C: the render stops soon, says so, and leaves nothing behind.
. tests/cli/lib.sh
need_device
folder=$work/folder
mkdir "$folder"

cat >"$work/interrupt.py" <<'END'
import os, signal, subprocess, sys, time

program, scene, output, name, delay = sys.argv[1:]
process = subprocess.Popen(
    [program, "render", scene, "-o", output, "--size", "2048x2048", "--spp", "1024"],
    stderr=subprocess.PIPE, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
time.sleep(float(delay))
start = time.monotonic()
process.send_signal(getattr(signal, name))
_, message = process.communicate(timeout=60)
print(process.returncode, int(1000 * (time.monotonic() - start)), message.decode().strip())
END

for name in SIGINT SIGTERM SIGHUP; do
    for delay in 0.05 2; do
        read -r code milliseconds message < <(
            python3 "$work/interrupt.py" "$LAVARAY" $small "$folder/x.ppm" $name $delay
        )
        # The limit is for a machine that does nothing else; the first dispatch may still compile.
        [ "$delay" = 2 ] && [ "$milliseconds" -gt "${LAVARAY_INTERRUPT_MS:-1000}" ] &&
            problem "$name took $milliseconds ms"
        # At the start the signal may come before there is a handler: that, too, ends the process.
        case "$code $message" in
        "130 lavaray: interrupted, nothing written") ;;
        -*) [ "$delay" = 0.05 ] || problem "$name ended it with $code" ;;
        *) problem "$name after $delay s: exit code $code, '$message'" ;;
        esac
        nothing_in "$folder"
    done
done

# An old picture stays as it was. Without --foreground timeout sends the signal twice.
echo old >"$folder/x.ppm"
timeout --foreground -s INT 1 "$LAVARAY" render -q $small -o "$folder/x.ppm" --size 2048x2048 --spp 1024 2>/dev/null
[ "$(cat "$folder/x.ppm")" = old ] || problem 'the old picture was touched'
[ "$(ls -A "$folder")" = x.ppm ] || problem "left behind: $(ls -A "$folder")"
finish
