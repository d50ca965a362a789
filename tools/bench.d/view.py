"""How soon the window of lavaray view answers, under Xvfb: from a wish, which is when the window's
thread has seen the hand move, to the first picture of it, or of a later one, that is handed to the X
server; and from the moment that an edited file lies there to the first picture of it."""

import os
import re
import shutil
import statistics
import subprocess
import time

from common import LAVARAY, machine, write_text

PATIENCE = 60.0  # seconds that anything may take
MOVE_PAUSE = 0.25  # ... between camera moves that are answered one by one
DRAG_PAUSE = 0.016  # ... of a hand that goes on
OTHER_KIND = "  - disk: {center: [0, 0.01, 3], normal: [0, 1, 0], radius: 0.4}\n"


class Log:
    """The lines of --events, as they come."""

    def __init__(self, path):
        self.file = open(path, encoding="utf-8")  # pylint: disable=consider-using-with
        self.lines = []  # (seconds, words)

    def read(self):
        for line in self.file:
            seconds, *words = line.split()
            self.lines.append((float(seconds), words))
        return self.lines

    def wait(self, after, *beginnings):
        """Until a line behind number `after` begins so; the number behind it."""
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until:
            for i, (_, words) in enumerate(self.read()[after:], after):
                if " ".join(words).startswith(beginnings):
                    return i + 1
            time.sleep(0.0005)
        raise TimeoutError("lavaray view: no %s in its log" % " or ".join(beginnings))


def answers(lines):
    """Seconds from each wish to the first picture of it or of a later one."""
    waiting, times = [], []
    for seconds, words in lines:
        if words[0] == "wish":
            waiting.append((int(words[1]), seconds))
        elif words[0] == "shown":
            times += [seconds - since for wish, since in waiting if wish <= int(words[1])]
            waiting = [w for w in waiting if w[0] > int(words[1])]
    return times


def hand(window, count, pause):
    """A drag of so many moves, to and fro."""
    steps = ["mousemove", "--window", window, "200", "200", "mousedown", "1"]
    for i in range(count):
        steps += ["mousemove", "--window", window, str(200 + i % 40 * 5), str(200 + i % 7 * 4),
                  "sleep", str(pause)]
    subprocess.run(["xdotool", *steps, "mouseup", "1"], check=True)


def moves(log, window, count, pause):
    first = len(log.read())
    hand(window, count, pause)
    wishes = [words[1] for _, words in log.read()[first:] if words[0] == "wish"]
    log.wait(first, "shown %s " % wishes[-1])
    return answers(log.lines[first:])


def edit(log, scene, text):
    """Renames a file of this text over the scene."""
    seen = len(log.read())
    write_text(scene + "~", text)
    os.replace(scene + "~", scene)
    start = time.monotonic()
    seen = log.wait(seen, "edit taken", "session ready")
    log.wait(seen, "shown")
    taken = time.monotonic() - start
    time.sleep(0.5)
    return taken


def milliseconds(times):
    return {"median_ms": round(1000 * statistics.median(times), 1),
            "worst_ms": round(1000 * max(times), 1), "count": len(times)}


def measure(showcase, work, count):
    """`count` runs of 40 moves, 100 moves of a hand that goes on, 5 edits of a number, and 5 that
    bring or take a kind of object, for which other kernels are needed."""
    if not shutil.which("Xvfb") or not shutil.which("xdotool"):
        raise SystemExit("tools/bench: --view needs the packages xvfb and xdotool")
    scene, events = os.path.join(work, "scene.yaml"), os.path.join(work, "events")
    shutil.copy(showcase, scene)
    reading, writing = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x1024x24",
                               "-nolisten", "tcp"], pass_fds=[writing], stderr=subprocess.DEVNULL)
    view = None
    try:
        os.environ["DISPLAY"] = ":" + os.read(reading, 16).decode().strip()
        write_text(events, "")
        view = subprocess.Popen([LAVARAY, "view", scene, "--size", "640x480", "--events", events],
                                stderr=subprocess.DEVNULL)
        log = Log(events)
        log.wait(0, "shown")
        window = subprocess.run(["xdotool", "search", "--class", "lavaray"], check=True,
                                capture_output=True, text=True).stdout.split()[-1]
        moves(log, window, 40, MOVE_PAUSE)  # it learns how fast the device is
        with open(showcase, encoding="utf-8") as file:
            text = file.read()
        single, dragged, numbers, kinds = [], [], [], []
        for _ in range(count):
            single += moves(log, window, 40, MOVE_PAUSE)
            dragged += moves(log, window, 100, DRAG_PAUSE)
            for i in range(5):
                numbers.append(edit(log, scene, re.sub("fov: [0-9]+", "fov: %d" % (30 + i), text)))
            for i in range(5):
                kinds.append(edit(log, scene, text + OTHER_KIND * (i % 2)))
        return {"machine": machine(), "scene": "showcase, 640x480",
                "camera_moves": milliseconds(single), "while_dragging": milliseconds(dragged),
                "edits_of_a_number": milliseconds(numbers),
                "edits_of_kinds": milliseconds(kinds)}
    finally:
        for process in filter(None, (view, server)):
            process.terminate()
            process.wait()
