"""The parameters of inverse kinematics, fitted by damped least squares: the tuned competitor every network is measured
against.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import hand_tilt, mirror, quaternion, solve_ik
from .arrays import Array
from .prepared_corpus import ESTIMATED_JOINTS, JOINTS, PreparedCorpus
from .simulate_trackers import TrackerConfig, draw_wearer, measured_tilts, simulate
from .skeleton import Body, body_from_calibration

# The initial parameters, which are the target of the ridge penalty: an upright trunk, elbows down, back and a little
# outward.
PRIOR: dict[str, Any] = {
    "yaw": [0.3, 0.2],
    "upper": {"forward": [0, 0.25, 0.3, 0.1, 0, 0], "sideways": [0.2, 0.1, 0]},
    "lower": {"forward": [-0.05, 0.15, 0.8, 0.05, 0, 0], "sideways": [0.1, 0.05, 0]},
    "neck": 0.5,
    "clavicle": [[0, 0, 0, 0], [0, 0, 0.03, 0], [0, 0, 0, 0.03]],
    "untiltedPole": [[0.4] + [0] * 9, [-1.0] + [0] * 9, [0.6] + [0] * 9],
    "pole": [[0.4] + [0] * 9, [-1.0] + [0] * 9, [0.6] + [0] * 9],
}


@dataclass(frozen=True)
class FitIkConfig:
    """frames_per_person balances people; ridge is in squared metres per squared parameter unit and frame."""

    frames_per_person: int = 500
    iterations: int = 12
    ridge: float = 2e-5
    robust_scale: float = 0.08  # [m]: errors beyond count linearly (Huber)
    seed: int = 7


def flatten(parameters: dict[str, Any]) -> Array:
    """The parameters as one vector, in the order of PRIOR."""

    def numbers(shape: Any, part: Any) -> list[float]:
        if isinstance(shape, dict):
            return [number for key in shape for number in numbers(shape[key], part[key])]
        return np.ravel(part).tolist()

    return np.array(numbers(PRIOR, parameters), np.float64)


def unflatten(vector: Array) -> dict[str, Any]:
    """The inverse of `flatten`."""
    values = iter(vector.tolist())

    def take(shape: Any) -> Any:
        if isinstance(shape, dict):
            return {key: take(part) for key, part in shape.items()}
        return [take(part) for part in shape] if isinstance(shape, list) else next(values)

    return take(PRIOR)


@dataclass(frozen=True)
class Sample:
    """Frames in their heading frames with the truth there [F, 6, 3] and one body per frame."""

    positions: Array
    rotations: Array
    truth: Array
    body: Body
    people: NDArray[np.str_]


def sample(
    corpus: PreparedCorpus,
    people: tuple[str, ...],
    proportions: dict[str, Any],
    per_person: int | None,
    seed: int,
    *,
    mirrored: bool = True,
) -> Sample:
    """Frames of these people as trackers would see them, the same number of each (None: all), mirrored ones beside
    them.

    In every other frame hands are turned by their tilts, so that both of IK's poles are fitted.
    """
    random = np.random.default_rng(seed)
    trackers = TrackerConfig()
    columns = [JOINTS.index(joint) for joint in ESTIMATED_JOINTS]
    forearms = hand_tilt.ForearmMeans(corpus, people)
    parts = []
    for name in people:
        person = corpus.people[name]
        frames = corpus.frames_of({name})
        if per_person is not None and per_person < len(frames):
            frames = np.sort(random.choice(frames, per_person, replace=False))
        true_positions = corpus.positions[frames].astype(np.float64)
        wearer = draw_wearer(trackers, random)
        positions, rotations = simulate(true_positions, corpus.rotations[frames], wearer, trackers, random)
        turned = np.broadcast_to((np.arange(len(frames)) % 2 == 1)[:, None], (len(frames), 2))
        tilts = measured_tilts(
            np.broadcast_to(forearms.of(name), (len(frames), 2, 2)), wearer.hand_turns, trackers, random
        )
        rotations = hand_tilt.normalised(rotations, np.where(turned[..., None], tilts, 0.0))
        local, turns, yaw, origin = solve_ik.to_heading(positions, rotations)
        truth = true_positions[:, columns] - origin[:, None]
        truth = quaternion.rotate(np.broadcast_to(quaternion.conjugate(yaw)[:, None], (*truth.shape[:-1], 4)), truth)
        sizes = np.tile([person.eye_height, person.arm_span], (len(frames), 1))
        parts.append((local, turns, truth, sizes, turned, np.full(len(frames), name)))
        if mirrored:
            parts.append(
                (*mirror.trackers(local, turns), mirror.joints(truth), sizes, turned, np.full(len(frames), name))
            )
    local, turns, truth, sizes, turned, names = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    body = body_from_calibration(sizes[:, 0], sizes[:, 1], proportions)
    return Sample(local, turns, truth, replace(body, hands_turned=turned), names)


def fit(frames: Sample, config: FitIkConfig, report: Callable[[int, float], None] = lambda *_: None) -> dict[str, Any]:
    """Levenberg-Marquardt with a Huber loss and a ridge towards PRIOR; report(iteration, MPJPE [m])."""
    prior = flatten(PRIOR)
    vector = prior.copy()
    count = len(frames.truth) * len(ESTIMATED_JOINTS)

    def residuals(values: Array) -> Array:
        return solve_ik.solve(frames.positions, frames.rotations, frames.body, unflatten(values)) - frames.truth

    def cost(values: Array, errors: Array) -> float:
        distance = np.linalg.norm(errors, axis=-1)
        huber = np.where(
            distance < config.robust_scale, distance**2, config.robust_scale * (2 * distance - config.robust_scale)
        )
        return float(huber.sum() + config.ridge * count * np.sum((values - prior) ** 2))

    damping = 1e-2
    errors = residuals(vector)
    best = cost(vector, errors)
    for iteration in range(config.iterations):
        distance = np.linalg.norm(errors, axis=-1, keepdims=True)
        weight = np.sqrt(np.minimum(1.0, config.robust_scale / np.maximum(distance, 1e-9)))
        jacobian = np.empty((errors.size, len(vector)), np.float32)
        for column in range(len(vector)):
            moved = vector.copy()
            moved[column] += 1e-4
            jacobian[:, column] = ((residuals(moved) - errors) / 1e-4 * weight).ravel()
        normal = (jacobian.T @ jacobian).astype(np.float64) + config.ridge * count * np.eye(len(vector))
        gradient = jacobian.T @ (errors * weight).ravel().astype(np.float32) + config.ridge * count * (vector - prior)
        for _ in range(6):
            step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), -gradient)
            candidate_errors = residuals(vector + step)
            candidate = cost(vector + step, candidate_errors)
            if candidate < best:
                vector, errors, best, damping = vector + step, candidate_errors, candidate, damping / 4
                break
            damping *= 4
        report(iteration, float(np.linalg.norm(errors, axis=-1).mean()))
    return unflatten(np.round(vector, 6))
