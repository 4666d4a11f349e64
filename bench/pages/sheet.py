#!/usr/bin/env python3
"""Pictures of equal size in rows, as one PNG of few bytes: colours are rounded to 32 steps a channel, so that it compresses.
sheet.py OUT.png COLUMNS A.png B.png ..."""
import struct, sys, zlib


def read(path):
    """Rows of 8-bit RGB of a PNG that isn't interlaced (PNG specification, section 9: filters)."""
    data, at, pixels = open(path, "rb").read(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", data[at + 8 : at + 18])
            assert depth == 8 and color in (2, 6), path
        pixels += data[at + 8 : at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    raw, step, rows, above = zlib.decompress(pixels), {2: 3, 6: 4}[color], [], bytes(width * 4)
    for y in range(height):
        start = y * (width * step + 1)
        kind, row = raw[start], bytearray(raw[start + 1 : start + 1 + width * step])
        for i in range(len(row)):
            left, up, corner = (row[i - step] if i >= step else 0), above[i], (above[i - step] if i >= step else 0)
            nearest = min((abs(up - corner), 0, left), (abs(left - corner), 1, up), (abs(left + up - 2 * corner), 2, corner))[2]
            row[i] = (row[i] + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
        above = bytes(row)
        rows.append(bytes(v & 0xF8 for i, v in enumerate(row) if i % step < 3))
    return rows


columns, pictures = int(sys.argv[2]), [read(path) for path in sys.argv[3:]]
lines = [b"".join(p[y] for p in pictures[first : first + columns]) for first in range(0, len(pictures), columns) for y in range(len(pictures[first]))]
packed, above = b"", bytes(len(lines[0]))
for line in lines:
    packed += b"\2" + bytes((a - b) & 255 for a, b in zip(line, above))
    above = line
chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
header = struct.pack(">IIBBBBB", len(lines[0]) // 3, len(lines), 8, 2, 0, 0, 0)
open(sys.argv[1], "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(packed, 9)) + chunk(b"IEND", b""))
