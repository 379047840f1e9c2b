# SPDX-License-Identifier: Apache-2.0
"""Runs in a bare system with the wheel installed: merges the maps named, all but the last of which belong together."""

import sys

import gridmerge

*together, elsewhere = sys.argv[1:]
merged = gridmerge.merge([*together, elsewhere])
assert [len(one.members) for one in merged.components] == [len(together)], merged
assert [one.name for one in merged.left_out] == [elsewhere], merged.left_out
merged.save("/merged")

# The same map as a PNG and as a PGM.
picture, plain = gridmerge.load("png.yaml"), gridmerge.load("robot_2.yaml")
assert (picture.to_numpy() == plain.to_numpy()).all()
pair = gridmerge.match("robot_1.yaml", picture)
assert pair.accepted, pair
assert pair.transform == gridmerge.match("robot_1.yaml", plain).transform
print(sys.version, gridmerge.__version__)
