"""Mitsuba's Cornell box, for path.py.

    mitsuba_cornell.py SAMPLER SIZE FILE.pfm SPP SEED    one render; prints its CPU seconds
    mitsuba_cornell.py reference SIZE FILE.pfm           2048 samples, and its noise in FILE.pfm.json

Needs mitsuba and numpy and the library of LLVM 16 or later (its path in DRJIT_LIBLLVM_PATH).
"""

import json
import sys
import time

import mitsuba as mi
import numpy as np

PASSES, SAMPLES = 8, 256  # of the reference; its noise is an eighth of the target

mi.set_variant("llvm_ad_rgb")


def load(sampler, size, spp):
    scene = mi.cornell_box()
    scene["sensor"]["film"].update(width=size, height=size, rfilter={"type": "box"})
    scene["sensor"]["sampler"] = {"type": sampler, "sample_count": spp}
    return mi.load_dict(scene)


def write_pfm(path, picture):
    height, width, _ = picture.shape
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (width, height) + picture[::-1].astype("<f4").tobytes())


def render(scene, spp, seed):
    """As Mitsuba gives it, which is when all is computed."""
    return np.array(mi.render(scene, spp=spp, seed=seed))


def reference(size, path):
    scene = load("multijitter", size, SAMPLES)
    total = squares = 0
    for seed in range(PASSES):
        picture = render(scene, SAMPLES, 1000 + seed).astype(float)
        total, squares = total + picture, squares + picture ** 2
    mean = total / PASSES
    variance = np.maximum(squares / PASSES - mean ** 2, 0) / (PASSES - 1)
    with open(path + ".json", "w", encoding="utf-8") as file:
        json.dump({"noise": float(np.sqrt(variance.mean())), "samples": PASSES * SAMPLES}, file)
    write_pfm(path, mean)


def main():
    sampler, size, path = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    if sampler == "reference":
        reference(size, path)
        return
    spp, seed = int(sys.argv[4]), int(sys.argv[5])
    scene = load(sampler, size, spp)
    render(scene, spp, seed + 500)  # compiles
    before = time.process_time()
    picture = render(scene, spp, seed)
    print(time.process_time() - before)
    write_pfm(path, picture)


if __name__ == "__main__":
    main()
