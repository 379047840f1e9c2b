#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws font.png, the letters of the pictures, in DejaVu Sans.

The font is free (Bitstream Vera's licence; changes are in the public domain) and comes with Debian's fonts-dejavu-core;
drawing it takes python3-pil too. Neither is needed to build or to run gridmerge.

A cell for each character of font_characters.hpp, 32 in a row. Its first row of pixels is white as far as the character
advances; below, gray is how much the letter covers. The sizes are those of font.cpp.
"""

import pathlib
import re

from PIL import Image, ImageDraw, ImageFont

FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
EM = 60
COLUMNS, CELL_WIDTH, CELL_HEIGHT = 32, 84, 76
LEFT, TOP = 8, 4  # where a letter's box begins in its cell
# One of so many steps between two levels of gray: a third of the bytes, and no difference to the eye.
GRAYS = 17


def characters(header):
    ranges = re.findall(r"\{(0x[0-9a-f]+), (0x[0-9a-f]+)\}", header.read_text(encoding="ascii"))
    return [chr(code) for first, last in ranges for code in range(int(first, 16), int(last, 16) + 1)]


def main():
    here = pathlib.Path(__file__).resolve().parent
    font = ImageFont.truetype(FONT, EM, layout_engine=ImageFont.Layout.BASIC)
    drawn = characters(here / "font_characters.hpp")
    rows = -(-len(drawn) // COLUMNS)
    picture = Image.new("L", (COLUMNS * CELL_WIDTH, rows * CELL_HEIGHT))
    draw = ImageDraw.Draw(picture)
    for i, character in enumerate(drawn):
        x, y = i % COLUMNS * CELL_WIDTH, i // COLUMNS * CELL_HEIGHT
        draw.text((x + LEFT, y + TOP), character, 255, font=font)
    picture = picture.point(lambda gray: round(gray / GRAYS) * GRAYS)
    draw = ImageDraw.Draw(picture)
    for i, character in enumerate(drawn):
        x, y = i % COLUMNS * CELL_WIDTH, i // COLUMNS * CELL_HEIGHT
        draw.rectangle((x, y, x + round(font.getlength(character)) - 1, y), fill=255)
    picture.save(here / "font.png", optimize=True)


if __name__ == "__main__":
    main()
