"""The calibrated skeleton of docs/estimation.md, for many bodies at once."""

import json
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .arrays import Array
from .shared_constants import CORE, LIMB

PROPORTIONS_FILE = CORE / "body/body-proportions.json"


def load_proportions() -> dict[str, Any]:
    """The ratios the page uses."""
    return json.loads(PROPORTIONS_FILE.read_text())


@dataclass(frozen=True)
class Body:
    """What kinematics needs of the skeleton, each [..., 1] or [..., 3] over bodies [m]; arms and shoulders for the
    right side.
    """

    eye_height: Array
    arm: Array
    upper_arm: Array  # of the left and the right arm [..., 2]
    forearm: Array  # likewise; both make up the arm
    eyes_in_head: Array
    neck_to_head: Array
    thorax: Array  # chest to neck
    lower_back: Array  # hips to chest
    clavicle_root: Array  # from the neck's base
    shoulder: Array  # from the neck's base
    # Tilts of the left and the right hand (hand_tilt) [..., 2, 2], and whether each is applied [..., 2]; None: no
    # tilts.
    hand_tilts: Array | None = None
    hands_turned: NDArray[np.bool_] | None = None

    def with_forearms(self, lengths: Array, known: NDArray[np.bool_] | bool = True) -> "Body":
        """Returns the body with measured forearms [..., 2] [m] where known, weighted as on the page."""
        measured = np.clip(lengths, LIMB["forearmShare"]["min"] * self.arm, LIMB["forearmShare"]["max"] * self.arm)
        forearm = np.where(known, self.forearm + LIMB["forearmWeight"] * (measured - self.forearm), self.forearm)
        return replace(self, upper_arm=self.arm - forearm, forearm=forearm)

    def with_hands(self, tilts: Array) -> "Body":
        """Returns the body with these hand tilts [..., 2, 2]."""
        return replace(self, hand_tilts=tilts, hands_turned=np.ones(2, bool))


def body_from_calibration(eye_height: Array, arm_span: Array, proportions: dict[str, Any] | None = None) -> Body:
    """Bodies of eye heights and spans [m], arrays of one shape."""
    p = proportions or load_proportions()
    e = np.asarray(eye_height, np.float64)[..., None]
    span = np.asarray(arm_span, np.float64)[..., None]
    zero = np.zeros_like(e)
    arm = np.maximum((span - 2 * (p["clavicleRoot"] + p["clavicle"][0]) * e) / 2, LIMB["shortestArm"] * e)
    upper_arm = np.broadcast_to(p["upperArmShare"] * arm, (*arm.shape[:-1], 2))
    root = np.concatenate([p["clavicleRoot"] * e, zero, zero], -1)
    clavicle = np.concatenate([p["clavicle"][0] * e, p["clavicle"][1] * e, -p["clavicle"][2] * e], -1)
    return Body(
        eye_height=e,
        arm=arm,
        upper_arm=upper_arm,
        forearm=arm - upper_arm,
        eyes_in_head=np.concatenate([zero, p["eyesInHead"][0] * e, -p["eyesInHead"][1] * e], -1),
        neck_to_head=np.concatenate([zero, p["neckToHead"][0] * e, -p["neckToHead"][1] * e], -1),
        thorax=p["chestToNeck"] * e,
        lower_back=(p["hipsToSpine"] + p["spineToChest"]) * e,
        clavicle_root=root,
        shoulder=root + clavicle,
    )


def rest_offsets(body: Body) -> dict[str, list[float]]:
    """Every joint's offset from its parent and `eyesInHead` of one body, as `skeletonFromCalibration` must give them.
    """
    p = load_proportions()
    e = body.eye_height.item()

    def lean(v: Array, angle: float) -> list[float]:
        c, s = np.cos(angle), np.sin(angle)
        return [v[0], c * v[1] + s * v[2], c * v[2] - s * v[1]]

    lower, thorax = p["lowerBackTilt"], p["thoraxTilt"]
    half = lean(np.array([0.0, p["chestToNeck"] * e / 2, 0.0]), thorax)
    offsets = {
        "hips": [0.0, p["hipsHeight"] * e, 0.0],
        "spine": lean(np.array([0.0, p["hipsToSpine"] * e, 0.0]), lower),
        "chest": lean(np.array([0.0, p["spineToChest"] * e, 0.0]), lower),
        "upperChest": half,
        "neck": half,
        "head": lean(body.neck_to_head, thorax),
        "eyesInHead": body.eyes_in_head.tolist(),
    }
    for number, (side, sign) in enumerate((("left", -1.0), ("right", 1.0))):
        clavicle = lean(body.shoulder - body.clavicle_root, thorax)
        offsets |= {
            f"{side}Shoulder": [sign * p["clavicleRoot"] * e, half[1], half[2]],
            f"{side}UpperArm": [sign * clavicle[0], clavicle[1], clavicle[2]],
            f"{side}LowerArm": [sign * body.upper_arm[number], 0.0, 0.0],
            f"{side}Hand": [sign * body.forearm[number], 0.0, 0.0],
        }
    return {joint: [float(value) for value in offset] for joint, offset in offsets.items()}
