#!/usr/bin/env python3
"""Renders the references of this folder's scenes with Mitsuba 3.

    render_references.py [NAME...]        all scenes, or these

Needs mitsuba, numpy and pyyaml from PyPI and, for Mitsuba, the library of LLVM 16 or later (its path in
DRJIT_LIBLLVM_PATH). NAME.yaml becomes NAME.exr: the means of many renders as R, G, B, and their
standard errors as error.R, error.G, error.B, in 16-bit floats. About a minute of CPU time for each.
"""

import os
import struct
import sys

import mitsuba as mi
import numpy as np
from exr import attribute, write_exr

mi.set_variant("llvm_ad_rgb")
import to_mitsuba  # noqa: E402  (transforms need the variant)

FOLDER = os.path.dirname(os.path.abspath(__file__))
RENDERS, SAMPLES = 32, 512


def cornell():
    """Mitsuba's own, with our camera's film."""
    scene = mi.cornell_box()
    ours = to_mitsuba.load(os.path.join(FOLDER, "cornell.yaml"))
    scene["sensor"]["film"] = ours["sensor"]["film"]
    return scene


def surroundings():
    """Writes surroundings.exr, 64 x 32: ground below, a sky that is brighter on one side, a small sun."""
    height, width = 32, 64
    y, x = (np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width
    up = np.cos(np.pi * y)[:, None, None]
    side = (1 + 0.5 * np.sin(2 * np.pi * x))[None, :, None]
    sky = side * ((1 - up) * np.array([0.9, 0.8, 0.7]) + up * np.array([0.15, 0.3, 0.7]))
    picture = np.where(up > 0, sky, 0.2 * side * np.array([0.5, 0.4, 0.3]))
    picture[8, 40] = [400, 350, 250]
    write("surroundings", {"": picture})


def statistics(scene, renders, samples):
    """Mean and standard error of so many renders."""
    total = squares = 0
    for seed in range(renders):
        picture = np.array(mi.render(scene, spp=samples, seed=seed), dtype=float)
        total, squares = total + picture, squares + picture ** 2
    mean = total / renders
    return mean, np.sqrt(np.maximum(squares / renders - mean ** 2, 0) / (renders - 1))


def write(name, pictures, **attributes):
    """pictures: a layer's name ("" or "NAME.") to an array of height x width x 3."""
    height, width, _ = next(iter(pictures.values())).shape
    write_exr(os.path.join(FOLDER, name + ".exr"), (width, height), {
        layer + channel: picture[:, :, i].ravel()
        for layer, picture in pictures.items() for i, channel in enumerate("RGB")}, b"".join(
            attribute(key.encode(), b"int", struct.pack("<i", value))
            for key, value in attributes.items()))


def main():
    names = sys.argv[1:] or sorted(
        name[:-5] for name in os.listdir(FOLDER) if name.endswith(".yaml"))
    surroundings()
    for name in names:
        scene = cornell() if name == "cornell" else to_mitsuba.load(
            os.path.join(FOLDER, name + ".yaml"))
        mean, error = statistics(mi.load_dict(scene), RENDERS, SAMPLES)
        write(name, {"": mean, "error.": error}, renders=RENDERS, samples=SAMPLES)
        print("%-12s mean %s, error %.2f %% of it" % (
            name, mean.mean((0, 1)).round(4), 100 * error.mean() / mean.mean()), flush=True)


if __name__ == "__main__":
    main()
