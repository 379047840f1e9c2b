# SPDX-License-Identifier: Apache-2.0
"""Runs ros_peers_test.py in an environment that has ROS 2; where there is none, says so and ends with 77 (skipped)."""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

SKIPPED = 77


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--environment", type=Path, required=True, help="a virtual environment that ./dev made"
    )
    options, arguments = parser.parse_known_args()
    messages = options.environment / "messages"
    if not (options.environment / "stamp").exists():
        print(f"skipped: there is no {options.environment}; './dev test --ros' makes it")
        return SKIPPED
    environment = dict(os.environ, PYTHONPATH=str(messages), LD_LIBRARY_PATH=str(messages))
    test = Path(__file__).with_name("ros_peers_test.py")
    python = options.environment / "bin" / "python"
    return subprocess.run([python, "-W", "ignore", test, *arguments], env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
