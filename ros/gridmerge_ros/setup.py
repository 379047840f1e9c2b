# SPDX-License-Identifier: Apache-2.0
from glob import glob

from setuptools import setup

PACKAGE = "gridmerge_ros"

setup(
    name=PACKAGE,
    version="0.1.0",
    description="A ROS 2 node that merges the occupancy grid maps of robots while they map",
    license="Apache-2.0",
    packages=[PACKAGE],
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/config", sorted(glob("config/*.yaml"))),
        (f"share/{PACKAGE}/launch", sorted(glob("launch/*.launch.py"))),
        (f"share/{PACKAGE}/rviz", sorted(glob("rviz/*.rviz"))),
    ],
    # The package `gridmerge` is no distribution of the workspace: docs/ros.md tells how to have it.
    install_requires=["setuptools"],
    zip_safe=True,
    entry_points={"console_scripts": [f"gridmerge_node = {PACKAGE}.main:main"]},
)
