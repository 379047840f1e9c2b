# SPDX-License-Identifier: Apache-2.0
"""Merges map files into one map, as far as they fit together.

python merge_maps.py robot_1.yaml robot_2.yaml robot_3.yaml -o merged
"""

import argparse

import gridmerge


def main() -> None:
    parser = argparse.ArgumentParser(description="Merges map files into one map.")
    parser.add_argument("maps", nargs="+", metavar="MAP", help="map_server YAML")
    parser.add_argument("-o", "--output", required=True, help="directory for the results")
    arguments = parser.parse_args()

    result = gridmerge.merge(arguments.maps)
    result.save(arguments.output)

    for component in result.components:
        print(
            f"one map of {len(component.members)} inputs, {component.grid.width} x {component.grid.height} cells"
        )
        for member in component.members:
            x, y, theta = member.transform
            print(f"  {member.name}: x {x:.2f} m, y {y:.2f} m, theta {theta:.3f} rad")
    for one in result.left_out:
        print(f"left out: {one.name}: {one.explanation}")


if __name__ == "__main__":
    main()
