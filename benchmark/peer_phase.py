# SPDX-License-Identifier: Apache-2.0
"""Log-polar phase correlation (Reddy & Chatterji 1996; "Fourier-Mellin") of two maps' walls.

The rotation follows from the maps' amplitude spectra, which do not feel a shift: in polar coordinates it is a shift
along the angle. The spectra are equal after half a turn, so that each angle stands for two rotations; the translation
follows by phase correlation for each of them, and the highest response wins. Both maps have one scale, so that a shift
along the logarithm of the radius is not looked for, which spares the method mistakes.
"""

import dataclasses
import math

import cv2
import numpy as np
from peer_maps import OCCUPIED, Answer, Map, common_resolution, transformed


@dataclasses.dataclass(frozen=True)
class Options:
    """Of three settings the one whose responses separated simulated training pairs (the seeds of peers.py's training
    set) best. The others had cells of 0.2 m, and blurs of 1 and of 1.5 cells."""

    cell: float = 0.1  # at which the maps are compared [m]; never finer than they are
    blur: float = 1.5  # standard deviation of a wall's blur [cells of that size]
    angles: int = 720  # over a whole turn
    candidates: int = 4  # angles tried, two rotations each


def walls_of(map_: Map, options: Options) -> tuple[np.ndarray, float, np.ndarray]:
    """The walls, blurred and cropped; the size of a pixel [m]; the pixel (column, row) of the map
    that is first here."""
    walls = (map_.cells == OCCUPIED).astype(np.float32)
    rows, columns = np.nonzero(walls)
    if not rows.size:
        return np.zeros((0, 0), np.float32), map_.resolution, np.zeros(2)
    first = np.array([columns.min(), rows.min()])
    walls = walls[first[1] : rows.max() + 1, first[0] : columns.max() + 1]
    factor = max(1, round(options.cell / map_.resolution))
    margin = math.ceil(3.0 * options.blur) * factor
    height, width = walls.shape
    walls = cv2.copyMakeBorder(
        walls, margin, margin + -height % factor, margin, margin + -width % factor, cv2.BORDER_CONSTANT
    )
    first = first - margin
    small = cv2.resize(walls, None, fx=1 / factor, fy=1 / factor, interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(np.minimum(small * factor, 1.0), None, options.blur)
    return small, map_.resolution * factor, first


def padded(image: np.ndarray, side: int) -> np.ndarray:
    canvas = np.zeros((side, side), np.float32)
    canvas[: image.shape[0], : image.shape[1]] = image
    return canvas


def log_polar_spectrum(image: np.ndarray, side: int, options: Options) -> np.ndarray:
    """Rows are angles of half a turn, columns logarithms of the radius."""
    spectrum = np.fft.fftshift(np.abs(np.fft.fft2(padded(image, side))))
    frequencies = np.fft.fftshift(np.fft.fftfreq(side))
    x = np.cos(np.pi * frequencies)
    high = 1.0 - np.outer(x, x)
    high_passed = (np.log1p(spectrum) * high * (2.0 - high)).astype(np.float32)
    polar = cv2.warpPolar(
        high_passed,
        (side // 2, options.angles),
        (side // 2, side // 2),
        side / 2,
        cv2.INTER_LINEAR | cv2.WARP_POLAR_LOG,
    )
    return polar[: options.angles // 2]


def likely_angles(fixed: np.ndarray, moving: np.ndarray, options: Options) -> list[float]:
    """Of the rotation of moving to fixed, in half a turn, the likeliest first; with parts of a step."""
    cross = np.fft.fft(fixed, axis=0) * np.conj(np.fft.fft(moving, axis=0))
    total = cross.sum(axis=1)
    correlation = np.real(np.fft.ifft(total / np.maximum(np.abs(total), 1e-12)))
    correlation = cv2.GaussianBlur(
        np.tile(correlation, 3)[:, None], None, 1.0, borderType=cv2.BORDER_REPLICATE
    ).ravel()
    correlation = correlation[correlation.size // 3 : 2 * correlation.size // 3]
    angles = []
    for peak in np.argsort(correlation)[::-1]:
        before, here, after = (correlation[(peak + step) % correlation.size] for step in (-1, 0, 1))
        if here < before or here < after:
            continue
        curve = before - 2.0 * here + after
        part = 0.5 * (before - after) / curve if curve < 0.0 else 0.0
        angles.append(2.0 * math.pi * (peak + part) / options.angles)
        if len(angles) == options.candidates:
            break
    return angles


def match(fixed: Map, moving: Map, least_response: float, options: Options = Options()) -> Answer:
    common_resolution(fixed, moving)
    (a, pixel, first_fixed), (b, _, first_moving) = (walls_of(map_, options) for map_ in (fixed, moving))
    if not a.size or not b.size:
        return Answer(None, False, 0.0)
    side = cv2.getOptimalDFTSize(max(*a.shape, *b.shape))
    side += side % 2
    spectra = [log_polar_spectrum(image, side, options) for image in (a, b)]
    diagonal = math.ceil(math.hypot(*b.shape))
    canvas = cv2.getOptimalDFTSize(max(a.shape) + diagonal)
    best, best_response, best_theta, best_shift = None, -1.0, 0.0, None
    large = padded(a, canvas)
    middle = (np.array(b.shape[::-1]) - 1.0) / 2.0
    target = np.full(2, (diagonal - 1.0) / 2.0)
    for angle in likely_angles(*spectra, options):
        for theta in (angle, angle + math.pi):
            c, s = math.cos(theta), math.sin(theta)
            turn = np.array([[c, -s], [s, c]])
            placed = np.column_stack([turn, target - turn @ middle])
            turned = cv2.warpAffine(b, placed, (diagonal, diagonal))
            shift, response = cv2.phaseCorrelate(padded(turned, canvas), large)
            if response > best_response:
                best_response, best_theta, best_shift = response, theta, np.array(shift)
                best = placed
    # The canvas is a ring: a shift stands for itself and for those that differ from it by a canvas.
    best_shift = np.where(best_shift < -diagonal, best_shift + canvas, best_shift)
    best_shift = np.where(best_shift >= max(a.shape), best_shift - canvas, best_shift)

    def metres(map_: Map, first: np.ndarray, pixels: np.ndarray) -> np.ndarray:
        factor = pixel / map_.resolution
        return map_.points(first + (pixels + 0.5) * factor - 0.5)

    landed = best[:, :2] @ middle + best[:, 2] + best_shift
    at_fixed = metres(fixed, first_fixed, landed[None])[0]
    at_moving = metres(moving, first_moving, middle[None])[0]
    theta = math.remainder(best_theta + fixed.origin[2] - moving.origin[2], 2.0 * math.pi)
    x, y = at_fixed - transformed((0.0, 0.0, theta), at_moving[None])[0]
    return Answer((float(x), float(y), theta), best_response >= least_response, best_response)
