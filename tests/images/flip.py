"""Compares our FLIP with the published one, pixel by pixel: flip.py LAVARAY FOLDER.

Pairs are 00.ppm with each other NN.ppm, and X-a with X-b. SSIM is compared with scikit-image where
that is installed.
"""

import glob
import json
import os
import re
import subprocess
import sys

import flip_evaluator
import numpy

try:
    from skimage.metrics import structural_similarity
except ImportError:
    structural_similarity = None

MEAN_TOLERANCE, PIXEL_TOLERANCE = 1e-4, 1e-3


def read(path):
    """A binary PPM as 0..1, or a little-endian PFM as it is; top row first."""
    with open(path, "rb") as file:
        data = file.read()
    magic, width, height, last, raster = re.match(
        rb"(P6|PF)\s+(\d+)\s+(\d+)\s+(\S+)\s(.*)", data, re.DOTALL).groups()
    shape = int(height), int(width), 3
    if magic == b"P6":
        return numpy.frombuffer(raster, numpy.uint8).reshape(shape).astype(numpy.float32) / numpy.float32(last)
    return numpy.ascontiguousarray(numpy.frombuffer(raster, "<f4").reshape(shape)[::-1])


def judge(lavaray, reference, test, ppd):
    a, b = read(reference), read(test)
    hdr = reference.endswith(".pfm")
    parameters = {"ppd": ppd} if ppd else {}
    theirs = flip_evaluator.evaluate(a, b, "HDR" if hdr else "LDR", applyMagma=False, parameters=parameters)[0]
    theirs = theirs[..., 0].astype(numpy.float64)
    diff = os.path.join(os.path.dirname(test), "diff.pfm")
    command = [lavaray, "compare", reference, test, "--flip-mean", "1", "--ssim", "0", "--diff", diff, "--json", "-"]
    command += ["--ppd", str(ppd)] if ppd else []
    metrics = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["metrics"]
    ours = read(diff)[..., 0]
    mean = abs(metrics["flip-mean"]["value"] - theirs.mean())
    pixel = numpy.abs(ours - theirs).max()
    good = mean <= MEAN_TOLERANCE and pixel <= PIXEL_TOLERANCE and theirs.shape == ours.shape
    words = "mean %.6f, off by %.1e, a pixel by at most %.1e" % (theirs.mean(), mean, pixel)
    if structural_similarity:
        luma = numpy.array([0.2126, 0.7152, 0.0722])
        expected = structural_similarity(a @ luma, b @ luma, gaussian_weights=True, sigma=1.5,
                                         use_sample_covariance=False, data_range=max(1, a.max()))
        ssim = abs(metrics["ssim"]["value"] - expected)
        good = good and ssim < 1e-4
        words += ", SSIM by %.1e" % ssim
    print("%s %s: %s" % ("ok    " if good else "FAILED", os.path.basename(test), words))
    return good


def main():
    lavaray, folder = sys.argv[1:]
    faulty = sorted(glob.glob(os.path.join(folder, "[0-9]*.ppm")))
    pairs = [(faulty[0], test, None) for test in faulty[1:]]
    for first in sorted(glob.glob(os.path.join(folder, "*-a.p*m"))):
        pairs.append((first, first.replace("-a.", "-b."), None))
    pairs += [(faulty[0], faulty[5], 20), (faulty[0], faulty[6], 150)]
    results = [judge(lavaray, *pair) for pair in pairs]
    print("%d of %d pairs agree" % (sum(results), len(results)))
    sys.exit(len(results) < 30 or not all(results))


if __name__ == "__main__":
    main()
