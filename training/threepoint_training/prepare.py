"""Motion capture files to one corpus: 60 frames a second, our joints in metres, floor frame, people facing −Z in
T-pose.
"""

import hashlib
import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from . import quaternion
from .arrays import Array
from .lockbox_log import LockboxAccess, permitted
from .motion_files import MocapError, index_rates, motion_files
from .prepared_corpus import JOINTS, LEG_JOINTS, Person, PreparedCorpus
from .read_motion import Clip, read_motion
from .shared_constants import MOCAP_RULES

RATE_HZ: int = MOCAP_RULES["rateHz"]

# Faster than any limb: the hands of boxers and of a sprinter's swing stay below 15 m/s, a fall below 8.
TELEPORT_SPEED: float = MOCAP_RULES["teleportSpeed"]
SHORTEST_SEGMENT_SECONDS: float = MOCAP_RULES["shortestPieceSeconds"]

# The headset's origin (between the eyes) relative to the head joint, in the head's frame: up and forward [m].
EYES_FROM_HEAD_JOINT = np.array(MOCAP_RULES["eyesFromHeadJoint"])


@dataclass(frozen=True)
class PrepareConfig:
    """mocap: a folder searched for .asf, .amc, .bvh and .vrma files. people: only these (None: all outside the
    lockbox). lockbox: needed where `people` has lockbox people.
    """

    mocap: Path
    skeleton_map: Path | None = None
    people: tuple[str, ...] | None = None
    cache: Path | None = None
    lockbox: LockboxAccess | None = None


def _segments(clip: Clip, name: str, report: Callable[[str], None]) -> Iterable[tuple[str, Clip]]:
    """The clip cut where it teleports; pieces too short to be motion are left out. Both are reported."""
    speed = np.linalg.norm(np.diff(clip.positions, axis=0), axis=-1).max(axis=1) * clip.rate
    cuts = np.flatnonzero(speed > TELEPORT_SPEED) + 1
    if len(cuts):
        report(f"{name}: teleports at frame {', '.join(str(cut + 1) for cut in cuts[:5])}; cut there")
    bounds = [0, *cuts.tolist(), len(clip.positions)]
    return _pieces(clip, name, list(zip(bounds[:-1], bounds[1:], strict=True)), report)


def _pieces(
    clip: Clip, name: str, bounds: Sequence[tuple[int, int]], report: Callable[[str], None]
) -> Iterable[tuple[str, Clip]]:
    """The pieces of a clip between these frames, numbered where there are several; those too short are left out."""
    shortest = max(4, round(SHORTEST_SEGMENT_SECONDS * clip.rate))
    pieces = [(start, end) for start, end in bounds if end - start >= shortest]
    if left_out := len(bounds) - len(pieces):
        which = f"{left_out} of {len(bounds)} pieces " if len(bounds) > 1 else ""
        report(f"{name}: {which}shorter than {SHORTEST_SEGMENT_SECONDS} s; left out")
    for number, (start, end) in enumerate(pieces):
        piece = replace(
            clip, positions=clip.positions[start:end], rotations=clip.rotations[start:end], legs=clip.legs[start:end]
        )
        yield (name if len(pieces) == 1 else f"{name}#{number + 1}"), piece


def _with_head_turned(clip: Clip, neutral: Array) -> Clip:
    """The clip with head rotations that are the identity where the person looks ahead; neutral: from `_neutral_head`.
    """
    head = quaternion.multiply(clip.rotations[:, 0], np.broadcast_to(neutral, clip.rotations[:, 0].shape))
    return replace(clip, rotations=np.concatenate([head[:, None], clip.rotations[:, 1:]], axis=1))


def _with_head_on_neck(clip: Clip, name: str, report: Callable[[str], None]) -> Iterable[tuple[str, Clip]]:
    """The clip without frames whose head is recorded upside down, and without pieces too short; both are reported.

    There the head's up axis is more than 90° from the direction from the neck to the head, which no neck can do.
    """
    neck = clip.positions[:, JOINTS.index("head")] - clip.positions[:, JOINTS.index("neck")]
    up = quaternion.rotate(clip.rotations[:, 0], np.broadcast_to([0.0, 1.0, 0.0], neck.shape))
    wrong = np.sum(up * neck, axis=-1) < 0
    if not wrong.any():
        return [(name, clip)]
    report(f"{name}: the head is upside down in {wrong.sum()} of {len(wrong)} frames; they are left out")
    edges = np.flatnonzero(np.diff(np.concatenate([[True], wrong, [True]]).astype(np.int8)))
    return _pieces(clip, name, list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)), report)


def _resample(clip: Clip) -> Clip:
    """The clip at 60 Hz: every nth frame where that is exact, else interpolated."""
    step = clip.rate / RATE_HZ
    if abs(step - round(step)) < 1e-3 and step >= 1:
        every = round(step)
        return replace(
            clip,
            positions=clip.positions[::every],
            rotations=clip.rotations[::every],
            legs=clip.legs[::every],
            rate=RATE_HZ,
        )
    duration = (len(clip.positions) - 1) / clip.rate
    times = np.arange(int(np.floor(duration * RATE_HZ)) + 1) / RATE_HZ * clip.rate
    before = np.minimum(times.astype(int), len(clip.positions) - 2)
    share = times - before

    def between(points: Array) -> Array:
        return points[before] * (1 - share)[:, None, None] + points[before + 1] * share[:, None, None]

    rotations = quaternion.slerp(clip.rotations[before], clip.rotations[before + 1], share[:, None] * np.ones((1, 3)))
    return replace(clip, positions=between(clip.positions), rotations=rotations, legs=between(clip.legs), rate=RATE_HZ)


def _standing_eye_height(clip: Clip) -> float | None:
    """Eye height with straight legs and the trunk as at rest, from segment lengths; None without legs in the map."""
    rest = clip.rest
    if not all(joint in rest for joint in ("leftUpperLeg", "leftLowerLeg", "leftFoot")):
        return None
    legs = []
    for side in ("left", "right"):
        if f"{side}Foot" in rest:
            thigh, knee, ankle = (rest[f"{side}{part}"] for part in ("UpperLeg", "LowerLeg", "Foot"))
            legs.append(np.linalg.norm(thigh - knee) + np.linalg.norm(knee - ankle))
    hip = np.mean([rest[joint][1] for joint in ("leftUpperLeg", "rightUpperLeg") if joint in rest])
    # The ankle's height above the sole, about 4.5 % of the leg's 0.53 share of stature (Winter, Biomechanics: 0.039 of
    # stature).
    leg = float(np.mean(legs))
    sole = leg * 0.039 / 0.491
    return leg + sole + float(rest["head"][1] - hip) + EYES_FROM_HEAD_JOINT[1]


def _person(person: str, clips: list[tuple[str, Clip]]) -> Person:
    first = clips[0][1]
    rest = first.rest

    def length(a: str, b: str) -> float:
        return float(np.linalg.norm(rest[a] - rest[b]))

    span = length("leftUpperArm", "rightUpperArm") + sum(
        length(f"{side}UpperArm", f"{side}LowerArm") + length(f"{side}LowerArm", f"{side}Hand")
        for side in ("left", "right")
    )
    eye_height = _standing_eye_height(first)
    if eye_height is None:
        heads = np.concatenate([clip.positions[:, JOINTS.index("head"), 1] for _, clip in clips])
        eye_height = float(np.percentile(heads, 90)) + EYES_FROM_HEAD_JOINT[1]
    return Person(person, eye_height, span)


def _neutral_head(clips: list[tuple[str, Clip]]) -> Array:
    """The head's rotation when this person looks ahead: the median pitch and roll over frames with an upright trunk."""
    pitches, rolls = [], []
    for _, clip in clips:
        trunk = clip.positions[:, JOINTS.index("neck")] - clip.positions[:, JOINTS.index("hips")]
        upright = trunk[:, 1] > 0.94 * np.linalg.norm(trunk, axis=-1)
        head = clip.rotations[upright, 0]
        if len(head):
            upright_head = quaternion.multiply(quaternion.conjugate(quaternion.heading(head)), head)
            gaze = quaternion.rotate(upright_head, np.broadcast_to([0.0, 0.0, -1.0], (len(head), 3)))
            right = quaternion.rotate(upright_head, np.broadcast_to([1.0, 0.0, 0.0], (len(head), 3)))
            pitches.append(np.arctan2(gaze[:, 1], -gaze[:, 2]))
            rolls.append(np.arcsin(np.clip(right[:, 1], -1, 1)))
    if not pitches:
        return np.array([0.0, 0.0, 0.0, 1.0])
    pitch, roll = float(np.median(np.concatenate(pitches))), float(np.median(np.concatenate(rolls)))
    return quaternion.multiply(
        quaternion.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.array(pitch)),
        quaternion.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.array(roll)),
    )


def _floor_height(clips: list[tuple[str, Clip]]) -> float:
    """How far the lowest foot joint's usual height differs from a joint 2.5 cm above the floor; 0 where there are no
    feet.
    """
    feet = [LEG_JOINTS.index(f"{side}{part}") for side in ("left", "right") for part in ("Foot", "Toes")]
    # Infinity where the map has no such joint.
    heights = [np.nan_to_num(clip.legs[:, feet, 1], nan=np.inf).min(axis=1) for _, clip in clips]
    lowest = [height for height in heights if np.all(np.isfinite(height))]
    if not lowest:
        return 0.0
    offset = float(np.percentile(np.concatenate(lowest), 10)) - 0.025
    return offset if abs(offset) > 0.04 else 0.0


def corpus_hash(paths: Iterable[Path]) -> str:
    """SHA-256 over the sorted names and contents of the files."""
    digest = hashlib.sha256()
    for path in sorted(set(paths)):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _map_files(skeleton_map: Path | None) -> list[Path]:
    """A skeleton map and the file that its `restFrame` is of, as far as there are any; the reader refuses a faulty map.
    """
    if skeleton_map is None:
        return []
    try:
        rest = skeleton_map.parent / json.loads(skeleton_map.read_text())["restFrame"]["file"]
    except (ValueError, KeyError, TypeError):
        return [skeleton_map]
    return [skeleton_map, *([rest] if rest.is_file() else [])]


def _corrections(corrected: dict[str, list[str]]) -> list[str]:
    """A message for each correction, with the files that it was applied to."""
    return [
        f"{files[0]}{f' and {len(files) - 1} more' if len(files) > 1 else ''}: {note}"
        for note, files in corrected.items()
    ]


def main(config: PrepareConfig, progress: Callable[[str], None] = lambda _: None) -> PreparedCorpus:
    """Prepares every clip it can; what it cannot is in `problems`, a sentence each. Nothing usable raises MocapError.
    """
    sources, left_out = permitted(motion_files(config.mocap, config.people), config.people, config.lockbox)
    hashed = [path for source in sources for path in (source.path, source.asf) if path is not None]
    digest = corpus_hash([*hashed, *_map_files(config.skeleton_map)])
    cached = config.cache / f"{digest[:16]}-v{PreparedCorpus.VERSION}.npz" if config.cache else None
    if cached and cached.is_file():
        return PreparedCorpus.load(cached)

    problems: list[str] = [*left_out]
    # The names of the files that each correction was applied to.
    corrected: dict[str, list[str]] = {}
    by_person: dict[str, list[tuple[str, Clip]]] = {}
    for source, clip in read_motion(sources, config.skeleton_map, index_rates(config.mocap)):
        progress(source.path.name)
        if isinstance(clip, str):
            problems.append(clip)
            continue
        for note in clip.notes:
            corrected.setdefault(note, []).append(source.path.name)
        by_person.setdefault(source.person, []).extend(_segments(clip, source.path.stem, problems.append))

    positions, rotations, legs, names, people_of_clips, starts = [], [], [], [], [], [0]
    people: dict[str, Person] = {}
    for person, clips in sorted(by_person.items()):
        if not clips:
            continue
        people[person] = _person(person, clips)
        neutral = quaternion.conjugate(_neutral_head(clips))
        above_floor = np.array([0.0, _floor_height(clips), 0.0])
        for name, clip in clips:
            even = _with_head_turned(_resample(clip), neutral)
            for piece_name, piece in _with_head_on_neck(even, name, problems.append):
                positions.append((piece.positions - above_floor).astype(np.float32))
                legs.append((piece.legs - above_floor).astype(np.float32))
                rotations.append(piece.rotations.astype(np.float32))
                names.append(piece_name)
                people_of_clips.append(person)
                starts.append(starts[-1] + len(piece.positions))
    if not positions:
        raise MocapError("nothing could be read:\n" + "\n".join(problems))
    corpus = PreparedCorpus(
        positions=np.concatenate(positions),
        rotations=np.concatenate(rotations),
        clips=tuple(names),
        clip_people=tuple(people_of_clips),
        clip_starts=np.array(starts),
        people=people,
        rate_hz=RATE_HZ,
        corpus_hash=digest,
        problems=(*_corrections(corrected), *problems),
        legs=np.concatenate(legs),
    )
    if cached:
        corpus.save(cached)
    return corpus
