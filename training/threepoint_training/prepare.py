"""Motion capture files to one corpus: 60 frames a second, our joints in metres, floor frame, people facing −Z in
T-pose.
"""

import hashlib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .foreign_motion import SUFFIXES, read_foreign
from .lockbox_log import LockboxAccess, permitted
from .mocap_asf_amc import AsfSkeleton, parse_amc, parse_asf
from .mocap_rules import RULES
from .motion import MocapError, Motion
from .motion_files import Source, frame_rate, index_rates, motion_files
from .prepared_corpus import JOINTS, LEG_JOINTS, Person, PreparedCorpus
from .rest_pose import check_rest, face_forward, rest_from_frame
from .skeleton_map import SkeletonMap, find_skeleton_map, read_skeleton_map

RATE_HZ: int = RULES["rateHz"]

# Faster than any limb: the hands of boxers and of a sprinter's swing stay below 15 m/s, a fall below 8.
TELEPORT_SPEED: float = RULES["teleportSpeed"]
SHORTEST_SEGMENT_SECONDS: float = RULES["shortestPieceSeconds"]

# The headset's origin (between the eyes) relative to the head joint, in the head's frame: up and forward [m].
EYES_FROM_HEAD_JOINT = np.array(RULES["eyesFromHeadJoint"])

# The wrist's −Z points to the knuckles, +Y out of the back of the hand; in T-pose the knuckles point sideways, palms
# down.
_HAND_REST = {
    "leftHand": quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array(np.pi / 2)),
    "rightHand": quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array(-np.pi / 2)),
}
_LATERAL = {"leftHand": np.array([-1.0, 0.0, 0.0]), "rightHand": np.array([1.0, 0.0, 0.0])}


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


@dataclass(frozen=True)
class _Clip:
    """One clip in our joints and axes, still at its own rate; legs [frames, 8, 3] (LEG_JOINTS, NaN: not in the map);
    rest is the rest pose.
    """

    positions: NDArray[np.float64]
    rotations: NDArray[np.float64]
    legs: NDArray[np.float64]
    rest: dict[str, NDArray[np.float64]]
    rate: float


def _scale(motion: Motion, skeleton: SkeletonMap, file_name: str) -> float:
    """Metres per unit: the map's, else the one that makes the rest skeleton a person."""
    if skeleton.scale:
        return skeleton.scale
    rest = {
        ours: motion.rest_positions[motion.index(theirs)]
        for ours, theirs in skeleton.joints.items()
        if theirs in motion.names
    }
    arm = sum(
        np.linalg.norm(rest[a] - rest[b]) for a, b in (("leftUpperArm", "leftLowerArm"), ("leftLowerArm", "leftHand"))
    )
    # Shoulder to wrist of 5th-percentile women to 95th-percentile men is 0.46–0.62 m; children and odd definitions
    # widen it.
    shortest, longest = RULES["armLength"]
    for scale in RULES["units"]:
        if shortest < arm * scale < longest:
            return scale
    raise MocapError(
        f"{file_name}: an arm of {arm:.3g} units fits no known unit; give “scale” (metres per unit) in a skeleton map"
    )


def _to_our_joints(motion: Motion, skeleton: SkeletonMap, rate: float, file_name: str) -> _Clip:
    for theirs in skeleton.joints.values():
        if theirs not in motion.names:
            raise MocapError(f"{file_name}: no joint “{theirs}”, which the map “{skeleton.name}” names")
    if skeleton.rest_frame is not None:
        motion = face_forward(motion, skeleton.joints, skeleton.floor_from_file())
    scale = _scale(motion, skeleton, file_name)
    turn = quaternion.from_matrix(skeleton.floor_from_file())

    def place(points: NDArray[np.float64]) -> NDArray[np.float64]:
        return quaternion.rotate(np.broadcast_to(turn, (*points.shape[:-1], 4)), points) * scale

    rest = {ours: place(motion.rest_positions[motion.index(theirs)]) for ours, theirs in skeleton.joints.items()}
    check_rest(rest, skeleton.joints, file_name)
    columns = [motion.index(skeleton.joints.get(joint, skeleton.joints["hips"])) for joint in JOINTS]
    positions = place(motion.positions[:, columns])
    if "spine" not in skeleton.joints:
        spine = JOINTS.index("spine")
        positions[:, spine] = (positions[:, JOINTS.index("hips")] + positions[:, JOINTS.index("chest")]) / 2
    rotations = []
    for joint in ("head", "leftHand", "rightHand"):
        source = motion.index(skeleton.rotations.get(joint, skeleton.joints[joint]))
        # Rotations relative to the rest pose, in our axes: conjugated by the turn.
        q = motion.rotations[:, source]
        q = quaternion.multiply(
            np.broadcast_to(turn, q.shape), quaternion.multiply(q, np.broadcast_to(quaternion.conjugate(turn), q.shape))
        )
        if joint in _HAND_REST:
            elbow = rest[joint.replace("Hand", "LowerArm")]
            align = quaternion.rotation_between(_LATERAL[joint], rest[joint] - elbow)
            q = quaternion.multiply(q, np.broadcast_to(quaternion.multiply(align, _HAND_REST[joint]), q.shape))
        rotations.append(quaternion.continuous(q))
    legs = np.full((len(positions), len(LEG_JOINTS), 3), np.nan)
    for column, joint in enumerate(LEG_JOINTS):
        if joint in skeleton.joints:
            legs[:, column] = place(motion.positions[:, motion.index(skeleton.joints[joint])])
    return _Clip(positions, np.stack(rotations, axis=1), legs, rest, rate)


def _segments(clip: _Clip, name: str, report: Callable[[str], None]) -> Iterable[tuple[str, _Clip]]:
    """The clip cut where it teleports; pieces too short to be motion are left out. Both are reported."""
    speed = np.linalg.norm(np.diff(clip.positions, axis=0), axis=-1).max(axis=1) * clip.rate
    cuts = np.flatnonzero(speed > TELEPORT_SPEED) + 1
    if len(cuts):
        report(f"{name}: teleports at frame {', '.join(str(cut + 1) for cut in cuts[:5])}; cut there")
    bounds = [0, *cuts.tolist(), len(clip.positions)]
    return _pieces(clip, name, list(zip(bounds[:-1], bounds[1:], strict=True)), report)


def _pieces(
    clip: _Clip, name: str, bounds: Sequence[tuple[int, int]], report: Callable[[str], None]
) -> Iterable[tuple[str, _Clip]]:
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


def _with_head_turned(clip: _Clip, neutral: NDArray[np.float64]) -> _Clip:
    """The clip with head rotations that are the identity where the person looks ahead; neutral: from `_neutral_head`."""
    head = quaternion.multiply(clip.rotations[:, 0], np.broadcast_to(neutral, clip.rotations[:, 0].shape))
    return replace(clip, rotations=np.concatenate([head[:, None], clip.rotations[:, 1:]], axis=1))


def _with_head_on_neck(clip: _Clip, name: str, report: Callable[[str], None]) -> Iterable[tuple[str, _Clip]]:
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


def _resample(clip: _Clip) -> _Clip:
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

    def between(points: NDArray[np.float64]) -> NDArray[np.float64]:
        return points[before] * (1 - share)[:, None, None] + points[before + 1] * share[:, None, None]

    rotations = quaternion.slerp(clip.rotations[before], clip.rotations[before + 1], share[:, None] * np.ones((1, 3)))
    return replace(clip, positions=between(clip.positions), rotations=rotations, legs=between(clip.legs), rate=RATE_HZ)


def _standing_eye_height(clip: _Clip) -> float | None:
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


def _person(person: str, clips: list[tuple[str, _Clip]]) -> Person:
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


def _neutral_head(clips: list[tuple[str, _Clip]]) -> NDArray[np.float64]:
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


def _floor_height(clips: list[tuple[str, _Clip]]) -> float:
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


def _motion(source: Source, skeletons: dict[Path, AsfSkeleton]) -> Motion:
    """What an AMC file has; `skeletons` keeps those read before."""
    if source.asf is None:
        raise MocapError(f"{source.path.name}: no .asf skeleton beside it")
    if source.asf not in skeletons:
        skeletons[source.asf] = parse_asf(source.asf)
    return parse_amc(source.path, skeletons[source.asf])


class _Reader:
    """Reads the files of one corpus with one map; what was put right is counted in `notes`, by the sentence that says
    it.
    """

    def __init__(self, config: PrepareConfig, sources: Sequence[Source]) -> None:
        self.given = read_skeleton_map(config.skeleton_map) if config.skeleton_map else None
        foreign = [source.path for source in sources if source.path.suffix.lower() in SUFFIXES]
        self.foreign = read_foreign(foreign, config.skeleton_map)
        self.rates = index_rates(config.mocap)
        self.skeletons: dict[Path, AsfSkeleton] = {}
        self.rests: dict[Path, Motion] = {}
        self.notes: dict[str, list[str]] = {}

    def read(self, source: Source) -> _Clip:
        """One file in our joints; what cannot be read raises MocapError or OSError."""
        name = source.path.name
        if source.path in self.foreign:
            return self._foreign(source)
        if self.given and self.given.rest_pose is not None:
            raise MocapError(f"{name}: restPose is for BVH files; here restFrame can be given")
        motion = _motion(source, self.skeletons)
        skeleton = self.given or find_skeleton_map(motion.names, name)
        if motion.frame_rate is None:
            motion = replace(motion, frame_rate=frame_rate(source.path, skeleton, self.rates))
        if skeleton.rest_frame is not None:
            motion = self._counted_from(motion, skeleton, skeleton.rest_frame, source)
        clip = _to_our_joints(motion, skeleton, motion.frame_rate or RATE_HZ, name)
        for note in motion.notes:
            self.notes.setdefault(note, []).append(name)
        return clip

    def _foreign(self, source: Source) -> _Clip:
        found = self.foreign[source.path]
        if isinstance(found, MocapError):
            raise found
        for note in found.notes:
            self.notes.setdefault(note, []).append(source.path.name)
        rotations = np.stack([quaternion.continuous(found.rotations[:, i]) for i in range(3)], axis=1)
        return _Clip(found.positions, rotations, found.legs, found.rest, found.rate)

    def _counted_from(self, motion: Motion, skeleton: SkeletonMap, frame: int, source: Source) -> Motion:
        file = skeleton.rest_file
        if file is None:
            return rest_from_frame(motion, frame, motion, source.path.name)
        if file not in self.rests:
            self.rests[file] = _motion(replace(source, path=file), self.skeletons)
        return rest_from_frame(motion, frame, self.rests[file], f"{source.path.name}, {file.name}")

    def messages(self) -> list[str]:
        """Returns a message for each correction, with the files that it was applied to."""
        return [
            f"{files[0]}{f' and {len(files) - 1} more' if len(files) > 1 else ''}: {note}"
            for note, files in self.notes.items()
        ]


def main(config: PrepareConfig, progress: Callable[[str], None] = lambda _: None) -> PreparedCorpus:
    """Prepares every clip it can; what it cannot is in `problems`, a sentence each. Nothing usable raises MocapError.
    """
    sources, left_out = permitted(motion_files(config.mocap, config.people), config.people, config.lockbox)
    hashed = [path for source in sources for path in (source.path, source.asf) if path is not None]
    given = read_skeleton_map(config.skeleton_map) if config.skeleton_map else None
    rest_file = given.rest_file if given else None
    digest = corpus_hash([*hashed, *(path for path in (config.skeleton_map, rest_file) if path)])
    cached = config.cache / f"{digest[:16]}-v{PreparedCorpus.VERSION}.npz" if config.cache else None
    if cached and cached.is_file():
        return PreparedCorpus.load(cached)

    reader = _Reader(config, sources)
    problems: list[str] = [*left_out]
    by_person: dict[str, list[tuple[str, _Clip]]] = {}
    for source in sources:
        progress(source.path.name)
        try:
            clip = reader.read(source)
            by_person.setdefault(source.person, []).extend(_segments(clip, source.path.stem, problems.append))
        except MocapError as error:
            problems.append(str(error))
        except OSError as error:
            problems.append(f"{source.path.name}: cannot be read: {error.strerror}")

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
        problems=(*reader.messages(), *problems),
        legs=np.concatenate(legs),
    )
    if cached:
        corpus.save(cached)
    return corpus
