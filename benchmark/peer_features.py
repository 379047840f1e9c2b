# SPDX-License-Identifier: Apache-2.0
"""Feature matching as the ROS node multirobot_map_merge does it: AKAZE features of the grid's own values taken for an
image, OpenCV's AffineBestOf2NearestMatcher (matches of both directions, a similarity by RANSAC), and its acceptance.
"""

import cv2
import numpy as np
from peer_maps import FREE, OCCUPIED, UNKNOWN, Answer, Map, common_resolution, rigid_fit


def image_of(map_: Map) -> np.ndarray:
    """What nav_msgs/OccupancyGrid holds (free 0, occupied 100, unknown -1), each byte taken for a gray value."""
    grays = np.zeros(3, np.uint8)
    grays[UNKNOWN], grays[FREE], grays[OCCUPIED] = 255, 0, 100
    return grays[map_.cells]


def match(fixed: Map, moving: Map, least_confidence: float) -> Answer:
    """The confidence is inliers / (8 + 0.3 matches), Brown & Lowe (2007)."""
    common_resolution(fixed, moving)
    cv2.setRNGSeed(1)
    finder = cv2.AKAZE_create()
    features = [cv2.detail.computeImageFeatures2(finder, image_of(map_)) for map_ in (moving, fixed)]
    matcher = cv2.detail_AffineBestOf2NearestMatcher()
    found = matcher.apply(*features)
    pose = None
    # Where OpenCV has too few matches to fit anything, it tells no inliers at all.
    marked = zip(found.getMatches(), found.getInliers(), strict=False)
    inliers = [one for one, is_inlier in marked if is_inlier]
    if len(inliers) >= 2:
        # The node's bundle adjustment keeps the scale; the poses of maps have none.
        ends = [
            map_.points([keypoints[index].pt for index in indices])
            for map_, keypoints, indices in (
                (moving, features[0].getKeypoints(), [one.queryIdx for one in inliers]),
                (fixed, features[1].getKeypoints(), [one.trainIdx for one in inliers]),
            )
        ]
        pose = rigid_fit(*ends)
    accepted = pose is not None and found.confidence >= least_confidence
    return Answer(pose, accepted, found.confidence)
