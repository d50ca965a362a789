"""What the measurements share: runs of whole processes, and how they are put together."""

import json
import os
import platform
import resource
import shutil
import statistics
import subprocess
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LAVARAY = os.path.join(ROOT, "build", "release", "lavaray")
SPHERE = "camera: {}\nobjects:\n  - sphere: {}\n"


def run(command, environment=None, check=True, folder=None):
    """One run as (cpu, wall) seconds."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run(command, check=check, env=environment, cwd=folder, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return cpu, wall


def summary(runs):
    return {"cpu_seconds": round(statistics.median(r[0] for r in runs), 4),
            "wall_seconds": round(statistics.median(r[1] for r in runs), 4), "runs": len(runs)}


def ratio(ours, theirs):
    """The median ratio of their CPU seconds to ours, run by run."""
    return round(statistics.median(t[0] / o[0] for o, t in zip(ours, theirs)), 2)


def read_stats(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def write_text(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def machine():
    return {"processor": processor(), "cores": os.cpu_count(), "system": platform.platform(),
            "load": [round(load, 2) for load in os.getloadavg()]}


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as info:
            return next(line.split(":", 1)[1].strip() for line in info if "model name" in line)
    except (OSError, StopIteration):
        return platform.processor()


def version(program, name):
    """The line in which a peer names itself; None where it is not installed."""
    if not shutil.which(program):
        return None
    told = subprocess.run([program, "--version"], capture_output=True, text=True, check=False)
    lines = (told.stdout + told.stderr).split("\n")
    return next((line.strip() for line in lines if line.startswith(name)), "unknown version")
