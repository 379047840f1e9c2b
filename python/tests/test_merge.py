# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import copy
import dataclasses
import json
import os
import pickle
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest
from conftest import Cli, merge_as_json, to_bits


def assert_equals_the_command_lines(
    result: gridmerge.MergeResult, cli: Cli, folder: Path, *arguments: object
) -> None:
    answer = cli("merge", *arguments, "-o", folder / "cli")
    assert answer.returncode == (0 if result.complete else 3), answer.stderr
    result.save(folder / "python")
    names = sorted(path.name for path in (folder / "cli").iterdir())
    assert names == sorted(path.name for path in (folder / "python").iterdir())
    for name in names:
        assert (folder / "cli" / name).read_bytes() == (folder / "python" / name).read_bytes(), name
    transforms = json.loads((folder / "cli" / "transforms.json").read_text())
    for join in transforms["joins"]:
        assert join["verdict"] == "accepted" or "sd" not in join
        assert join.pop("sd", 1.0) > 0.0
    assert to_bits(merge_as_json(result)) == to_bits(transforms)


def test_a_way_that_is_not_sure_enough_stays_open(robots: list[str]) -> None:
    sure = gridmerge.merge(robots[:2])
    asked_for_more = gridmerge.merge(robots[:2], accept=1.0)
    assert sure.open_ways == ()
    assert not asked_for_more.components
    way = asked_for_more.open_ways[0]
    assert (way.fixed, way.moving) == (0, 1)
    assert tuple(way.transform) == pytest.approx(tuple(sure.joins[0].match.transform))
    assert way.probability == pytest.approx(sure.joins[0].probability)


def test_files_and_results_equal_the_command_lines(
    cli: Cli, robots: list[str], elsewhere: str, tmp_path: Path
) -> None:
    maps = [*robots, elsewhere]
    result = gridmerge.merge(maps)
    assert_equals_the_command_lines(result, cli, tmp_path, *maps)
    assert [one.name for one in result.left_out] == [elsewhere]
    assert len(result.components[0].members) == 3
    assert gridmerge.load(tmp_path / "cli" / "merged.yaml").to_numpy().tobytes() == (
        result.components[0].grid.to_numpy().tobytes()
    )


@pytest.mark.parametrize(
    ("options", "arguments"),
    [
        ({"strategy": "tree"}, ["--strategy", "tree"]),
        ({"output_resolution": 0.1}, ["--output-resolution", "0.1"]),
        ({"accept": 0.999, "threads": 1}, ["--accept", "0.999"]),
    ],
)
def test_so_do_those_with_options(
    cli: Cli, team_folder: Path, tmp_path: Path, options: dict[str, Any], arguments: list[str]
) -> None:
    maps = [str(team_folder / f"robot_{i}.yaml") for i in (1, 2, 3)]
    assert_equals_the_command_lines(gridmerge.merge(maps, **options), cli, tmp_path, *maps, *arguments)


def test_known_poses_as_a_table_and_as_a_mapping(cli: Cli, robots: list[str], tmp_path: Path) -> None:
    first = gridmerge.Transform(10.0, 5.0, 0.5)
    x, y, theta = third = first @ gridmerge.merge(robots).components[0].members[2].transform
    table = tmp_path / "poses.tsv"
    table.write_text(
        f"map\tx\ty\ttheta\tsd\n{robots[0]}\t10\t5\t0.5\t0.1\n{robots[2]}\t{x}\t{y}\t{theta}\t0.5\n"
    )
    of_table = gridmerge.merge(robots, init=table, fix=robots[0])
    poses: dict[int | str, gridmerge.InitialPose] = {
        0: gridmerge.InitialPose((10, 5, 0.5), sd=0.1),
        robots[2]: gridmerge.InitialPose(third, sd=0.5),
    }
    of_mapping = gridmerge.merge(robots, init=poses, fix=[0])
    assert to_bits(merge_as_json(of_table)) == to_bits(merge_as_json(of_mapping))
    assert of_table.components[0].in_world_frame
    assert of_table.components[0].members[0].transform == first
    with pytest.raises(gridmerge.FileError, match="is an input and would be replaced"):
        of_table.export("g2o", table)
    assert_equals_the_command_lines(of_table, cli, tmp_path, *robots, "--init", table, "--fix", robots[0])
    with pytest.raises(ValueError, match="none of the maps"):
        gridmerge.merge(robots[:2], init=table)


def test_a_table_names_files_whatever_the_maps_are_called(
    robots: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    table = tmp_path / "poses.tsv"
    table.write_text(f"map\tx\ty\ttheta\n{robots[0]}\t10\t5\t0.5\n")
    # A file that has the name of another map.
    (tmp_path / "b").symlink_to(robots[0])
    monkeypatch.chdir(tmp_path)
    grids = [gridmerge.load(path) for path in robots[:2]]
    for maps in (robots[:2], grids):
        named = gridmerge.merge(maps, names=["a", "b"], init=table, fix="a")
        assert named.components[0].members[0].transform == gridmerge.Transform(10.0, 5.0, 0.5)
        assert (
            gridmerge.merge(maps, names=["a", "b"], init=table, fix=robots[0]).components == named.components
        )
    keys: list[Any] = [0, "a", robots[0], Path(robots[0])]
    for key in keys:
        of_mapping = gridmerge.merge(grids, names=["a", "b"], init={key: (10, 5, 0.5)}, fix=[key])
        assert of_mapping.components == named.components


def test_maps_that_are_no_files_are_named_in_tables_too(robots: list[str], tmp_path: Path) -> None:
    grids = []
    for path in robots[:2]:
        grid = gridmerge.load(path)
        grids.append(gridmerge.OccupancyGrid(grid.to_numpy(), grid.resolution, grid.origin))
    table = tmp_path / "poses.tsv"
    table.write_text("map\tx\ty\ttheta\nb\t10\t5\t0.5\n")
    named = gridmerge.merge(grids, names=["a", "b"], init=table, fix="b")
    assert named.components[0].members[1].transform == gridmerge.Transform(10.0, 5.0, 0.5)


def test_maps_are_found_from_another_directory(
    robots: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(Path(robots[0]).parent)
    grids = [gridmerge.load(Path(path).name) for path in robots[:2]]
    monkeypatch.chdir(tmp_path)
    assert gridmerge.merge(grids, fix=robots[1]).components[0].in_world_frame
    with pytest.raises(ValueError, match=r"^fix: "):
        gridmerge.merge(grids, fix=robots[2])


def test_fixed_maps_are_told_as_any_others_are(robots: list[str]) -> None:
    poses = {0: (0.0, 0.0, 0.0), 1: (30.0, 0.0, 0.0)}
    expected = gridmerge.merge(robots[:2], init=poses, fix=[0, 1]).components
    of_numpy = np.arange(2)
    ways: list[Any] = [
        of_numpy,
        set(of_numpy),
        {0, 1},
        iter(robots[:2]),
        tuple(map(Path, robots[:2])),
        range(2),
    ]
    for way in ways:
        assert gridmerge.merge(robots[:2], init=poses, fix=way).components == expected
    alone = gridmerge.merge(robots[:2], fix=1).components
    ones: list[Any] = [np.int64(1), np.array(1), Path(robots[1]), robots[1], np.uint8(1)]
    for one in ones:
        assert gridmerge.merge(robots[:2], fix=one).components == alone


def test_a_map_may_be_called_as_the_metadata_of_a_bag(robots: list[str], tmp_path: Path) -> None:
    odd = tmp_path / "metadata.yaml"
    gridmerge.save(gridmerge.load(robots[0]), odd)
    maps: list[str | Path] = [odd, robots[1]]
    plain = gridmerge.merge(maps, fix=os.path.join(tmp_path, ".", "metadata.yaml"))
    assert len(plain.components) == 1
    with ThreadPoolExecutor(1) as executor:
        apart = gridmerge.merge(maps, executor=executor)
    assert apart.components == gridmerge.merge(maps).components


def test_explanations_heed_what_was_accepted_from(robots: list[str]) -> None:
    maps, accept = [robots[0], robots[2]], 0.99999
    expected = "the maps show one place, but not as surely as is asked for"
    assert gridmerge.match(*maps, accept=accept).explanation == expected
    merged = gridmerge.merge(maps, accept=accept)
    assert merged.joins[0].match.explanation == expected
    assert pickle.loads(pickle.dumps(merged)).joins == merged.joins
    merger = gridmerge.Merger(accept=accept)
    team = gridmerge.Team(accept=accept, quiet=0.1)
    for path in maps:
        merger.add(path)
        team.hear(path, path)
    assert merger.solve().joins[0].match.explanation == expected
    assert team.wait_until_settled(600.0)
    assert team.merge_result().joins[0].match.explanation == expected


def test_a_result_can_be_copied_deeply(robots: list[str]) -> None:
    result = gridmerge.merge(robots[:2])
    assert copy.deepcopy(result) == result
    fields = dataclasses.asdict(result)
    assert fields["names"] == result.names
    assert fields["maps"][0] is result.maps[0]  # which nobody can change


def test_poses_are_compared_whatever_they_were_given_as() -> None:
    assert gridmerge.InitialPose(np.eye(3)) == gridmerge.InitialPose((0, 0, 0))
    assert gridmerge.InitialPose(np.eye(3)) != gridmerge.InitialPose((1, 0, 0))


def test_names_of_maps(robots: list[str]) -> None:
    grids = [gridmerge.load(path) for path in robots]
    assert gridmerge.merge(grids).names == tuple(robots)
    named = gridmerge.merge(grids, names=["a", "b", "c"])
    assert [one.name for one in named.components[0].members] == ["a", "b", "c"]
    bare = gridmerge.OccupancyGrid(np.zeros((3, 3), dtype=np.int8), 0.05)
    assert gridmerge.merge([bare, bare]).names == ("map 0", "map 1")


@pytest.mark.parametrize("format", ["g2o", "open-rmf", "geojson", "geotiff"])
def test_exports_equal_the_command_lines(
    cli: Cli, robots: list[str], elsewhere: str, tmp_path: Path, format: gridmerge.ExportFormat
) -> None:
    maps = [*robots, elsewhere]
    answer = cli("merge", *maps, "-o", tmp_path, "--export", f"{format}={tmp_path / 'cli'}")
    assert answer.returncode == 3, answer.stderr
    gridmerge.merge(maps).export(format, tmp_path / "python")
    assert (tmp_path / "cli").read_bytes() == (tmp_path / "python").read_bytes()


def test_exports_that_cannot_be(robots: list[str], elsewhere: str, tmp_path: Path) -> None:
    result = gridmerge.merge(robots[:2])
    with pytest.raises(ValueError, match="format: must be one of g2o, open-rmf, geojson, geotiff, is 'kml'"):
        result.export("kml", tmp_path / "x")  # type: ignore[arg-type]
    with pytest.raises(gridmerge.FileError, match="No such file or directory"):
        result.export("g2o", tmp_path / "no" / "x")
    with pytest.raises(gridmerge.FileError, match="is an input and would be replaced"):
        result.export("g2o", robots[0])
    with pytest.raises(gridmerge.FileError, match="is not written: no two maps were joined"):
        gridmerge.merge([robots[0], elsewhere]).export("g2o", tmp_path / "x")
    assert list(tmp_path.iterdir()) == []


def test_inputs_are_not_replaced(robots: list[str], tmp_path: Path) -> None:
    gridmerge.merge(robots[:2]).save(tmp_path)
    before = (tmp_path / "merged.pgm").read_bytes()
    result = gridmerge.merge([tmp_path / "merged.yaml", robots[2]])
    with pytest.raises(gridmerge.FileError, match="is an input and would be replaced"):
        result.save(tmp_path)
    assert (tmp_path / "merged.pgm").read_bytes() == before


@pytest.mark.parametrize("way", ["loaded", "pickled", "copied"])
def test_nor_are_they_from_another_directory(
    robots: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, way: str
) -> None:
    gridmerge.merge(robots[:2]).save(tmp_path)
    before = (tmp_path / "merged.pgm").read_bytes()
    table = tmp_path / "preview.png"
    table.write_text("map\tx\ty\ttheta\nmerged.yaml\t1\t2\t0\n")
    monkeypatch.chdir(tmp_path)
    grid = gridmerge.load("merged.yaml")
    if way == "pickled":
        grid = pickle.loads(pickle.dumps(grid))
    if way == "copied":
        grid = copy.copy(copy.deepcopy(grid))
    result = gridmerge.merge([grid, robots[2]])
    with_table = gridmerge.merge([robots[0], "merged.yaml"], init="preview.png")
    monkeypatch.chdir("/")
    with pytest.raises(gridmerge.FileError, match="is an input and would be replaced"):
        result.save(tmp_path)
    for name in ("merged.yaml", "merged.pgm"):
        (tmp_path / name).rename(tmp_path / f"moved{name}")
    with pytest.raises(gridmerge.FileError, match="preview.png"):
        with_table.save(tmp_path)
    assert (tmp_path / "movedmerged.pgm").read_bytes() == before


def test_nothing_and_a_single_map(robots: list[str], tmp_path: Path) -> None:
    assert gridmerge.merge([]).components == ()
    single = gridmerge.merge(robots[:1])
    assert not single.complete
    assert [one.map for one in single.left_out] == [0]
    assert single.left_out[0].explanation == "there is no other map to merge it with"
    blank = gridmerge.OccupancyGrid(np.full((9, 9), -1, dtype=np.int8), 0.05)
    with_blank = gridmerge.merge([*robots[:1], blank])
    assert with_blank.left_out[1].explanation == "there is too little in it, or in the others, to compare"
    single.save(tmp_path)
    assert not (tmp_path / "merged.yaml").exists()


def test_plots(robots: list[str], elsewhere: str) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    result = gridmerge.merge([*robots, elsewhere])
    axes = result.plot()
    assert axes.get_title() == "3 of 4 maps"
    legend = axes.get_legend()
    assert legend is not None and [text.get_text() for text in legend.get_texts()] == robots
    assert result.plot(axes) is axes
    left, right = axes.get_xlim()
    grid = result.components[0].grid
    assert left < grid.origin.x + 1.0 and right > grid.origin.x + grid.width * grid.resolution - 1.0
    axes.figure.canvas.draw()
    with pytest.raises(IndexError, match="component"):
        result.plot(component=1)
    assert gridmerge.merge([robots[0], elsewhere]).plot().get_title() == "no two maps fit together"
    gridmerge.load(robots[0]).plot().figure.canvas.draw()
    # Between two dollars a formula would stand.
    drawn = gridmerge.merge(robots[:2], names=["$x_$", "b"]).plot()
    drawn.figure.canvas.draw()


def test_a_plot_puts_maps_where_their_members_lie(robots: list[str]) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    result = gridmerge.merge(robots)
    axes = result.plot()
    drawn = [(image.get_transform() - axes.transData).transform((0.5, 0.25)) for image in axes.get_images()]
    for member in result.components[0].members:
        expected = member.transform.apply(result.maps[member.map].origin.apply([0.5, 0.25]))
        assert sum(np.allclose(point, expected, atol=1e-9) for point in drawn) == 2  # free space and walls


def test_a_plot_puts_walls_where_they_are() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib.transforms import Affine2DBase

    data = np.full((10, 20), -1, dtype=np.int8)
    data[2, 15] = 100
    grid = gridmerge.OccupancyGrid(data, 0.5, (1.0, 2.0, 0.6))
    axes = grid.plot()
    axes.figure.canvas.draw()
    walls = [image for image in axes.get_images() if np.asarray(image.get_array())[..., 3].any()]
    assert len(walls) == 1
    left, right, bottom, top = walls[0].get_extent()
    array = np.asarray(walls[0].get_array())
    row, column = np.argwhere(array[..., 3])[0]
    x = left + (column + 0.5) / array.shape[1] * (right - left)
    y = bottom + (row + 0.5) / array.shape[0] * (top - bottom)
    to_data = walls[0].get_transform() - axes.transData
    assert isinstance(to_data, Affine2DBase)
    expected = grid.origin.apply([15.5 * 0.5, 2.5 * 0.5])
    np.testing.assert_allclose(to_data.transform((x, y)), expected, atol=1e-9)


@pytest.mark.parametrize("share", [-0.1, 1.0, 1.5, float("nan"), float("inf")])
def test_a_share_of_missed_joins_that_makes_no_sense_is_refused(share: float, robots: list[str]) -> None:
    with pytest.raises(ValueError, match="max_missed"):
        gridmerge.merge(robots, max_missed=share)
    with pytest.raises(ValueError, match="max_missed"):
        gridmerge.Merger(max_missed=share)


def test_of_few_maps_the_share_of_missed_joins_changes_nothing(robots: list[str]) -> None:
    some, every = (gridmerge.merge(robots, max_missed=share) for share in (0.9, 0.0))
    assert len(some.joins) == 3
    assert to_bits(merge_as_json(some)["components"]) == to_bits(merge_as_json(every)["components"])
