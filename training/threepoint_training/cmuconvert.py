"""
Bones that cmuconvert lost when it made BVH files of the CMU database: the thorax, and the wrist bone of either arm.

Its skeletons have `LowerBack, Spine, Spine1, Neck, Neck1, Head` and `LeftForeArm, LeftHand, LeftFingerBase`, where neck
and shoulders lie on Spine1 and the finger base on the hand: the rotations of thorax and wrist are there, their lengths
are not. Head and shoulders are 11 cm too low, and "LeftHand" is where the radius ends in these skeletons, in
mid-forearm.
"""

import numpy as np
from numpy.typing import NDArray

from .bvh_hierarchy import BvhHierarchy
from .mocap_rules import RULES

_LOST = RULES["cmuconvert"]
# The thorax bone by those of lower and upper back, each axis by itself: least squares on the skeletons of 26 people of
# the database. With each person left out in turn its end is 0.4 cm off on average, 1.1 cm at most; the upper back's own
# bone once more would be 0.9 and 2.5 cm off.
_FROM_LOWER_BACK = np.array(_LOST["thoraxFromLowerBack"])
_FROM_UPPER_BACK = np.array(_LOST["thoraxFromUpperBack"])
# In every skeleton of the database the wrist bone is half as long as the radius, and lies along it in rest.
_WRIST_OF_RADIUS = float(_LOST["wristOfRadius"])

_HUNG_ON_THORAX = ("Neck", "LeftShoulder", "RightShoulder")
_TRUNK = ("LowerBack", "Spine", "Spine1", *_HUNG_ON_THORAX)


def _lost(offset: NDArray[np.float64], beside: NDArray[np.float64]) -> bool:
    return bool(np.linalg.norm(offset) < 0.01 * np.linalg.norm(beside))


def put_back_lost_bones(hierarchy: BvhHierarchy) -> tuple[str, ...]:
    """Gives a skeleton of cmuconvert its lost bones, in place; others stay as they are. Returns what was done, a
    sentence each.
    """
    notes = []
    if all(name in hierarchy.names for name in _TRUNK):
        lower, upper = hierarchy.offset("Spine"), hierarchy.offset("Spine1")
        if all(_lost(hierarchy.offset(name), upper) for name in _HUNG_ON_THORAX):
            thorax = _FROM_LOWER_BACK * lower + _FROM_UPPER_BACK * upper
            for name in _HUNG_ON_THORAX:
                hierarchy.place(name, thorax)
            notes.append(
                "cmuconvert lost the thorax bone; it is put back, estimated from the two below (0.4 cm off on average)"
            )
    for side in ("Left", "Right"):
        hand, base, thumb = f"{side}Hand", f"{side}FingerBase", f"{side[0]}Thumb"
        if (
            hand in hierarchy.names
            and base in hierarchy.names
            and _lost(hierarchy.offset(base), hierarchy.offset(hand))
        ):
            wrist = _WRIST_OF_RADIUS * hierarchy.offset(hand)
            hierarchy.place(base, wrist)
            if thumb in hierarchy.names and _lost(hierarchy.offset(thumb), hierarchy.offset(hand)):
                hierarchy.place(thumb, wrist)
            notes.append(f"cmuconvert lost the {side.lower()} wrist bone; it is put back, half as long as the radius")
    return tuple(notes)
