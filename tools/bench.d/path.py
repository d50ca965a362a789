"""Path tracing, how soon a picture is good: CPU seconds until the root of the mean squared error (all
samples, linear) of Mitsuba's Cornell box at 512x512 and eight edges a path is 0.011, and the error at
64 samples a pixel; beside Mitsuba 3, if LAVARAY_MITSUBA_PYTHON is a Python that has it.

Ours are whole processes; Mitsuba's seconds are without its start and compilation. The reference is made
once by Mitsuba (mitsuba_cornell.py, about five minutes of CPU time) and stays in .cache/path.
"""

import array
import json
import math
import os
import re
import statistics
import subprocess
import sys

from common import LAVARAY, ROOT, run

SCENE = os.path.join(ROOT, "tests", "images", "mitsuba", "cornell.yaml")
PEER = os.path.join(ROOT, "tools", "bench.d", "mitsuba_cornell.py")
REFERENCE = os.path.join(ROOT, ".cache", "path", "cornell-512.pfm")
SIZE, TARGET, COMPARED = 512, 0.011, 64
SAMPLES = [16, 32, 64, 128, 256, 512, 1024]


def read_samples(path):
    """The numbers of a PFM file."""
    with open(path, "rb") as file:
        for _ in range(3):
            file.readline()
        samples = array.array("f", file.read())
    if sys.byteorder == "big":
        samples.byteswap()
    return samples


def rmse(path, reference):
    """The picture's error; the reference's own noise is taken off."""
    samples = read_samples(path)
    squares = math.fsum((a - b) * (a - b) for a, b in zip(samples, reference["samples"]))
    return math.sqrt(max(squares / len(samples) - reference["noise"] ** 2, 0))


def get_reference(python):
    if not os.path.exists(REFERENCE):
        if not python:
            sys.exit("tools/bench: %s is missing; with LAVARAY_MITSUBA_PYTHON set, Mitsuba makes it" % REFERENCE)
        os.makedirs(os.path.dirname(REFERENCE), exist_ok=True)
        subprocess.run([python, PEER, "reference", str(SIZE), REFERENCE], check=True)
    with open(REFERENCE + ".json", encoding="utf-8") as file:
        return {"samples": read_samples(REFERENCE), "noise": json.load(file)["noise"]}


def run_ours(spp, seed, path):
    return run([LAVARAY, "render", SCENE, "-q", "--size", "%dx%d" % (SIZE, SIZE), "--spp", str(spp),
                "--seed", str(seed), "-o", path])[0]


def run_mitsuba(python, sampler):
    def run_one(spp, seed, path):
        told = subprocess.run([python, PEER, sampler, str(SIZE), path, str(spp), str(seed)], check=True,
                              capture_output=True, text=True).stdout
        return float(re.sub(r"\x1b\[[0-9;]*m", "", told).split()[-1])  # Mitsuba may colour its lines
    return run_one


def crossing(points):
    """CPU seconds at which the error is TARGET, by a line through the logarithms of the two points
    (samples, seconds, error) around it; None when none is that good."""
    for (_, t0, e0), (_, t1, e1) in zip(points, points[1:]):
        if e0 > TARGET >= e1:
            share = math.log(e0 / TARGET) / math.log(e0 / e1)
            return math.exp(math.log(t0) + share * math.log(t1 / t0))
    return points[0][1] if points and points[0][2] <= TARGET else None


def converge(run_one, count, reference, path):
    """One renderer's medians of so many runs, for ever more samples until the target is met."""
    points = []
    for spp in SAMPLES:
        runs = [(run_one(spp, seed, path), rmse(path, reference)) for seed in range(count)]
        cpu, error = (statistics.median(r[i] for r in runs) for i in (0, 1))
        points.append((spp, cpu, error))
        if error <= TARGET and spp >= COMPARED:
            break
    compared = next(p for p in points if p[0] == COMPARED)
    found = crossing(points)
    return {
        "rmse_64": round(compared[2], 5),
        "cpu_seconds_64": round(compared[1], 3),
        "cpu_seconds_to_target": found and round(found, 2),
        "points": [{"samples": s, "cpu_seconds": round(t, 3), "rmse": round(e, 5)} for s, t, e in points],
    }


def measure(count, work):
    """Results by renderer."""
    python = os.environ.get("LAVARAY_MITSUBA_PYTHON")
    reference, path = get_reference(python), os.path.join(work, "a.pfm")
    renderers = {"lavaray": run_ours}
    if python:
        renderers.update({"mitsuba_" + sampler: run_mitsuba(python, sampler)
                          for sampler in ("independent", "multijitter")})
    result = {name: converge(run_one, count, reference, path) for name, run_one in renderers.items()}
    ours = result["lavaray"]["cpu_seconds_to_target"]
    for name in list(result)[1:]:
        theirs = result[name]["cpu_seconds_to_target"]
        result[name]["cpu_ratio_to_lavaray"] = ours and theirs and round(theirs / ours, 3)
    return result


def markdown(result):
    lines = ["| | 64 samples: RMSE | CPU s | CPU s to RMSE %g | ratio to lavaray's |" % TARGET,
             "|---|---|---|---|---|"]
    for name, r in result.items():
        lines.append("| %s | %.4f | %.2f | %s | %s |" % (
            name.replace("_", ", "), r["rmse_64"], r["cpu_seconds_64"],
            r["cpu_seconds_to_target"] or "not reached", r.get("cpu_ratio_to_lavaray") or ""))
    return "\n".join(lines)
