# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
import warnings
from pathlib import Path

import gridmerge
import numpy as np
import pytest
from conftest import Cli


def write_map(folder: Path, yaml: str, name: str = "map.yaml") -> Path:
    (folder / "map.pgm").write_bytes(b"P5 2 2 255\n" + bytes([0, 254, 205, 0]))
    (folder / name).write_text(yaml)
    return folder / name


GOOD = "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
BAD = {
    "no origin": GOOD.replace("origin: [0, 0, 0]\n", ""),
    "resolution": GOOD.replace("0.05", "-1"),
    "no image": GOOD.replace("map.pgm", "none.pgm"),
    "no YAML": "\0\1\2",
    "empty": "",
}


@pytest.mark.parametrize("kind", BAD)
def test_files_that_are_no_maps_fail_as_in_the_command_line(tmp_path: Path, cli: Cli, kind: str) -> None:
    path = write_map(tmp_path, BAD[kind])
    with pytest.raises(gridmerge.FileError) as error:
        gridmerge.load(path)
    answer = cli("info", path)
    assert answer.returncode == 1
    assert answer.stderr == f"gridmerge: {error.value}\n"


def test_file_errors_are_os_errors_of_one_line(tmp_path: Path) -> None:
    with pytest.raises(OSError) as error:
        gridmerge.load(tmp_path / "no\nsuch.yaml")
    assert type(error.value) is gridmerge.FileError
    assert type(error.value).__module__ == "gridmerge"
    assert "\n" not in str(error.value)
    assert "no\\nsuch.yaml" in str(error.value)


def test_names_need_not_be_utf8(tmp_path: Path) -> None:
    name = os.fsdecode(b"odd\xff.yaml")
    with pytest.raises(gridmerge.FileError, match="odd\udcff.yaml"):
        gridmerge.load(tmp_path / name)
    path = write_map(tmp_path, GOOD, name)
    assert gridmerge.load(path).source == str(path)
    merged = gridmerge.merge([path, path])
    merged.save(tmp_path / "merged")
    assert (tmp_path / "merged" / "transforms.json").exists()


def test_warnings_are_kept_by_load_and_issued_by_others(tmp_path: Path) -> None:
    path = write_map(tmp_path, GOOD.replace("0.196", "0.25"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        grid = gridmerge.load(path)
    assert len(grid.warnings) == 1
    assert "205" in grid.warnings[0]
    with pytest.warns(gridmerge.MapWarning, match="205") as issued:
        gridmerge.match(path, grid)
    assert issued[0].filename == __file__
    with pytest.warns(gridmerge.MapWarning, match="205") as issued:
        gridmerge.merge([path])
    assert issued[0].filename == __file__


def test_images_alone_need_a_resolution(tmp_path: Path) -> None:
    write_map(tmp_path, GOOD)
    with pytest.raises(gridmerge.FileError, match="resolution"):
        gridmerge.load(tmp_path / "map.pgm")
    grid = gridmerge.load(tmp_path / "map.pgm", resolution=0.1)
    np.testing.assert_array_equal(grid.to_numpy(), [[-1, 100], [100, 0]])
    assert grid.resolution == 0.1


def test_saving_fails_clearly(tmp_path: Path) -> None:
    grid = gridmerge.OccupancyGrid(np.zeros((2, 2), dtype=np.int8), 0.05)
    with pytest.raises(gridmerge.FileError, match=r"must end in \.yaml"):
        gridmerge.save(grid, tmp_path / "map.png")
    with pytest.raises(gridmerge.FileError):
        gridmerge.save(grid, tmp_path / "missing" / "map.yaml")
    with pytest.raises(ValueError, match="probabilities"):
        gridmerge.save(grid, tmp_path / "map.yaml", probabilities=True)
    assert list(tmp_path.iterdir()) == []
