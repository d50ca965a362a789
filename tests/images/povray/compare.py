"""compare.py A.ppm B.ppm: the share of pixels of two 16-bit linear PPMs, in per cent, whose channels
all agree within 1/255 of full scale."""

import re
import struct
import sys


def read(path):
    data = open(path, "rb").read()
    header = re.match(rb"P6\s+(\d+)\s+(\d+)\s+65535\s", data)
    width, height = int(header[1]), int(header[2])
    count = 3 * width * height
    return width, height, struct.unpack(">%dH" % count, data[header.end() : header.end() + 2 * count])


width, height, a = read(sys.argv[1])
assert (width, height) == read(sys.argv[2])[:2]
b = read(sys.argv[2])[2]
agree = 0
for i in range(0, len(a), 3):
    agree += all(abs(a[i + c] - b[i + c]) <= 65535 / 255 for c in range(3))
print("%.3f" % (100 * agree / (width * height)))
