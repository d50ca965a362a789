"""Compares our FLIP with the published one, pixel by pixel: flip.py LAVARAY FOLDER.

Pairs are 00.ppm with each other NN.ppm, and X-a with X-b. SSIM is compared with its definition, window
by window in two dimensions and double precision.
"""

import glob
import json
import os
import re
import subprocess
import sys

import flip_evaluator
import numpy

MEAN_TOLERANCE, PIXEL_TOLERANCE, SSIM_TOLERANCE = 1e-4, 1e-3, 1e-4


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


def ssim(a, b):
    """Wang et al. 2004 of the luma, over windows wholly inside."""
    peak = max(1, a.max())
    a, b = ((picture.astype(float) @ [0.2126, 0.7152, 0.0722]) / peak for picture in (a, b))
    taps = numpy.exp(-numpy.arange(-5, 6) ** 2 / (2 * 1.5**2))
    window = numpy.outer(taps, taps) / taps.sum() ** 2

    def mean(x):
        rows, columns = x.shape[0] - 10, x.shape[1] - 10
        return sum(window[i, k] * x[i:i + rows, k:k + columns] for i in range(11) for k in range(11))

    mean_a, mean_b = mean(a), mean(b)
    variances = mean(a * a) - mean_a**2 + mean(b * b) - mean_b**2
    covariance = mean(a * b) - mean_a * mean_b
    luminance = (2 * mean_a * mean_b + 0.01**2) / (mean_a**2 + mean_b**2 + 0.01**2)
    return (luminance * (2 * covariance + 0.03**2) / (variances + 0.03**2)).mean()


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
    similarity = abs(metrics["ssim"]["value"] - ssim(a, b))
    good = mean <= MEAN_TOLERANCE and pixel <= PIXEL_TOLERANCE and similarity <= SSIM_TOLERANCE
    words = "mean %.6f, off by %.1e, a pixel by at most %.1e, SSIM by %.1e" % (theirs.mean(), mean, pixel, similarity)
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
