#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""benchmark/speed/beside_peers.py: its ratios, the same pairs for all matchers, and what it does without OpenCV.
usage: beside_peers_test.py GRIDMERGE [CLASS], in the project's folder"""

import csv
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, "benchmark/speed")
import beside_peers

GRIDMERGE = pathlib.Path(sys.argv.pop(1))
HAS_OPENCV = importlib.util.find_spec("cv2") is not None


class Speed(unittest.TestCase):
    def run_script(self, *arguments, **environment):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.output = pathlib.Path(folder.name)
        command = [
            sys.executable,
            "benchmark/speed/beside_peers.py",
            "--gridmerge",
            GRIDMERGE,
            "--output",
            self.output,
            "--data",
            self.output / "none",
            *arguments,
        ]
        return subprocess.run(
            [str(word) for word in command],
            env=os.environ | environment,
            check=True,
            stdout=subprocess.PIPE,
            text=True,
        ).stdout

    def test_a_ratio_is_of_each_pair_and_not_of_the_sums(self):
        rows = [
            {"gridmerge": 1.0, "AKAZE": 2.0},
            {"gridmerge": 9.0, "AKAZE": 3.0},
            {"gridmerge": 2.0, "AKAZE": 2.0},
        ]
        self.assertEqual(beside_peers.ratio(rows, "AKAZE"), "1.00 (0.75 to 2.00)")
        self.assertEqual(beside_peers.ratio(rows[:1], "AKAZE"), "0.50 (0.50 to 0.50)")

    def test_without_opencv_it_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "cv2.py").write_text("raise ImportError('no OpenCV here')\n")
            text = self.run_script(PYTHONPATH=folder)
        self.assertRegex(text, r"skipped, .*python3-opencv.*: no OpenCV here\n$")
        self.assertEqual(list(self.output.iterdir()), [])

    @unittest.skipUnless(HAS_OPENCV, "Python has no OpenCV")
    def test_every_matcher_gets_the_same_pairs(self):
        text = self.run_script("--pairs", 1)
        self.assertRegex(text, r"No real maps at .*: measuring the bundled example")
        with (self.output / "peer_seconds.tsv").open(newline="") as file:
            rows = list(csv.DictReader(file, delimiter="\t"))
        self.assertEqual([row["maps"] for row in rows], ["example", "example, unrelated"])
        for row in rows:
            for name in (beside_peers.ENGINE, *beside_peers.PEERS):
                self.assertGreater(float(row[name]), 0.0)
        self.assertIn("\n| all | 2 | ", text)


if __name__ == "__main__":
    unittest.main()
