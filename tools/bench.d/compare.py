"""The comparison of a 1080p pair of pictures, beside idiff and the published FLIP where they are
installed: two renders of the showcase that differ in their seeds and exposures, so everywhere."""

import os
import shutil

from common import LAVARAY, ROOT, ratio, run, summary


def measure(scene, work, count):
    """A dictionary of results."""
    pair = {}
    for ending in ("png", "ppm", "pfm"):
        pair[ending] = [os.path.join(work, "%s.%s" % (name, ending)) for name in "ab"]
        for path, flags in zip(pair[ending], (["--seed", "1"], ["--seed", "2", "--exposure", "0.1"])):
            run([LAVARAY, "render", scene, "-q", "--size", "1920x1080", "--spp", "1", "--depth", "2",
                 "-o", path] + flags)
    ours = [LAVARAY, "compare"]
    commands = {
        "exact_abs_png": ours + pair["png"] + ["--exact", "--abs", "0.1", "-q"],
        "exact_abs_ppm": ours + pair["ppm"] + ["--exact", "--abs", "0.1", "-q"],
        "exact_abs_png_explained": ours + pair["png"] + ["--exact", "--abs", "0.1"],
        "same_png": ours + [pair["png"][0]] * 2,
        "ssim_png": ours + pair["png"] + ["--ssim", "0.9", "-q"],
        "flip_png": ours + pair["png"] + ["--flip-mean", "0.1", "-q"],
        "hdr_flip_pfm": ours + pair["pfm"] + ["--flip-mean", "0.1", "-q"],
    }
    idiff = shutil.which("idiff")
    if idiff:
        commands["idiff_png"] = [idiff, "-fail", "0.1"] + pair["png"]
        commands["idiff_ppm"] = [idiff, "-fail", "0.1"] + pair["ppm"]
    own = os.path.join(ROOT, ".cache", "flip", "bin")
    flip = shutil.which("flip", path=own + os.pathsep + os.environ["PATH"])
    if flip:
        commands["flip_evaluator_png"] = [flip, "-r", pair["png"][0], "-t", pair["png"][1], "-nexm", "-nerm",
                                          "-d", work]
    runs = {name: [] for name in commands}
    for _ in range(count):
        for name, command in commands.items():
            runs[name].append(run(command, check=False))
    results = {name: summary(r) for name, r in runs.items()}
    if idiff:
        results["cpu_ratio_to_idiff_png"] = ratio(runs["exact_abs_png"], runs["idiff_png"])
        results["cpu_ratio_to_idiff_png_explained"] = ratio(runs["exact_abs_png_explained"], runs["idiff_png"])
        results["cpu_ratio_to_idiff_ppm"] = ratio(runs["exact_abs_ppm"], runs["idiff_ppm"])
    if flip:
        results["cpu_ratio_to_flip_evaluator"] = ratio(runs["flip_png"], runs["flip_evaluator_png"])
    return results
