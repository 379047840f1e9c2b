# SPDX-License-Identifier: Apache-2.0
"""A ROS 2 node that merges the maps of robots while they map.

What needs no ROS is in modules of its own: `parameters`, `names`, `messages`, `robots` and `status`. `subscriptions`,
`publishers`, `node` and `main` are the rest, over rclpy.
"""
