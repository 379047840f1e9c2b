#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""benchmark/peers.py treats every peer alike: it reads their answers as they are meant, all of them find a pose that is
known, and errors are those of `gridmerge evaluate`. usage: peers_test.py GRIDMERGE MRPT [CLASS],
in the project's folder"""

import importlib.util
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, "benchmark")
import numpy as np
import peer_cases
import peers
from peer_maps import (
    FREE,
    OCCUPIED,
    UNKNOWN,
    Answer,
    KnownCells,
    Map,
    coarsened,
    read_map,
    transformed,
    write_map,
)
from poses import compose, inverse

GRIDMERGE = pathlib.Path(sys.argv.pop(1))
MRPT = pathlib.Path(sys.argv.pop(1))
EXAMPLE = pathlib.Path("examples/three_robots")
ONE_DEGREE = math.radians(1.0)
HAS_OPENCV = importlib.util.find_spec("cv2") is not None


def moved(map_, pose):
    """The map as a robot has it whose frame lies at `pose` in the map's own: T_map_moved. Nearest cells."""
    height, width = map_.cells.shape
    corners = map_.points(np.array([[0, 0], [width, 0], [0, height], [width, height]]) - 0.5)
    there = transformed(inverse(pose), corners)
    low = np.floor(there.min(axis=0))
    columns, rows = np.ceil((there.max(axis=0) - low) / map_.resolution).astype(int)
    empty = Map(np.full((rows, columns), UNKNOWN, np.uint8), map_.resolution, (*low, 0.0))
    grid = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    here = transformed(inverse(map_.origin), transformed(pose, empty.points(grid))) / map_.resolution
    cells = np.floor(here).astype(int)
    inside = ((cells >= 0) & (cells < (width, height))).all(axis=1)
    values = np.full(len(grid), UNKNOWN, np.uint8)
    values[inside] = map_.cells[cells[inside, 1], cells[inside, 0]]
    return Map(values.reshape(rows, columns), map_.resolution, empty.origin)


class Reading(unittest.TestCase):
    def test_of_gridmerge(self):
        text = json.dumps(
            {
                "verdict": "accepted",
                "probability": 0.97,
                "hypotheses": [{}],
                "transform": {"x": 1.0, "y": -2.0, "theta": 0.5},
            }
        )
        self.assertEqual(peers.read_gridmerge(text), Answer((1.0, -2.0, 0.5), True, 0.97))
        refused = json.loads(text) | {"verdict": "refused"}
        self.assertEqual(peers.read_gridmerge(json.dumps(refused)), Answer((1.0, -2.0, 0.5), False, 0.97))
        self.assertIsNone(peers.read_gridmerge(json.dumps(refused | {"hypotheses": []})).pose)

    def test_of_mrpt_takes_the_mode_of_the_best_goodness(self):
        text = "[WARNING] few points\nmode 0 0.4 1 2 0.1\nmode -2 0.9 3 4 -0.2\n"
        self.assertEqual(peers.read_mrpt(text), Answer((3.0, 4.0, -0.2), True, 0.9))

    def test_of_mrpt_without_a_mode_is_a_refusal(self):
        self.assertEqual(peers.read_mrpt("\n[WARNING] no mode here\n"), Answer(None, False, 0.0))

    def test_of_a_program_that_fails_stops(self):
        with self.assertRaisesRegex(SystemExit, "ended with 3"):
            peers.run_measured(["sh", "-c", "exit 3"])
        self.assertEqual(peers.run_measured(["sh", "-c", "echo here; exit 3"], (0, 3))[0], "here\n")

    def test_counts_the_cpu_of_the_whole_process(self):
        _, seconds = peers.run_measured(
            [sys.executable, "-c", "import time\nwhile time.process_time() < 0.3: pass"]
        )
        self.assertGreaterEqual(seconds, 0.3)


class Judging(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_takes_the_error_that_evaluate_takes(self):
        turned = self.folder / "turned.yaml"  # an origin with a yaw
        write_map(turned, Map(read_map(EXAMPLE / "robot_2.yaml").cells, 0.05, (3.0, -7.0, 0.8)))
        truths = [(1.5, -2.25, 0.7), (-30.0, 4.0, -3.1), (0.0, 0.0, 0.0)]
        table = self.folder / "pairs.tsv"
        lines = [
            f"{(EXAMPLE / 'robot_1.yaml').resolve()}\t{turned}\t{x}\t{y}\t{theta}\t1"
            for x, y, theta in truths
        ]
        table.write_text("fixed\tmoving\tx\ty\ttheta\ttolerance\n" + "\n".join(lines) + "\n")
        result = self.folder / "result.json"
        subprocess.run(
            [GRIDMERGE, "evaluate", table, "--json", result, "--quiet"], check=True, stdout=subprocess.PIPE
        )
        answer, _ = peers.match_by_gridmerge(GRIDMERGE, EXAMPLE / "robot_1.yaml", turned)
        known = KnownCells(read_map(turned))
        for truth, case in zip(truths, json.loads(result.read_text())["cases"], strict=True):
            self.assertAlmostEqual(known.displacement(answer.pose, truth), case["error"], delta=1e-6)

    def test_counts_as_evaluate_does(self):
        cases = peer_cases.read_cases(EXAMPLE.resolve(), "example")
        judged = [peers.judge((peers.gridmerge_peer(GRIDMERGE), case)) for case in cases]
        row = peers.summarize("example", "gridmerge", judged)
        result = self.folder / "result.json"
        subprocess.run(
            [
                GRIDMERGE,
                "evaluate",
                EXAMPLE / "pairs.tsv",
                "--negatives",
                EXAMPLE / "negatives.tsv",
                "--json",
                result,
                "--quiet",
            ],
            check=True,
            stdout=subprocess.PIPE,
        )
        counts = json.loads(result.read_text())
        for name, key in (
            ("pairs", "total"),
            ("best right", "best_correct"),
            ("accepted right", "accepted_correct"),
            ("accepted wrong", "accepted_wrong"),
            ("refused", "refused"),
        ):
            self.assertEqual(row[name], counts["pairs"][key], name)
        self.assertEqual(
            row["unrelated accepted"], f"{counts['negatives']['accepted']} of {counts['negatives']['total']}"
        )

    def test_needs_a_pose_within_the_tolerance(self):
        case = peer_cases.Case("", pathlib.Path(), pathlib.Path(), (0.0, 0.0, 0.0), 0.5)

        def judged(error):
            return peers.Judged("", case, Answer((0.0, 0.0, 0.0), True, 1.0), 0.0, error)

        self.assertEqual([judged(error).right for error in (0.5, 0.51, None)], [True, False, False])

    def test_asks_in_both_orders_and_turns_the_second_answer_round(self):
        pose = (3.0, -1.0, 2.0)

        def match(fixed, moving):
            return (
                (Answer(None, False, 0.0), 1.0) if fixed == "a" else (Answer(inverse(pose), True, 0.9), 3.0)
            )

        answer, seconds = peers.in_both_orders(match, "a", "b")
        np.testing.assert_allclose(answer.pose, pose, atol=1e-12)
        self.assertTrue(answer.accepted)
        self.assertEqual(seconds, 2.0)

    def test_samples_evenly(self):
        self.assertEqual(peer_cases.sample(list(range(10)), 5), [0, 2, 4, 6, 8])
        self.assertEqual(peer_cases.sample(list(range(3)), 5), [0, 1, 2])

    def test_reads_the_three_kinds_of_cells(self):
        map_ = Map(
            np.array([[UNKNOWN, FREE], [OCCUPIED, OCCUPIED], [FREE, UNKNOWN]], np.uint8), 0.1, (1.0, 2.0, 0.3)
        )
        write_map(self.folder / "map.yaml", map_)
        again = read_map(self.folder / "map.yaml")
        np.testing.assert_array_equal(again.cells, map_.cells)
        self.assertEqual((again.resolution, again.origin), (map_.resolution, map_.origin))
        np.testing.assert_array_equal(coarsened(map_, 2).cells, [[OCCUPIED], [FREE]])


class Finding:
    """Every peer gives the known pose of a map that is laid on itself."""

    POSES = ((4.0, -2.5, 0.6), (-12.0, 7.25, 2.2), (1.0, 30.0, -1.3), (0.5, 0.5, -2.9))

    def check(self, match, poses, shift=0.1, turn=ONE_DEGREE):
        fixed = EXAMPLE / "robot_1.yaml"
        with tempfile.TemporaryDirectory() as folder:
            moving = pathlib.Path(folder, "moved.yaml")
            for pose in poses:
                write_map(moving, moved(read_map(fixed), pose))
                with self.subTest(pose=pose):
                    self.check_pose(match(fixed, moving)[0], pose, shift, turn, read_map(moving))

    def check_pose(self, answer, pose, shift, turn, moving):
        self.assertTrue(answer.accepted)
        self.assertLess(abs(math.remainder(answer.pose[2] - pose[2], 2 * math.pi)), turn)
        self.assertLess(KnownCells(moving).displacement(answer.pose, pose), shift)

    def check_turned_origin(self, match):
        map_ = read_map(EXAMPLE / "robot_1.yaml")
        with tempfile.TemporaryDirectory() as folder:
            moving = pathlib.Path(folder, "moving.yaml")
            origin = (-3.0, 5.0, 1.1)
            write_map(moving, Map(map_.cells, map_.resolution, origin))
            pose = compose(map_.origin, inverse(origin))
            self.check_pose(
                match(EXAMPLE / "robot_1.yaml", moving)[0], pose, 0.1, ONE_DEGREE, read_map(moving)
            )


class Gridmerge(Finding, unittest.TestCase):
    def test_finds_known_poses(self):
        self.check(lambda *maps: peers.match_by_gridmerge(GRIDMERGE, *maps), self.POSES)

    def test_minds_a_turned_origin(self):
        self.check_turned_origin(lambda *maps: peers.match_by_gridmerge(GRIDMERGE, *maps))


@unittest.skipUnless(HAS_OPENCV, "Python has no OpenCV")
class OpenCV(Finding, unittest.TestCase):
    def test_features_find_known_poses(self):
        self.check(lambda *maps: peers.match_by_features(1.0, *maps), self.POSES)

    def test_phase_correlation_finds_known_poses(self):
        self.check(lambda *maps: peers.match_by_phase(0.0, *maps), self.POSES)

    def test_both_mind_a_turned_origin(self):
        self.check_turned_origin(lambda *maps: peers.match_by_features(1.0, *maps))
        self.check_turned_origin(lambda *maps: peers.match_by_phase(0.0, *maps))

    def test_each_has_its_acceptance(self):
        maps = (EXAMPLE / "robot_1.yaml", EXAMPLE / "robot_2.yaml")
        for match in (peers.match_by_features, peers.match_by_phase):
            score = match(0.0, *maps)[0].score
            self.assertTrue(match(score, *maps)[0].accepted)
            self.assertFalse(match(math.nextafter(score, math.inf), *maps)[0].accepted)


@unittest.skipUnless(MRPT.is_file(), "the program of benchmark/mrpt is not built (./dev benchmark --peers)")
class Mrpt(Finding, unittest.TestCase):
    def test_finds_known_poses(self):
        self.check(lambda *maps: peers.match_by_mrpt(MRPT, *maps), self.POSES, 0.3, math.radians(2.0))


if __name__ == "__main__":
    unittest.main()
