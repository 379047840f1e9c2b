# SPDX-License-Identifier: Apache-2.0
"""GeoTIFFs, as GDAL and Pillow read them."""

from __future__ import annotations

from pathlib import Path

import gridmerge
import numpy as np
import rasterio
from PIL import Image
from rasterio.windows import Window


def test_gdal_reads_the_merged_map(robots: list[str], tmp_path: Path) -> None:
    result = gridmerge.merge(robots)
    file = tmp_path / "merged.tif"
    result.export("geotiff", file)
    merged = result.components[0].grid
    with rasterio.open(file) as picture:
        values = picture.read(1)
        assert picture.nodata == 255
        assert picture.profile["compress"] == "deflate"
        assert picture.tags()["TIFFTAG_SOFTWARE"] == "gridmerge"
        # A frame of its own, in metres.
        assert not picture.crs.is_geographic
        assert not picture.crs.is_epsg_code
        assert f"frame of the map {robots[0]}"[:40] in picture.crs.to_wkt()
        assert 'UNIT["metre",1' in picture.crs.to_wkt()
        # y is up in the map and down in the picture.
        assert picture.res == (merged.resolution, merged.resolution)
        left, bottom = picture.bounds.left, picture.bounds.bottom
        assert np.allclose([left, bottom], [merged.origin.x, merged.origin.y], atol=1e-9)
        column, row = 3, 5
        x = merged.origin.x + (column + 0.5) * merged.resolution
        y = merged.origin.y + (row + 0.5) * merged.resolution
        assert picture.index(x, y) == (merged.height - 1 - row, column)
        # The overviews are there, and a window is read alone.
        assert picture.overviews(1) == [2**i for i in range(1, len(picture.overviews(1)) + 1)]
        assert max(picture.shape) / 2 ** len(picture.overviews(1)) <= 512
        window = picture.read(1, window=Window(100, 50, 64, 32))
        assert (window == values[50:82, 100:164]).all()
    cells = merged.to_numpy(probabilities=False)[::-1]
    assert ((values == 255) == (cells == -1)).all()
    assert ((values > 50) & (values <= 100) == (cells == 100)).all()
    assert ((values < 50) == (cells == 0)).all()
    assert (np.array(Image.open(file)) == values).all()


def test_walls_stay_in_overviews(robots: list[str], tmp_path: Path) -> None:
    file = tmp_path / "merged.tif"
    gridmerge.merge(robots).export("geotiff", file)
    with rasterio.open(file) as whole, rasterio.open(file, overview_level=0) as half:
        values, halved = whole.read(1), half.read(1)
    rows, columns = np.nonzero((values > 50) & (values <= 100))
    assert (halved[rows // 2, columns // 2] > 50).all()
    assert (halved[rows // 2, columns // 2] <= 100).all()
