"""Motion made of sines: seeded three-point frames with a plausible body, for golden vectors and the smoke test. No
mocap.
"""

import numpy as np

from . import quaternion
from .arrays import Array
from .prepare import RATE_HZ
from .prepared_corpus import JOINTS, Person, PreparedCorpus


def _wave(random: np.random.Generator, times: Array, dimensions: int, amplitude: float) -> Array:
    """Smooth noise [F, dimensions] of three sines per dimension, standard deviation about `amplitude`."""
    frequency = random.uniform(0.05, 0.8, (3, dimensions))
    phase = random.uniform(0, 2 * np.pi, (3, dimensions))
    return amplitude * np.sqrt(2 / 3) * np.sin(2 * np.pi * frequency * times[:, None, None] + phase).sum(axis=1)


def generate_clip(random: np.random.Generator, frames: int, person: Person) -> tuple[Array, Array]:
    """Joints [F, 11, 3] and rotations [F, 3, 4] (head, hands) of a person wandering, turning, bending and moving the
    arms.
    """
    times = np.arange(frames) / RATE_HZ
    e = person.eye_height
    arm = (person.arm_span - 0.24 * e) / 2
    yaw = random.uniform(-np.pi, np.pi) + _wave(random, times, 1, 0.8)[:, 0]
    turn = quaternion.from_axis_angle(np.broadcast_to([0.0, 1.0, 0.0], (frames, 3)), yaw)
    lean = quaternion.multiply(
        turn, quaternion.from_rotation_vector(_wave(random, times, 3, 0.12) + np.array([-0.1, 0, 0]))
    )
    crouch = 0.08 * e * (1 + _wave(random, times, 1, 0.7)[:, 0])
    hips = random.uniform(-1, 1, 3) * [1, 0, 1] + _wave(random, times, 3, 0.3) * [1, 0.05, 1]
    hips[:, 1] += 0.6 * e - np.maximum(crouch, 0)

    def along(q: Array, v: list[float]) -> Array:
        return quaternion.rotate(q, np.broadcast_to(np.array(v) * e, (frames, 3)))

    joints = {"hips": hips}
    joints["spine"] = hips + along(lean, [0, 0.072, 0])
    joints["chest"] = hips + along(lean, [0, 0.144, 0])
    upper = quaternion.multiply(lean, quaternion.from_rotation_vector(_wave(random, times, 3, 0.1)))
    joints["neck"] = joints["chest"] + along(upper, [0, 0.072, 0])
    head = quaternion.multiply(upper, quaternion.from_rotation_vector(_wave(random, times, 3, 0.3)))
    joints["head"] = joints["neck"] + along(upper, [0, 0.117, 0.0])
    rotations = [head]
    for side, sign in (("left", -1.0), ("right", 1.0)):
        shoulder = joints["neck"] + along(upper, [sign * 0.113, 0.035, 0])
        # The upper arm hangs down, swings forward and out; the elbow bends forward.
        swing = quaternion.multiply(
            upper,
            quaternion.from_rotation_vector(
                _wave(random, times, 3, 0.6) * np.array([1.0, 0.5, 0.4]) + np.array([0.5, 0.0, sign * 0.35])
            ),
        )
        flexion = 1.0 + 0.7 * np.tanh(_wave(random, times, 1, 1.0)[:, 0])
        forearm = quaternion.multiply(
            swing, quaternion.from_axis_angle(np.broadcast_to([1.0, 0.0, 0.0], (frames, 3)), flexion)
        )
        down = np.broadcast_to([0.0, -arm / 2, 0.0], (frames, 3))
        joints[f"{side}UpperArm"] = shoulder
        joints[f"{side}LowerArm"] = shoulder + quaternion.rotate(swing, down)
        joints[f"{side}Hand"] = joints[f"{side}LowerArm"] + quaternion.rotate(forearm, down)
        # Knuckles away from the elbow, thumb forward when the arm hangs.
        grip = quaternion.from_matrix(np.array([[0.0, sign, 0.0], [0.0, 0.0, 1.0], [sign, 0.0, 0.0]]))
        wrist = quaternion.multiply(forearm, np.broadcast_to(grip, (frames, 4)))
        rotations.append(quaternion.multiply(wrist, quaternion.from_rotation_vector(_wave(random, times, 3, 0.25))))
    return np.stack([joints[joint] for joint in JOINTS], axis=1), np.stack(rotations, axis=1)


def generate_corpus(people: int, clips: int, frames: int, seed: int) -> PreparedCorpus:
    """A small corpus of that many generated people, clips of each and frames of each clip; named from 002, for 001 is
    in the lockbox.
    """
    random = np.random.default_rng(seed)
    crowd = {}
    positions, rotations, names, owners, starts = [], [], [], [], [0]
    for number in range(people):
        eye_height = random.uniform(1.45, 1.75)
        person = Person(f"{number + 2:03d}", eye_height, eye_height * random.uniform(0.93, 1.0))
        crowd[person.name] = person
        for clip in range(clips):
            clip_positions, clip_rotations = generate_clip(random, frames, person)
            positions.append(clip_positions.astype(np.float32))
            rotations.append(clip_rotations.astype(np.float32))
            names.append(f"{person.name}_{clip + 1:02d}")
            owners.append(person.name)
            starts.append(starts[-1] + frames)
    return PreparedCorpus(
        positions=np.concatenate(positions),
        rotations=np.concatenate(rotations),
        clips=tuple(names),
        clip_people=tuple(owners),
        clip_starts=np.array(starts),
        people=crowd,
        rate_hz=RATE_HZ,
        corpus_hash=f"generated-{people}x{clips}x{frames}-seed{seed}",
        problems=(),
    )
