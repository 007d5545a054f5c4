"""Golden vectors that hold Python and TypeScript together (tests/golden), made of generated motion only."""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import features, quaternion
from .generated_motion import generate_clip
from .prepared_corpus import Person
from .simulate_trackers import TrackerConfig, draw_wearer, simulate
from .skeleton import body_from_calibration, rest_offsets

Array = NDArray[np.float64]

GOLDEN = Path(__file__).parents[2] / "tests/golden"
BODIES = ((1.62, 1.56), (1.15, 1.05), (2.02, 2.05))
FRAMES = 14
STRIDE = 9
WINDOW = (0.0, 0.1, 0.25)


def _tracked(eye_height: float, arm_span: float, random: np.random.Generator) -> tuple[Array, Array]:
    """Some frames of somebody of that size, as trackers see them."""
    joints, turns = generate_clip(random, FRAMES * STRIDE, Person("golden", eye_height, arm_span))
    trackers = TrackerConfig()
    positions, rotations = simulate(joints, turns, draw_wearer(trackers, random), trackers, random)
    return positions[::STRIDE], rotations[::STRIDE]


def _in_floor_frame(joints: Array, positions: Array, rotations: Array) -> Array:
    """Joints [F, 6, 3] that the heading frame has there."""
    yaw, origin = quaternion.heading(rotations[:, 0]), positions[:, 0] * [1, 0, 1]
    return quaternion.rotate(np.broadcast_to(yaw[:, None], (*joints.shape[:-1], 4)), joints) + origin[:, None]


def feature_vectors() -> list[dict[str, Any]]:
    """Rotated and moved people in three sizes, one hand unseen now and then: what goes in and what must come out."""
    cases = []
    for number, (eye_height, arm_span) in enumerate(BODIES):
        random = np.random.default_rng([11, number])
        positions, rotations = _tracked(eye_height, arm_span, random)
        seen = random.uniform(size=(FRAMES, 2)) > 0.15
        times = np.arange(FRAMES) * STRIDE / 60 + random.uniform(0, 0.01, FRAMES)
        body = body_from_calibration(np.array(eye_height), np.array(arm_span))
        vector, ik_joints = features.frame_features(positions, rotations, body, seen)
        floor_joints = _in_floor_frame(ik_joints, positions, rotations)
        cases.append(
            {
                "calibration": {"eyeHeight": eye_height, "armSpan": arm_span},
                "restOffsets": rest_offsets(eye_height, arm_span),
                "window": WINDOW,
                "frames": [
                    {
                        "time": times[i],
                        "positions": positions[i],
                        "rotations": rotations[i],
                        "seen": seen[i],
                        "ikJoints": floor_joints[i],
                        "features": vector[i],
                        "paperInput": features.paper_input(positions[i : i + 1], rotations[i : i + 1])[0].ravel(),
                    }
                    for i in range(FRAMES)
                ],
                "inputs": features.network_input(vector, times, WINDOW),
            }
        )
    return cases


def placement_vectors() -> list[dict[str, Any]]:
    """The same people, joints estimated about where IK has them, and where the skeleton puts those."""
    import torch

    from .placement import Placement

    placement = Placement()
    cases = []
    for number, (eye_height, arm_span) in enumerate(BODIES):
        random = np.random.default_rng([13, number])
        positions, rotations = _tracked(eye_height, arm_span, random)
        vector, ik_joints = features.frame_features(positions, rotations, body_from_calibration(np.array(eye_height), np.array(arm_span)))
        inputs = torch.from_numpy(features.network_input(vector, np.arange(FRAMES) / 60, WINDOW).astype(np.float32))
        said = random.normal(scale=0.015, size=ik_joints.shape)
        came_to = placement(torch.from_numpy(said.astype(np.float32)), inputs, reach_passes=8).numpy()
        axes = features.chest_axes(vector)
        estimated, placed = (
            _in_floor_frame(ik_joints + eye_height * shift @ axes, positions, rotations) for shift in (said, came_to.astype(np.float64))
        )
        cases.append(
            {
                "calibration": {"eyeHeight": eye_height, "armSpan": arm_span},
                "frames": [
                    {"positions": positions[i], "rotations": rotations[i], "estimated": estimated[i], "placed": placed[i]} for i in range(FRAMES)
                ],
            }
        )
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
    body = body_from_calibration(np.array(person.eye_height), np.array(person.arm_span))
    vector, _ = features.frame_features(positions, rotations, body)
    for contract_file in sorted(models.glob("*.json")):
        contract = json.loads(contract_file.read_text())
        session = onnxruntime.InferenceSession(models / contract["file"])
        if contract["name"] == "paper":
            inputs = features.paper_input(positions, rotations)
        else:
            inputs = features.network_input(vector, np.arange(len(vector)) / 60, tuple(contract["windowSeconds"]))
        inputs = inputs[::12].astype(np.float32)
        name = contract["inputs"][0]["name"]
        outputs = [session.run(None, {name: row[None]})[0][0] for row in inputs]
        result[contract["name"]] = {
            "sha256": contract["sha256"],
            "tolerance": contract["quantisation"]["runtimeTolerance"],
            "cases": [{"input": row.ravel(), "output": output} for row, output in zip(inputs, outputs, strict=True)],
        }
    return result


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, dict):
        return {key: _plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if isinstance(value, np.bool_ | bool):
        return bool(value)
    return round(float(value), 9) if isinstance(value, float | np.floating) else value


def main(models: Path) -> None:
    """Writes tests/golden/features.json and placement.json, and models.json where there are models."""
    GOLDEN.mkdir(parents=True, exist_ok=True)
    (GOLDEN / "features.json").write_text(json.dumps(_plain(feature_vectors())) + "\n")
    (GOLDEN / "placement.json").write_text(json.dumps(_plain(placement_vectors())) + "\n")
    if list(models.glob("*.json")):
        (GOLDEN / "models.json").write_text(json.dumps(_plain(model_vectors(models))) + "\n")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--models", type=Path, default=Path(__file__).parents[2] / "public/models")
    main(parser.parse_args().models)
