"""Golden vectors that hold Python and TypeScript together (tests/golden), made of generated motion only."""

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from . import estimate_hand_tilts, estimate_headset_rise, hand_tilt, quaternion, solve_ik
from .arrays import Array
from .chest_features import chest_axes
from .estimate_hand_tilts import CalibratedTilts
from .features import FEATURES, HEAD_AXES, HEADSET_HEIGHT, frame_features
from .generated_motion import generate_clip
from .golden_mocap import mocap_vectors
from .paper_features import paper_features
from .paper_orientations import DRAWN_JOINTS, paper_body
from .prepared_corpus import Person
from .residual import correction_share, network_input
from .shared_constants import REPOSITORY
from .simulate_trackers import TrackerConfig, draw_wearer, simulate
from .skeleton import Body, body_from_calibration, rest_offsets
from .window_features import FRAMES as WINDOW_FRAMES
from .window_features import window_features

GOLDEN = REPOSITORY / "tests/golden"


@dataclass(frozen=True)
class GoldenBody:
    """The measurements of a body [m], and the measured hand tilts; an unknown forearm is None."""

    eye_height: float
    arm_span: float
    forearm: float | None = None
    tilts: dict[str, tuple[float, float]] = field(default_factory=dict)

    def calibrated(self) -> CalibratedTilts:
        """The hand tilts of the calibration."""
        sides = ("left", "right")
        return CalibratedTilts(
            np.array([self.tilts.get(side, (0.0, 0.0)) for side in sides]),
            np.array([side in self.tilts for side in sides]),
        )

    def body(self) -> Body:
        """Hands as they come."""
        body = body_from_calibration(np.array(self.eye_height), np.array(self.arm_span))
        return body if self.forearm is None else body.with_forearms(np.full(2, self.forearm))

    def measures(self) -> dict[str, Any]:
        """The body measurements in the page's format, without tilts."""
        return {"eyeHeight": self.eye_height, "armSpan": self.arm_span} | (
            {} if self.forearm is None else {"forearm": self.forearm}
        )

    def calibration(self) -> dict[str, Any]:
        """The calibration in the page's format."""
        hands = {side: {"pitch": pitch, "yaw": yaw} for side, (pitch, yaw) in self.tilts.items()}
        return self.measures() | ({"handTilts": hands} if hands else {})


BODIES = (
    GoldenBody(1.62, 1.56),
    GoldenBody(1.15, 1.05, 0.18, {"left": (0.25, -0.1), "right": (-0.15, 0.3)}),
    # No such arm has so long a forearm.
    GoldenBody(2.02, 2.05, 0.9, {"right": (0.05, -0.4)}),
)
FRAMES = 14
STRIDE = 9
WINDOW = (0.0, 0.1, 0.25)


def _tracked(eye_height: float, arm_span: float, random: np.random.Generator) -> tuple[Array, Array]:
    """Some frames of a person of that size, as trackers see them."""
    joints, turns = generate_clip(random, FRAMES * STRIDE, Person("golden", eye_height, arm_span))
    trackers = TrackerConfig()
    positions, rotations = simulate(joints, turns, draw_wearer(trackers, random), trackers, random)
    return positions[::STRIDE], rotations[::STRIDE]


def _in_floor_frame(joints: Array, positions: Array, rotations: Array) -> Array:
    """Points [F, N, 3] of the heading frames of these trackers."""
    yaw, origin = quaternion.heading(rotations[:, 0]), positions[:, 0] * [1, 0, 1]
    return quaternion.rotate(np.broadcast_to(yaw[:, None], (*joints.shape[:-1], 4)), joints) + origin[:, None]


def feature_vectors() -> list[dict[str, Any]]:
    """Rotated and moved people in three sizes, one hand unseen now and then: what goes in and what must come out."""
    cases = []
    for number, person in enumerate(BODIES):
        random = np.random.default_rng([11, number])
        positions, rotations = _tracked(person.eye_height, person.arm_span, random)
        seen = random.uniform(size=(FRAMES, 2)) > 0.15
        times = np.arange(FRAMES) * STRIDE / 60 + random.uniform(0, 0.01, FRAMES)
        seconds = np.diff(times, prepend=times[:1])
        body = estimate_hand_tilts.with_estimated_hands(
            person.body(), positions, rotations, seconds, calibrated=person.calibrated(), seen=seen
        )
        vector, ik_joints = frame_features(positions, rotations, body, seen)
        floor_joints = _in_floor_frame(ik_joints, positions, rotations)
        paper_input = paper_features(*solve_ik.to_heading(positions, rotations)[:2])
        cases.append(
            {
                "calibration": person.calibration(),
                "restOffsets": rest_offsets(body),
                "window": WINDOW,
                "frames": [
                    {
                        "time": times[i],
                        "positions": positions[i],
                        "rotations": rotations[i],
                        "seen": seen[i],
                        "handTilts": body.hand_tilts[i],
                        "ikJoints": floor_joints[i],
                        "features": vector[i],
                        "paperInput": paper_input[i].ravel(),
                    }
                    for i in range(FRAMES)
                ],
                "inputs": network_input(vector, times, WINDOW),
            }
        )
    return cases


def headset_rise_vectors() -> dict[str, Any]:
    """Arms that hang, swing and are not seen now and then, and the headset rise estimated from them."""
    random = np.random.default_rng(31)
    arm, count = 0.61, 60
    reach = np.array([0.0, -1.0, 0.0]) * random.normal(1.02, 0.03, size=(count, 2, 1)) + random.normal(
        scale=0.15, size=(count, 2, 3)
    ) * [1, 0, 1]
    seconds, seen = random.uniform(0.5, 1.5, count), random.uniform(size=(count, 2)) > 0.15
    followed = estimate_headset_rise.hanging_reach(reach, seconds, seen=seen)
    rises = estimate_headset_rise.rise(followed, np.array(arm))
    names = ("seconds", "reach", "seen", "hangingReach", "rise")
    frames = [dict(zip(names, each, strict=True)) for each in zip(seconds, reach, seen, followed, rises, strict=True)]
    return {"arm": arm, "frames": frames}


def correction_share_vectors() -> list[dict[str, Any]]:
    """Heads at heights [eye heights] and in orientations of all kinds, and the share of the correction under them."""
    random = np.random.default_rng(37)
    count = 60
    heights, orientations = random.uniform(0.03, 1.3, count), random.normal(size=(count, 4))
    orientations /= np.linalg.norm(orientations, axis=1, keepdims=True)
    inputs = np.zeros((count, FEATURES))
    inputs[:, HEADSET_HEIGHT] = heights
    inputs[:, HEAD_AXES.start + 4] = quaternion.rotate(orientations, np.broadcast_to([0.0, 1.0, 0.0], (count, 3)))[:, 1]
    rows = zip(heights, orientations, correction_share(inputs), strict=True)
    return [dict(zip(("height", "orientation", "share"), row, strict=True)) for row in rows]


def _hands_before_the_trunk(positions: Array, ik_joints: Array, body: Body, random: np.random.Generator) -> Array:
    """Wrists close to the chest joint, so that elbows estimated beside IK's lie in the trunk now and then; heading
    frame.
    """
    moved = positions.copy()
    place = np.array([[-0.1, -0.05, -0.16], [0.1, -0.05, -0.16]]) + random.normal(
        scale=0.05, size=(len(positions), 2, 3)
    )
    moved[:, 1:] = ik_joints[:, 4:5] + place * body.eye_height
    return moved


def _hands_out_of_reach(positions: Array, ik_joints: Array, body: Body, random: np.random.Generator) -> Array:
    """Wrists at 0.99 to 1.25 arm lengths from IK's shoulders: straight arms and a leaning trunk. Both hands further
    away have no solution, and what the passes end with then amplifies the last digits of its input.
    """
    moved = positions.copy()
    reach = moved[:, 1:] - ik_joints[:, 2:4]
    reach *= (
        random.uniform(0.99, 1.25, (len(positions), 2, 1)) * body.arm / np.linalg.norm(reach, axis=-1, keepdims=True)
    )
    moved[:, 1:] = ik_joints[:, 2:4] + reach
    return moved


# Positions of the hands, and standard deviations of the corrections of elbows and of other joints [eye heights].
SITUATIONS: dict[str, tuple[Callable[[Array, Array, Body, np.random.Generator], Array], float, float]] = {
    "hands as tracked": (lambda positions, *_: positions, 0.015, 0.015),
    "hands before the trunk": (_hands_before_the_trunk, 0.2, 0.015),
    "hands out of reach": (_hands_out_of_reach, 0.05, 0.015),
    "shoulders far from their places": (lambda positions, *_: positions, 0.05, 0.05),
}


def fitted_vectors() -> list[dict[str, Any]]:
    """People in three sizes, joints estimated about where IK has them, where torso and arm fitting put those on the
    skeleton, and the body that section 3.5 of the paper makes of them.

    `limited` says of each elbow whether the swivel limiter keeps it out of the trunk.
    """
    import torch

    from .differentiable_kinematics import DifferentiableKinematics, as_the_page_fits

    fitting = DifferentiableKinematics(torch.float64)
    cases = []
    for number, person in enumerate(BODIES):
        body = person.body()
        frames = []
        for kind, (situation, (move, elbows, others)) in enumerate(SITUATIONS.items()):
            random = np.random.default_rng([13, number, kind])
            positions, rotations = _tracked(person.eye_height, person.arm_span, random)
            local, turns, _, _ = solve_ik.to_heading(positions, rotations)
            positions = _in_floor_frame(
                move(local, solve_ik.solve(local, turns, body), body, random), positions, rotations
            )
            vector, ik_joints = frame_features(positions, rotations, body)
            inputs = torch.from_numpy(network_input(vector, np.arange(FRAMES) / 60, WINDOW))
            corrections = random.normal(size=ik_joints.shape) * np.array([elbows] * 2 + [others] * 4)[:, None]
            fitted, limited = fitting.fit(torch.from_numpy(corrections), inputs, as_the_page_fits(person.eye_height))
            axes = chest_axes(vector)
            estimated, placed = (
                _in_floor_frame(ik_joints + person.eye_height * shift @ axes, positions, rotations)
                for shift in (corrections, fitted.numpy())
            )
            published = paper_body(estimated, positions, rotations, body)
            frames += [
                {
                    "situation": situation,
                    "positions": positions[i],
                    "rotations": rotations[i],
                    "estimated": estimated[i],
                    "fitted": placed[i],
                    "limited": limited[i].numpy(),
                    "published": dict(zip(DRAWN_JOINTS, published[i], strict=True)),
                }
                for i in range(FRAMES)
            ]
        cases.append({"calibration": person.measures(), "frames": frames})
    return cases


def model_vectors(models: Path) -> dict[str, Any]:
    """Inputs of generated motion and onnxruntime's outputs for the models in that folder."""
    import onnxruntime

    result: dict[str, Any] = {}
    random = np.random.default_rng(12)
    person = Person("golden", 1.6, 1.55)
    joints, turns = generate_clip(random, 240, person)
    trackers = TrackerConfig()
    positions, rotations = simulate(joints, turns, draw_wearer(trackers, random), trackers, random)
    body = body_from_calibration(np.array(person.eye_height), np.array(person.arm_span)).with_hands(hand_tilt.usual())
    vector, _ = frame_features(positions, rotations, body)
    for contract_file in sorted(models.glob("*.json")):
        contract = json.loads(contract_file.read_text())
        session = onnxruntime.InferenceSession(models / contract["file"])
        if contract["name"] == "paper":
            inputs = paper_features(*solve_ik.to_heading(positions, rotations)[:2])
        else:
            inputs = network_input(vector, np.arange(len(vector)) / 60, tuple(contract["windowSeconds"]))
        inputs = inputs[::12].astype(np.float32)
        name = contract["inputs"][0]["name"]
        outputs = [session.run(None, {name: row[None]})[0][0] for row in inputs]
        result[contract["name"]] = {
            "sha256": contract["sha256"],
            "tolerance": contract["quantisation"]["runtimeTolerance"],
            "cases": [{"input": row.ravel(), "output": output} for row, output in zip(inputs, outputs, strict=True)],
        }
    return result


def plain(value: Any) -> Any:
    """Arrays as lists, numbers to nine digits after the point: what JSON takes."""
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, dict):
        return {key: plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [plain(part) for part in value]
    if isinstance(value, np.bool_ | bool):
        return bool(value)
    return round(float(value), 9) if isinstance(value, float | np.floating) else value


@dataclass(frozen=True)
class GoldenConfig:
    """models: the folder whose networks get golden outputs."""

    models: Path = REPOSITORY / "public/models"


def window_vectors() -> list[dict[str, Any]]:
    """Windows of the board's networks: what goes in and what must come out."""
    cases = []
    for number, person in enumerate(BODIES[:1]):
        random = np.random.default_rng([17, number])
        joints, turns = generate_clip(random, WINDOW_FRAMES + 1, Person("golden", person.eye_height, person.arm_span))
        trackers = TrackerConfig()
        positions, rotations = simulate(joints, turns, draw_wearer(trackers, random), trackers, random)
        body = body_from_calibration(*np.array([[person.eye_height], [person.arm_span]]))
        features = window_features(positions[None], rotations[None], body)[0]
        case = {"positions": positions, "rotations": rotations, "features": features}
        cases.append({"calibration": person.calibration(), **case})
    return cases


def main(config: GoldenConfig) -> None:
    """Writes correction-share.json, features.json, fitted-joints.json, headset-rise.json, mocap.json and windows.json in
    tests/golden, and models.json where there are models.
    """
    GOLDEN.mkdir(parents=True, exist_ok=True)
    (GOLDEN / "correction-share.json").write_text(json.dumps(plain(correction_share_vectors())) + "\n")
    (GOLDEN / "features.json").write_text(json.dumps(plain(feature_vectors())) + "\n")
    (GOLDEN / "fitted-joints.json").write_text(json.dumps(plain(fitted_vectors())) + "\n")
    (GOLDEN / "headset-rise.json").write_text(json.dumps(plain(headset_rise_vectors())) + "\n")
    (GOLDEN / "mocap.json").write_text(json.dumps(plain(mocap_vectors())) + "\n")
    (GOLDEN / "windows.json").write_text(json.dumps(plain(window_vectors())) + "\n")
    if list(config.models.glob("*.json")):
        (GOLDEN / "models.json").write_text(json.dumps(plain(model_vectors(config.models))) + "\n")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--models", type=Path, default=GoldenConfig.models)
    main(GoldenConfig(parser.parse_args().models))
