"""One generated person as other programs would write them: ASF/AMC, BVH with bones lost as cmuconvert loses them, BVH
folded along an axis.
"""

from pathlib import Path

import numpy as np

from . import quaternion
from .arrays import Array

IDENTITY = np.array([0.0, 0.0, 0.0, 1.0])

# ASF bones in units of 1/0.45 inch, facing +Z with the left on +X: name, parent, from start to end in rest, degrees of
# freedom.
_TRUNK = [
    ("lowerback", "root", (0.0, 2.0, -0.15)), ("upperback", "lowerback", (0.0, 2.0, 0.0)), ("thorax", "upperback", (0.0, 2.0, 0.12)),
    ("lowerneck", "thorax", (0.0, 1.7, 0.1)), ("upperneck", "lowerneck", (0.0, 1.7, -0.1)), ("head", "upperneck", (0.0, 1.7, 0.0)),
]  # fmt: skip
_SIDE = [
    ("hipjoint", "root", (1.7, -1.8, 0.6)), ("femur", "hipjoint", (2.5, -7.0, 0.0)), ("tibia", "femur", (2.5, -7.0, 0.0)),
    ("foot", "tibia", (0.2, -0.5, 2.1)), ("toes", "foot", (0.0, 0.0, 1.1)),
    ("clavicle", "thorax", (3.3, 1.1, 0.0)), ("humerus", "clavicle", (5.0, 0.0, 0.0)), ("radius", "humerus", (3.4, 0.0, 0.0)),
    ("wrist", "radius", (1.7, 0.0, 0.0)), ("hand", "wrist", (0.7, 0.0, 0.0)), ("fingers", "hand", (0.6, 0.0, 0.0)), ("thumb", "wrist", (0.6, 0.0, 0.6)),
]  # fmt: skip


def _bones() -> list[tuple[str, str, Array]]:
    bones = [(name, parent, np.array(way)) for name, parent, way in _TRUNK]
    for side, sign in (("l", 1.0), ("r", -1.0)):
        own = {name for name, _, _ in _SIDE}
        bones += [
            (side + name, side + parent if parent in own else parent, np.array(way) * [sign, 1, 1])
            for name, parent, way in _SIDE
        ]
    return bones


BONES = _bones()
# Turned about all three axes in AMC; the others stay as they are.
MOVING = [
    "lowerback",
    "upperback",
    "thorax",
    "lowerneck",
    "head",
    "lhumerus",
    "rhumerus",
    "lradius",
    "rradius",
    "lwrist",
    "rwrist",
    "lhand",
    "rhand",
    "lfemur",
    "rtibia",
]

# cmuconvert's joints: name, ASF bone whose start and rotation it is (None: only rotation zero), parent, bone whose
# vector is its offset.
_CMUCONVERT = [
    ("Hips", "root", None, None),
    ("LHipJoint", "lhipjoint", "Hips", None), ("LeftUpLeg", "lfemur", "LHipJoint", "lhipjoint"), ("LeftLeg", "ltibia", "LeftUpLeg", "lfemur"),
    ("LeftFoot", "lfoot", "LeftLeg", "ltibia"), ("LeftToeBase", "ltoes", "LeftFoot", "lfoot"),
    ("RHipJoint", "rhipjoint", "Hips", None), ("RightUpLeg", "rfemur", "RHipJoint", "rhipjoint"), ("RightLeg", "rtibia", "RightUpLeg", "rfemur"),
    ("RightFoot", "rfoot", "RightLeg", "rtibia"), ("RightToeBase", "rtoes", "RightFoot", "rfoot"),
    ("LowerBack", "lowerback", "Hips", None), ("Spine", "upperback", "LowerBack", "lowerback"), ("Spine1", "thorax", "Spine", "upperback"),
    # The thorax's own vector is lost: what hangs from its end begins at its start.
    ("Neck", "lowerneck", "Spine1", None), ("Neck1", "upperneck", "Neck", "lowerneck"), ("Head", "head", "Neck1", "upperneck"),
    ("LeftShoulder", "lclavicle", "Spine1", None), ("LeftArm", "lhumerus", "LeftShoulder", "lclavicle"), ("LeftForeArm", "lradius", "LeftArm", "lhumerus"),
    # And so is the wrist's.
    ("LeftHand", "lwrist", "LeftForeArm", "lradius"), ("LeftFingerBase", "lhand", "LeftHand", None), ("LeftHandIndex1", "lfingers", "LeftFingerBase", "lhand"),
    ("LThumb", "lthumb", "LeftHand", None),
    ("RightShoulder", "rclavicle", "Spine1", None), ("RightArm", "rhumerus", "RightShoulder", "rclavicle"), ("RightForeArm", "rradius", "RightArm", "rhumerus"),
    ("RightHand", "rwrist", "RightForeArm", "rradius"), ("RightFingerBase", "rhand", "RightHand", None), ("RightHandIndex1", "rfingers", "RightFingerBase", "rhand"),
    ("RThumb", "rthumb", "RightHand", None),
]  # fmt: skip


def angles_of(seed: int, frames: int) -> dict[str, Array]:
    """AMC angles [frames, 3] of the moving bones [degrees] about x, y, z, slow enough for a person."""
    random = np.random.default_rng(seed)
    times = np.arange(frames)[:, None] / 120
    return {
        bone: 20 * np.sin(2 * np.pi * random.uniform(0.1, 0.5, 3) * times + random.uniform(0, 6, 3)) for bone in MOVING
    }


def write_asf_amc(folder: Path, angles: dict[str, Array]) -> None:
    """p.asf and p_01.amc."""
    blocks = []
    for name, _, way in BONES:
        length = float(np.linalg.norm(way))
        direction = " ".join(f"{value:.12f}" for value in way / length)
        dof = "dof rx ry rz\n" if name in MOVING else ""
        blocks.append(f"begin\nname {name}\ndirection {direction}\nlength {length:.12f}\naxis 0 0 0 XYZ\n{dof}end\n")
    below = [f"{parent} {name}\n" for name, parent, _ in BONES]
    (folder / "p.asf").write_text(
        ":version 1.10\n:units\nangle deg\n:root\norder TX TY TZ RX RY RZ\naxis XYZ\nposition 0 0 0\norientation 0 0 0\n"
        f":bonedata\n{''.join(blocks)}:hierarchy\nbegin\n{''.join(below)}end\n"
    )
    frames = len(next(iter(angles.values())))
    rows = []
    for frame in range(frames):
        turns = "".join(f"{bone} {' '.join(f'{value:.9f}' for value in angles[bone][frame])}\n" for bone in MOVING)
        rows.append(f"{frame + 1}\nroot 0 16.5 0 0 0 0\n{turns}")
    (folder / "p_01.amc").write_text(":FULLY-SPECIFIED\n:DEGREES\n" + "".join(rows))


def write_cmuconvert_bvh(path: Path, angles: dict[str, Array]) -> None:
    """Writes the motion in cmuconvert's format, without the bone lengths that it loses."""
    ways = {name: way for name, _, way in BONES}
    joints = [(name, parent, np.zeros(3) if way is None else ways[way]) for name, _, parent, way in _CMUCONVERT]
    rows = []
    bone_of = {name: bone for name, bone, _, _ in _CMUCONVERT}
    for frame in range(len(next(iter(angles.values())))):
        # Rz·Ry·Rx in both formats.
        turns = [
            angles[bone_of[name]][frame][::-1] if bone_of[name] in angles else np.zeros(3) for name, _, _ in joints
        ]
        rows.append(np.concatenate([[0.0, 16.5, 0.0], *turns]))
    path.write_text(bvh_text(joints, rows, 1 / 120))


def bvh_text(joints: list[tuple[str, str | None, Array]], rows: list[Array], frame_time: float) -> str:
    """A BVH of joints (name, parent, offset), parents before children in depth-first order, with Z, Y, X rotation
    channels.
    """

    def block(name: str) -> str:
        _, parent, offset = next(joint for joint in joints if joint[0] == name)
        below = (
            "".join(block(child) for child, above, _ in joints if above == name) or "End Site\n{\nOFFSET 0.3 0 0\n}\n"
        )
        channels = (
            "3 Zrotation Yrotation Xrotation"
            if parent
            else "6 Xposition Yposition Zposition Zrotation Yrotation Xrotation"
        )
        at = " ".join(f"{value:.9f}" for value in offset)
        return f"{'JOINT' if parent else 'ROOT'} {name}\n{{\nOFFSET {at}\nCHANNELS {channels}\n{below}}}\n"

    lines = "\n".join(" ".join(f"{value:.9f}" for value in row) for row in rows)
    return f"HIERARCHY\n{block(joints[0][0])}MOTION\nFrames: {len(rows)}\nFrame Time: {frame_time:.9f}\n{lines}\n"


# A person in centimetres in T-pose, facing +Z: name, parent, offset.
GAME = [
    ("Hips", None, (0, 0, 0)), ("LeftUpLeg", "Hips", (9, -4, 0)), ("LeftLeg", "LeftUpLeg", (0, -43, 0)), ("LeftFoot", "LeftLeg", (0, -42, 0)),
    ("LeftToe", "LeftFoot", (0, -6, 14)), ("RightUpLeg", "Hips", (-9, -4, 0)), ("RightLeg", "RightUpLeg", (0, -43, 0)),
    ("RightFoot", "RightLeg", (0, -42, 0)), ("RightToe", "RightFoot", (0, -6, 14)), ("Spine", "Hips", (0, 11, 0)), ("Spine1", "Spine", (0, 12, 0)),
    ("Neck", "Spine1", (0, 24, 0)), ("Head", "Neck", (0, 12, 0)), ("LeftShoulder", "Spine1", (6, 20, 0)), ("LeftArm", "LeftShoulder", (11, 0, 0)),
    ("LeftForeArm", "LeftArm", (28, 0, 0)), ("LeftHand", "LeftForeArm", (26, 0, 0)), ("RightShoulder", "Spine1", (-6, 20, 0)),
    ("RightArm", "RightShoulder", (-11, 0, 0)), ("RightForeArm", "RightArm", (-28, 0, 0)), ("RightHand", "RightForeArm", (-26, 0, 0)),
]  # fmt: skip


def zyx_degrees(q: Array) -> Array:
    """The angles [degrees] about z, y, x of R = Rz·Ry·Rx."""
    x, y, z = (quaternion.rotate(q, axis) for axis in np.eye(3))
    return np.degrees([np.arctan2(x[1], x[0]), -np.arcsin(np.clip(x[2], -1, 1)), np.arctan2(y[2], z[2])])


def along(axis: Array) -> dict[str, Array]:
    """For each joint of GAME the rotation in T-pose of a skeleton whose bones all lie along this axis when nothing is
    turned.
    """
    rest = {}
    for name, _, offset in GAME:
        below = [np.array(way, float) for _, parent, way in GAME if parent == name]
        # The trunk goes on upwards; leaves go on as they came.
        way = max(below, key=lambda v: v[1]) if below else np.array(offset, float)
        rest[name] = quaternion.rotation_between(axis, way / np.linalg.norm(way))
    return rest


def game_bvh(
    rest: dict[str, Array], turns: list[dict[str, Array]], hips: list[Array]
) -> tuple[str, dict[str, list[float]]]:
    """
    A BVH whose joints are turned by `rest` when the person is in T-pose; its frames turn the joints of the T-pose by
    global rotations `turns` (others as their parents). Also returns the angles of the T-pose, as a skeleton map's
    restPose wants them.
    """
    parent_of = {name: parent for name, parent, _ in GAME}
    joints = []
    for name, parent, offset in GAME:
        above = rest[parent] if parent else IDENTITY
        joints.append((name, parent, quaternion.rotate(quaternion.conjugate(above), np.array(offset, float))))

    def local(turned: dict[str, Array], name: str) -> Array:
        def world(joint: str | None) -> Array:
            if joint is None:
                return IDENTITY
            own = joint
            while own not in turned and parent_of[own] is not None:
                own = parent_of[own]
            return quaternion.multiply(turned.get(own, IDENTITY), rest[joint])

        return quaternion.multiply(quaternion.conjugate(world(parent_of[name])), world(name))

    rows = [
        np.concatenate([at, *(zyx_degrees(local(turned, name)) for name, _, _ in GAME)])
        for turned, at in zip(turns, hips, strict=True)
    ]
    return bvh_text(joints, rows, 1 / 60), {name: zyx_degrees(local({}, name)).tolist() for name, _, _ in GAME}
