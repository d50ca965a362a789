"""Large meshes: the kernels that find hits, beside Embree on the same rays (traverse.c); what a mesh
takes until it is on the device; and how a frame's time grows with triangles and pixels."""

import json
import os
import statistics
import subprocess
import tempfile

import plot
from common import LAVARAY, ROOT, machine, read_stats, run, summary, write_text

BUILD = os.path.join(ROOT, "build", "release")
PROGRAM = os.path.join(BUILD, "bench_traverse")
# Hills of 2 side^2 triangles.
SIDES = {"10k": 71, "100k": 224, "1M": 708, "10M": 2236}
SIZES = [(384, 256), (768, 512), (1536, 1024), (3456, 2304)]
SCENE = """camera: {from: [0.5, 1.1, -0.6], to: [0.5, 0.4, 0.4], fov: 40}
lights:
  - point: {position: [-1, 2, 0.2]}
objects:
  - mesh: {file: hills.ply}
"""
# Under a sky that paths find by themselves; COLOR and LIGHTS are filled in.
PATHS = """image: {width: 512, height: 512, samples: 8, depth: 6, integrator: path}
background: {gradient: [[0.4, 0.5, 0.7], [1, 1, 1]]}
materials: {matt: {model: diffuse, color: COLOR}}
camera: {from: [0.5, 1.1, -0.6], to: [0.5, 0.4, 0.4], fov: 40}
lights: LIGHTS
objects:
  - mesh: {file: hills.ply, material: matt}
"""
LAMP = "[{point: {position: [-1, 2, 0.2]}}]"


def build():
    subprocess.run(["cmake", "--build", BUILD, "--target", "bench_traverse", "lavaray"], check=True,
                   stdout=subprocess.DEVNULL)


def write_hills(side, work):
    path = os.path.join(work, "hills.ply")
    subprocess.run([PROGRAM, "write", str(side), path], check=True)
    return path


def trace_paths(work, color, lights):
    """Bounced rays, rays towards lights, and CPU seconds of tracing of a path-traced frame."""
    text = PATHS.replace("COLOR", str(color)).replace("LIGHTS", lights)
    write_text(os.path.join(work, "paths.yaml"), text)
    run([LAVARAY, "render", "paths.yaml", "-q", "-o", "a.ppm", "--stats", "stats.json"], folder=work)
    stats = read_stats(os.path.join(work, "stats.json"))
    rays = stats["rays"]
    return rays["bounced"]["traced"], rays["shadow"]["traced"], stats["cpu_seconds"]["trace"]


def measure_paths(work, traversal):
    """Millions of rays per CPU second end to end, and their share of `traversal`: bounces, without what the
    same frame of black ground takes, where paths end at their first hit; and in a frame with a light, camera
    rays' time included, bounces and rays towards the light."""
    camera_seconds = trace_paths(work, 0, "[]")[2]
    bounced, _, seconds = trace_paths(work, 0.7, "[]")
    alone = 1e-6 * bounced / (seconds - camera_seconds)
    bounced, asked, seconds = trace_paths(work, 0.7, LAMP)
    frame = 1e-6 * (bounced + asked) / seconds
    return {"bounces": alone, "bounces_share": alone / traversal,
            "frame_with_light": frame, "frame_share": frame / traversal}


def medians(rounds):
    """Of each number in results of the same form."""
    first = rounds[0]
    if isinstance(first, dict):
        return {key: medians([result[key] for result in rounds]) for key in first}
    return first if isinstance(first, str) else statistics.median(rounds)


def measure(count):
    """In rounds, so that a machine's drift meets all that is compared."""
    build()
    result = {"machine": machine()}
    for name, side in (("70k", 187), ("1M", 708)):
        rounds = []
        with tempfile.TemporaryDirectory() as work:
            command = [PROGRAM, "measure", str(side), write_hills(side, work), "1"]
            for _ in range(count):
                told = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
                traversal = told["bounce"]["lavaray_packets"]["mrays_per_cpu_second"]
                rounds.append(dict(told, paths=measure_paths(work, traversal)))
        result[name] = medians(rounds)
    return result


def percent(ours, theirs):
    return "%.0f %%" % (100 * ours / theirs)


def markdown(result):
    lines = ["| Mray per CPU second | lavaray, packets | Embree, packets of 16 | | lavaray, single rays "
             "| Embree, single rays | |", "|---|---|---|---|---|---|---|"]
    for size in ("70k", "1M"):
        for kind in ("primary", "shadow", "bounce"):
            cells = []
            for way in ("packets", "single"):
                rates = [result[size][kind].get("%s_%s" % (who, way), {}).get("mrays_per_cpu_second")
                         for who in ("lavaray", "embree")]
                cells += ["**%.2f**" % rates[0], "%.2f" % rates[1] if rates[1] else "",
                          percent(*rates) if rates[1] else ""]
            lines.append("| %s triangles, %s | %s |" % (size, kind, " | ".join(cells)))
    if "embree_packets" not in result["70k"]["primary"]:
        lines += ["", "Not installed: libembree-dev"]
    lines += ["", "| CPU s | read the PLY file | pack and build | upload | bytes a triangle on the device "
              "| peak of the host |", "|---|---|---|---|---|---|"]
    for size in ("70k", "1M"):
        costs = result[size]["costs"]
        lines.append("| %s | %.2f | %.2f | %.2f | %.0f | %.0f MB |" % (
            (size,) + tuple(costs[step]["cpu_seconds"] for step in ("load", "build", "upload")) +
            (costs["device_bytes_per_triangle"], 1e-6 * costs["peak_bytes"])))
    lines += ["", "| Mray per CPU second | traversal alone, bounce | paths, bounces | | a whole frame with a "
              "light | |", "|---|---|---|---|---|---|"]
    for size in ("70k", "1M"):
        alone, paths = result[size]["bounce"]["lavaray_packets"]["mrays_per_cpu_second"], result[size]["paths"]
        lines.append("| %s triangles | %.2f | %.2f | %.0f %% | %.2f | %.0f %% |" % (
            size, alone, paths["bounces"], 100 * paths["bounces_share"], paths["frame_with_light"],
            100 * paths["frame_share"]))
    return "\n".join(lines)


def measure_frame(work, width, height, count):
    write_text(os.path.join(work, "scene.yaml"), SCENE)
    command = [LAVARAY, "render", "scene.yaml", "-q", "--spp", "1", "--size", "%dx%d" % (width, height),
               "-o", "a.ppm", "--stats", "stats.json"]
    runs, trace = [], []
    for _ in range(count + 1):
        runs.append(run(command, folder=work))
        stats = read_stats(os.path.join(work, "stats.json"))
        trace.append((stats["cpu_seconds"]["trace"], stats["seconds"]["trace"]))
    rays = stats["rays"]["total"]
    return {"width": width, "height": height, "rays": rays, "process": summary(runs[1:]),
            "trace": summary(trace[1:]), "peak_memory_bytes": stats["peak_memory_bytes"]}


def measure_growth(count, full, picture):
    build()
    result = {"machine": machine(), "triangles": {}, "pixels": {}}
    for name, side in SIDES.items():
        if name == "10M" and not full:
            continue
        with tempfile.TemporaryDirectory() as work:
            write_hills(side, work)
            frame = measure_frame(work, 512, 512, count)
            result["triangles"][name] = dict(frame, triangles=2 * side * side)
            if name == "100k":
                for width, height in SIZES:
                    frame = measure_frame(work, width, height, count)
                    result["pixels"]["%.1f MP" % (1e-6 * width * height)] = frame
    if picture:
        write_text(picture, plot.draw([curves(result["triangles"], "triangles, 512×512 pixels",
                                              lambda f: f["triangles"]),
                                       curves(result["pixels"], "pixels, 100,352 triangles",
                                              lambda f: f["width"] * f["height"])]))
    return result


def curves(frames, title, x):
    """What plot.draw makes a panel of."""
    return {"title": title, "unit": "CPU seconds",
            "curves": {"the whole process": [(x(f), f["process"]["cpu_seconds"]) for f in frames.values()],
                       "tracing and shading": [(x(f), f["trace"]["cpu_seconds"]) for f in frames.values()]}}


def growth_markdown(result):
    lines = ["| | rays | whole process, CPU s | tracing and shading, CPU s | peak of the host |",
             "|---|---|---|---|---|"]
    for kind in ("triangles", "pixels"):
        for name, f in result[kind].items():
            lines.append("| %s, %d×%d | %.2f M | %.2f | %.3f | %.0f MB |" % (
                name + (" triangles" if kind == "triangles" else ""), f["width"], f["height"],
                1e-6 * f["rays"], f["process"]["cpu_seconds"], f["trace"]["cpu_seconds"],
                1e-6 * f["peak_memory_bytes"]))
    return "\n".join(lines)
