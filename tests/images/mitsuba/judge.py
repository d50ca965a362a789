#!/usr/bin/env python3
"""Renders this folder's scenes with lavaray and compares them with Mitsuba's references.

    judge.py LAVARAY [NAME...] [--seeds N] [--spp N] [--keep FOLDER]

For each scene: the ratio of the pictures' means per channel, and the share of samples (pixels'
channels) whose difference is within a bound. Their noise is that of the seeds' renders and the
reference's standard error; the bound is what t exceeds in one of a thousand samples that differ by
normal noise alone, so at least 99.9 % are expected within it. --keep writes FOLDER/NAME.pfm, the mean, and
FOLDER/NAME-t.pfm, where red is brighter than the reference and blue darker, 1 being the bound. Exit
code 1 when a scene fails.
"""

import argparse
import array
import math
import os
import statistics
import struct
import subprocess
import sys
import tempfile

from exr import read_exr

FOLDER = os.path.dirname(os.path.abspath(__file__))

MEAN_TOLERANCE = 0.001  # of the ratio of means, beside three standard errors
SHARE = 0.9975          # of the samples within the bound
BEYOND = 0.001          # probability that noise alone exceeds the bound


def read_pfm(path):
    with open(path, "rb") as file:
        if file.readline() != b"PF\n":
            sys.exit(path + ": not a colour PFM")
        width, height = map(int, file.readline().split())
        file.readline()
        pixels = array.array("f", file.read())
    if sys.byteorder == "big":
        pixels.byteswap()
    rows = [pixels[3 * width * y:3 * width * (y + 1)] for y in reversed(range(height))]
    return width, height, [value for row in rows for value in row]


def write_pfm(path, width, height, pixels):
    rows = [pixels[3 * width * y:3 * width * (y + 1)] for y in reversed(range(height))]
    flat = array.array("f", [value for row in rows for value in row])
    if sys.byteorder == "big":
        flat.byteswap()
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (width, height) + flat.tobytes())


def render(arguments, name, size, seed, work):
    """The samples of one render."""
    path = os.path.join(work, "a.pfm")
    command = [arguments.lavaray, "render", os.path.join(FOLDER, name + ".yaml"), "-q", "--seed",
               str(seed), "-o", path] + (["--spp", str(arguments.spp)] if arguments.spp else [])
    if subprocess.run(command, check=False, timeout=600).returncode:
        sys.exit("judge.py: %s cannot be rendered" % name)
    width, height, samples = read_pfm(path)
    if (width, height) != size:
        sys.exit("%s: %d x %d pixels, but %d x %d in the reference" % (name, width, height, *size))
    return samples


def student_bound(freedom, z):
    """The t of this many degrees of freedom that is as improbable as the normal score z (Hill's
    asymptotic expansion, Abramowitz and Stegun 26.7.5)."""
    return z + (z ** 3 + z) / (4 * freedom) + (5 * z ** 5 + 16 * z ** 3 + 3 * z) / (96 * freedom ** 2) + (
        3 * z ** 7 + 19 * z ** 5 + 17 * z ** 3 - 15 * z) / (384 * freedom ** 3)


NORMAL_BOUND = statistics.NormalDist().inv_cdf(1 - BEYOND / 2)


def t_share(mean, variance, count, reference, error, reference_count):
    """Welch's t of one sample in units of its bound."""
    rounding = (abs(reference) * 2.0 ** -12) ** 2 + 1e-14  # the reference has 16 bits
    ours, theirs = variance / count, error ** 2
    noise = ours + theirs
    freedom = noise ** 2 / (ours ** 2 / (count - 1) + theirs ** 2 / (reference_count - 1)) if noise else 1e9
    return (mean - reference) / math.sqrt(noise + rounding) / student_bound(freedom, NORMAL_BOUND)


def variances(stacks, means, width):
    """Of each sample's renders, or of those around it if that is more: where all renders have missed a
    rare way of bright light, they agree with each other as well."""
    own = [statistics.variance(s, m) for s, m in zip(stacks, means)]
    row, height = 3 * width, len(own) // (3 * width)
    result = []
    for i, variance in enumerate(own):
        x, y = i % row, i // row
        around = [own[v * row + u] for v in range(max(y - 1, 0), min(y + 2, height))
                  for u in range(x - 3 if x >= 3 else x, min(x + 4, row), 3)]
        result.append(max(variance, statistics.fmean(around)))
    return result


def ratios(renders, reference, error):
    """Per channel the ratio of the means to the reference's, and its standard error."""
    for channel in range(3):
        base = math.fsum(reference[channel::3])
        means = [math.fsum(picture[channel::3]) / base for picture in renders]
        ours = statistics.variance(means) / len(means)
        theirs = math.fsum(e * e for e in error[channel::3]) / base ** 2
        yield statistics.fmean(means), math.sqrt(ours + theirs)


def read_reference(name):
    """Width and height, samples and their standard errors, and how many renders gave these."""
    path = os.path.join(FOLDER, name + ".exr")
    if not os.path.exists(path):
        sys.exit(path + " is missing; render_references.py makes it")
    size, channels, attributes = read_exr(path)
    pictures = [[v for pixel in zip(*(channels[layer + c] for c in "RGB")) for v in pixel]
                for layer in ("", "error.")]
    return size, *pictures, struct.unpack("<i", attributes["renders"])[0]


def write_maps(folder, name, size, means, t):
    colors = [c for i in range(0, len(t), 3) for c in signed_color(t[i:i + 3])]
    write_pfm(os.path.join(folder, name + ".pfm"), *size, means)
    write_pfm(os.path.join(folder, name + "-t.pfm"), *size, colors)


def signed_color(t):
    worst = max(t, key=abs)
    return (max(worst, 0), 0, max(-worst, 0))


def judge(name, arguments):
    """Whether the scene's renders have the reference as their mean."""
    size, reference, error, count = read_reference(name)
    with tempfile.TemporaryDirectory() as work:
        renders = [render(arguments, name, size, seed, work) for seed in range(arguments.seeds)]
    stacks = list(zip(*renders))
    means = [statistics.fmean(s) for s in stacks]
    t = [t_share(m, v, len(renders), r, e, count)
         for m, v, r, e in zip(means, variances(stacks, means, size[0]), reference, error)]
    if arguments.keep:
        write_maps(arguments.keep, name, size, means, t)
    share = sum(abs(x) <= 1 for x in t) / len(t)
    passed, told = share >= SHARE, []
    for ratio, deviation in ratios(renders, reference, error):
        passed &= abs(ratio - 1) <= MEAN_TOLERANCE + 3 * deviation
        told.append("%+.3f±%.3f %%" % (100 * (ratio - 1), 100 * deviation))
    print("%s  %-12s means %s, within the bound %.2f %%" % (
        "ok  " if passed else "FAIL", name, ", ".join(told), 100 * share), flush=True)
    return passed


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("lavaray")
    parser.add_argument("names", nargs="*", help="scenes (default: all)")
    parser.add_argument("--seeds", type=int, default=16, help="renders of each scene (default 16)")
    parser.add_argument("--spp", type=int, help="samples of each (default: the scene's)")
    parser.add_argument("--keep", help="folder for the means and the maps of t")
    arguments = parser.parse_args()
    names = arguments.names or sorted(n[:-5] for n in os.listdir(FOLDER) if n.endswith(".yaml"))
    if arguments.keep:
        os.makedirs(arguments.keep, exist_ok=True)
    passed = [judge(name, arguments) for name in names]
    sys.exit(not all(passed))


if __name__ == "__main__":
    main()
