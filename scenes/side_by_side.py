#!/usr/bin/env python3
"""Puts two pictures side by side, each of their pixels twice as large, so that single pixels can be seen.

    scenes/side_by_side.py OUT.png LEFT.png RIGHT.png

Both are 8-bit RGB as gpu-trace writes them, and of one height. Python's standard library is enough.
"""

import pathlib
import struct
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "assets"))
from make_textures import paeth, write_png  # noqa: E402

ZOOM = 2
GAP = 4  # white pixels between the two


def read_png(path):
    """Rows of RGB bytes (PNG specification 1.2, sections 5 and 6)."""
    data = path.read_bytes()
    at, packed, header = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += length + 12
    if data[:8] != b"\x89PNG\r\n\x1a\n" or header is None or header[2:] != (8, 2, 0, 0, 0):
        raise SystemExit(f"{path}: not an 8-bit RGB PNG without interlacing")
    width, height = header[:2]
    stream = zlib.decompress(packed)
    rows, above = [], bytes(3 * width)
    for y in range(height):
        start = y * (3 * width + 1)
        row = bytearray(stream[start + 1:start + 1 + 3 * width])
        for i, value in enumerate(row):
            a, b, c = (row[i - 3] if i >= 3 else 0), above[i], (above[i - 3] if i >= 3 else 0)
            row[i] = (value + (0, a, b, (a + b) // 2, paeth(a, b, c))[stream[start]]) & 255
        above = bytes(row)
        rows.append(above)
    return rows


def enlarged(row):
    return b"".join(row[i:i + 3] * ZOOM for i in range(0, len(row), 3))


def main():
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    target, left, right = (pathlib.Path(name) for name in sys.argv[1:])
    pairs = zip(read_png(left), read_png(right), strict=True)
    rows = [enlarged(a) + b"\xff" * (3 * GAP) + enlarged(b) for a, b in pairs]
    write_png(target, [row for row in rows for _ in range(ZOOM)], 3)


if __name__ == "__main__":
    main()
