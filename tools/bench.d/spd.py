"""The scenes of the Standard Procedural Databases, beside POV-Ray and Tachyon on the same scenes, which
`lavaray convert` writes: whole processes, and what tracing alone takes."""

import os
import re
import shutil
import subprocess
import tempfile

from common import LAVARAY, SPHERE, machine, ratio, read_stats, run, summary, version, write_text

# Name, scene, size. Tachyon does not refract, so it does not draw mount's glass.
PICTURES = [("balls", "balls", 512, 512), ("gears", "gears", 512, 512), ("mount", "mount", 512, 512),
            ("teapot", "teapot", 512, 512), ("tetra", "tetra", 512, 512),
            ("balls_1080p", "balls", 1920, 1080), ("one_sphere", None, 16, 16)]
REFRACTS = {"mount"}
DEPTH = "4"  # five generations


def prepare(scene, data, width, height, work):
    """The scene with the picture's size in it, which gives the peers its aspect ratio; and for them."""
    if scene:
        with open(os.path.join(data, scene + ".nff"), encoding="utf-8") as file:
            text = re.sub(r"(?m)^resolution .*$", "resolution %d %d" % (width, height), file.read())
        path = os.path.join(work, "scene.nff")
    else:
        text = SPHERE + "image: {width: %d, height: %d, samples: 1}\n" % (width, height)
        path = os.path.join(work, "scene.yaml")
    write_text(path, text)
    for ending in ("pov", "dat"):
        subprocess.run([LAVARAY, "convert", "-q", path, os.path.join(work, "scene." + ending)], check=True)
    return path


def list_commands(path, scene, width, height):
    """The commands, all of which write a PPM, by their names."""
    commands = {"lavaray": [LAVARAY, "render", path, "-q", "--depth", DEPTH, "--spp", "1", "-o", "ours.ppm",
                            "--stats", "stats.json"]}
    if shutil.which("povray"):
        pov = ["povray", "+Iscene.pov", "+Opovray.ppm", "+FP", "+W%d" % width, "+H%d" % height, "-D", "-A"]
        commands["povray_boxes"] = pov + ["+BM1"]
        commands["povray_bsp"] = pov + ["+BM2"]
    if shutil.which("tachyon") and scene not in REFRACTS:
        commands["tachyon"] = ["tachyon", "scene.dat", "-shade_phong", "-format", "PPM", "-o", "tachyon.ppm"]
    return commands


def measure_picture(scene, data, width, height, count):
    with tempfile.TemporaryDirectory() as work:
        path = prepare(scene, data, width, height, work)
        commands = list_commands(path, scene, width, height)
        runs, trace = {name: [] for name in commands}, []
        for _ in range(count + 1):
            for name, command in commands.items():
                runs[name].append(run(command, folder=work))
            last = read_stats(os.path.join(work, "stats.json"))
            trace.append((last["cpu_seconds"]["trace"], last["seconds"]["trace"]))
        # The first round fills the shader cache.
        runs, trace = {name: r[1:] for name, r in runs.items()}, trace[1:]
    result = {"width": width, "height": height, "rays": last["rays"], "seconds": last["seconds"],
              "trace": summary(trace)}
    result.update({name: summary(r) for name, r in runs.items()})
    peers = [name for name in runs if name != "lavaray"]
    if peers:
        best = min(peers, key=lambda name: result[name]["cpu_seconds"])
        result["best_peer"] = best
        result["process_ratio"] = ratio(runs["lavaray"], runs[best])
        if scene:
            result["trace_ratio"] = ratio(trace, runs[best])
    return result


def measure(data, count):
    if not os.path.exists(os.path.join(data, "balls.nff")):
        return {"skipped": "no balls.nff in %s; --data names the folder" % data}
    result = {"machine": machine(), "povray": version("povray", "POV-Ray"),
              "tachyon": "installed" if shutil.which("tachyon") else None, "pictures": {}}
    for name, scene, width, height in PICTURES:
        result["pictures"][name] = measure_picture(scene, data, width, height, count)
    return result


def markdown(result):
    """The table in docs/performance.md."""
    if "skipped" in result:
        return result["skipped"]
    missing = [peer for peer in ("povray", "tachyon") if not result[peer]]
    columns = ["trace", "povray_boxes", "povray_bsp", "tachyon"]
    lines = ["| CPU s | lavaray | of it tracing | POV-Ray, boxes | POV-Ray, BSP | Tachyon | process ratio "
             "| trace ratio |",
             "|---|---|---|---|---|---|---|---|"]
    for name, p in result["pictures"].items():
        seconds = ["%.2f" % p[c]["cpu_seconds"] if c in p else "" for c in columns]
        lines.append("| %s, %d×%d | **%.2f** | %s | %s | %s | %s | %s | %s |" % (
            name.replace("_1080p", "").replace("_", " "), p["width"], p["height"],
            p["lavaray"]["cpu_seconds"], *seconds, p.get("process_ratio", ""), p.get("trace_ratio", "")))
    if missing:
        lines += ["", "Not installed: " + ", ".join(missing)]
    return "\n".join(lines)
