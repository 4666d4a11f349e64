#!/usr/bin/python3
"""Pictures of equal size in rows, as one PNG of few bytes: colours are rounded to 32 steps a channel, so that it compresses.
sheet.py OUT.png COLUMNS A.png B.png ..."""
# The system's Python, not the first of the path: packages.txt installs Pillow for that one.
import sys

from PIL import Image


def main():
    out, columns = sys.argv[1], int(sys.argv[2])
    pictures = [Image.open(path).convert("RGB") for path in sys.argv[3:]]
    width, height = pictures[0].size
    for path, picture in zip(sys.argv[3:], pictures):
        if picture.size != (width, height):
            sys.exit(f"{path} has {picture.width}x{picture.height} pixels, the first picture {width}x{height}; give pictures of one size")
    rows = -(-len(pictures) // columns)
    sheet = Image.new("RGB", (min(columns, len(pictures)) * width, rows * height))
    for number, picture in enumerate(pictures):
        sheet.paste(picture.point(lambda value: value & 0xF8), (number % columns * width, number // columns * height))
    sheet.save(out, optimize=True)


if __name__ == "__main__":
    main()
