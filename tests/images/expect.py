# expect.py SCENE FOLDER: checks the scene's lines
#   # expect X,Y: R G B        linear values of the pixel in FOLDER/NAME.pfm, within 1e-4
#   # code MAXVAL X,Y: R G B   numbers of the pixel in FOLDER/NAME-MAXVAL.ppm, exactly
import pathlib
import re
import struct
import sys

scene = pathlib.Path(sys.argv[1])
folder = pathlib.Path(sys.argv[2])


def parts(path, magic):
    """Width, height, the header's last number, and the pixels' bytes."""
    match = re.match(rb"%s\s(\d+)\s(\d+)\s([-.\d]+)\s" % magic, data := path.read_bytes())
    if not match:
        sys.exit(f"{path}: not the header of {magic.decode()}")
    return int(match[1]), int(match[2]), float(match[3]), data[match.end():]


def pfm(x, y):
    width, height, scale, data = parts(folder / f"{scene.stem}.pfm", b"PF")
    if len(data) != width * height * 12 or scale >= 0:
        sys.exit(f"{scene.stem}.pfm: wrong size, or not little-endian")
    return struct.unpack_from("<3f", data, ((height - 1 - y) * width + x) * 12)


def ppm(maxval, x, y):
    width, height, found, data = parts(folder / f"{scene.stem}-{maxval}.ppm", b"P6")
    size = 1 if maxval < 256 else 2
    if found != maxval or len(data) != width * height * 3 * size:
        sys.exit(f"{scene.stem}-{maxval}.ppm: wrong maxval or size")
    return struct.unpack_from(">3B" if size == 1 else ">3H", data, (y * width + x) * 3 * size)


checks = failures = 0
for line in scene.read_text().splitlines():
    match = re.fullmatch(r"# (?:expect|code (\d+)) (\d+),(\d+): (\S+) (\S+) (\S+)", line)
    if not match:
        if re.match(r"# (expect|code) ", line):
            sys.exit(f"{scene}: cannot read: {line}")
        continue
    x, y = int(match[2]), int(match[3])
    want = [float(v) for v in match.groups()[3:]]
    got = ppm(int(match[1]), x, y) if match[1] else pfm(x, y)
    checks += 1
    if not all(abs(g - w) <= (0 if match[1] else 1e-4) for g, w in zip(got, want)):
        failures += 1
        print(f"{scene}: {line[2:]}, but is " + " ".join(f"{g:.6g}" for g in got), file=sys.stderr)
if not checks:
    sys.exit(f"{scene}: no expect lines")
sys.exit(failures > 0)
