# SPDX-License-Identifier: Apache-2.0
"""The package's files say what its code does."""

from __future__ import annotations

import ast
import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

from gridmerge_ros.parameters import PARAMETERS, Value, read_settings

PACKAGE = Path(__file__).parents[1]
ROOT = PACKAGE.parents[1]
# Packages of Python that ROS knows under other names, or that are none of ROS's.
OTHER_NAMES = {"numpy": "python3-numpy", "ament_index_python": "launch"}
NOT_OF_ROS = {"gridmerge", "gridmerge_ros"}


def written(default: Value) -> set[str]:
    """As YAML and the tables have it."""
    if isinstance(default, bool):
        return {str(default).lower()}
    if isinstance(default, tuple):
        return {"[]", '[""]'}
    if isinstance(default, str):
        return {default or "empty", f'"{default}"'}
    return {str(default)}


def test_the_file_of_parameters_has_all_with_their_defaults() -> None:
    text = (PACKAGE / "config" / "gridmerge.yaml").read_text(encoding="utf-8")
    found = dict(re.findall(r"^    (\w+): ([^#\n]*?) *(?:#.*)?$", text, re.MULTILINE))
    assert set(found) == {one.name for one in PARAMETERS}
    for one in PARAMETERS:
        assert found[one.name] in written(one.default), one.name


def test_the_guide_has_all_with_their_defaults() -> None:
    text = (ROOT / "docs" / "ros.md").read_text(encoding="utf-8")
    section = text.split("## Parameters")[1].split("\n## ")[0]
    found = dict(re.findall(r"^\| `(\w+)` \| `?([^|`]+?)`? \|", section, re.MULTILINE))
    assert set(found) == {one.name for one in PARAMETERS}
    for one in PARAMETERS:
        assert found[one.name] in written(one.default), one.name


def test_a_file_of_parameters_that_ros_read() -> None:
    # Where a list is empty ROS needs one of an empty text.
    assert read_settings({"robots": [""], "fixed_robots": [""]}) == read_settings({})


def imports_of(path: Path) -> set[str]:
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module.split(".")[0])
    return names


def test_what_is_imported_is_declared() -> None:
    declared = {one.text for one in ET.parse(PACKAGE / "package.xml").getroot().iter("exec_depend")}
    sources = [*(PACKAGE / "gridmerge_ros").glob("*.py"), *(PACKAGE / "launch").glob("*.py")]
    used = set().union(*(imports_of(path) for path in sources)) - set(sys.stdlib_module_names) - NOT_OF_ROS
    names = {OTHER_NAMES.get(name, name) for name in used}
    # rcl_interfaces comes with rclpy.
    assert names - {"rcl_interfaces"} <= declared
    assert declared <= names


def test_versions_are_one() -> None:
    version = ET.parse(PACKAGE / "package.xml").getroot().findtext("version")
    assert f'version="{version}"' in (PACKAGE / "setup.py").read_text(encoding="utf-8")
    assert f"project(gridmerge VERSION {version}" in (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")


def test_launch_files_name_files_that_are_there() -> None:
    for path in (PACKAGE / "launch").glob("*.launch.py"):
        text = path.read_text(encoding="utf-8")
        for folder, name in re.findall(r'"(config|rviz|launch)" / "([^"]+)"', text):
            assert (PACKAGE / folder / name).exists(), (path.name, folder, name)
    assert {path.name for path in (PACKAGE / "launch").glob("*.py")} == {
        "gridmerge.launch.py",
        "bag.launch.py",
        "two_slam_toolbox.launch.py",
    }
