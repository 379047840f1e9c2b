#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/simulated.png: each kind of simulated building, and below it the map of one robot.

usage: experiments/simulated_picture.py GRIDMERGE OUTPUT.png
"""

import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import zlib

SIZES = {"apartment": "14x11", "corridor": "50x20", "arena": "25x25", "maze": "25x17"}
USUAL_SIZE = "40x25"
TILE_WIDTH, TILE_HEIGHT, MARGIN = 300, 210, 10
OCCUPIED, FREE, UNKNOWN = 0, 254, 205


def all_kinds(gridmerge: str) -> list[str]:
    """As `gridmerge simulate --help` lists them."""
    text = subprocess.run(
        [gridmerge, "simulate", "--help"], check=True, capture_output=True, text=True
    ).stdout
    return re.search(r"--kind KIND:{(.*?)}", text)[1].split(",")


def read_pgm(path: pathlib.Path) -> tuple[int, int, bytes]:
    data = path.read_bytes()
    _, width, height, _ = data.split(None, 4)[:4]
    return int(width), int(height), data[-int(width) * int(height) :]


def shrink(width: int, height: int, pixels: bytes) -> tuple[int, int, list[int]]:
    """To the size of a tile: a block with a wall is wall, else free if any of it is."""
    factor = max(1, -(-width // TILE_WIDTH), -(-height // TILE_HEIGHT))
    small_width, small_height = width // factor, height // factor
    small = []
    for y in range(small_height):
        for x in range(small_width):
            block = [
                pixels[(y * factor + j) * width + x * factor + i]
                for j in range(factor)
                for i in range(factor)
            ]
            small.append(OCCUPIED if OCCUPIED in block else FREE if FREE in block else UNKNOWN)
    return small_width, small_height, small


def png(width: int, height: int, pixels: bytearray) -> bytes:
    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = b"".join(b"\0" + bytes(pixels[y * width : (y + 1) * width]) for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(rows, 9))
        + chunk(b"IEND", b"")
    )


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    kinds = all_kinds(sys.argv[1])
    columns = 4
    width = columns * (TILE_WIDTH + MARGIN) + MARGIN
    height = 2 * -(-len(kinds) // columns) * (TILE_HEIGHT + MARGIN) + MARGIN
    canvas = bytearray([255]) * (width * height)
    with tempfile.TemporaryDirectory() as folder:
        for number, kind in enumerate(kinds):
            size = SIZES.get(kind, USUAL_SIZE)
            output = pathlib.Path(folder) / kind
            subprocess.run(
                [
                    sys.argv[1],
                    "simulate",
                    "--kind",
                    kind,
                    "--size",
                    size,
                    "--overlap",
                    "0.4",
                    "--seed",
                    "8",
                    "--others",
                    "0",
                    "-o",
                    output,
                    "--quiet",
                ],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            for below, name in enumerate(["building", "robot_1"]):
                tile_width, tile_height, tile = shrink(*read_pgm(output / f"{name}.pgm"))
                left = MARGIN + number % columns * (TILE_WIDTH + MARGIN) + (TILE_WIDTH - tile_width) // 2
                top = (
                    MARGIN
                    + (number // columns * 2 + below) * (TILE_HEIGHT + MARGIN)
                    + (TILE_HEIGHT - tile_height) // 2
                )
                for y in range(tile_height):
                    start = (top + y) * width + left
                    canvas[start : start + tile_width] = bytes(tile[y * tile_width : (y + 1) * tile_width])
    pathlib.Path(sys.argv[2]).write_bytes(png(width, height, canvas))


if __name__ == "__main__":
    main()
