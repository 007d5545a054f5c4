"""Recordings for the evaluation: what the trackers saw, with the truth beside it; TypeScript reads and drives them."""

import argparse
import json
import sys
import zlib
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

from . import hand_tilt, prepare
from .arrays import Array
from .lockbox_log import LockboxAccess
from .motion_files import MocapError
from .prepared_corpus import JOINTS, LEG_JOINTS, ROTATIONS, PreparedCorpus
from .shared_constants import MOCAP_RULES
from .simulate_trackers import FOREARM_ERROR, NormalNumbers, TrackerConfig, draw_wearer, measured_tilts, simulate

VERSION = 1
COLUMNS = tuple(
    f"{point}.{part}" for point in ROTATIONS for part in ("px", "py", "pz", "qx", "qy", "qz", "qw")
) + tuple(f"truth.{joint}.{axis}" for joint in JOINTS + LEG_JOINTS for axis in "xyz")


@dataclass(frozen=True)
class RecordingsConfig:
    """The source of the motion, the folder of the recordings, and the tracker errors."""

    prepare: prepare.PrepareConfig
    out: Path
    seed: int = MOCAP_RULES["seed"]
    trackers: TrackerConfig = field(default_factory=TrackerConfig)


def write(corpus: PreparedCorpus, config: RecordingsConfig) -> Path:
    """One little-endian float32 file [frames, COLUMNS] (NaN: joints that the motion lacks) per clip and index.json;
    same seed, same bytes.
    """
    config.out.mkdir(parents=True, exist_ok=True)
    clips = []
    forearms = hand_tilt.ForearmMeans(corpus, tuple(corpus.people))
    for number, (name, person) in enumerate(zip(corpus.clips, corpus.clip_people, strict=True)):
        # Keyed by person and clip, so that a selection of clips sees the same trackers as the whole corpus.
        wearer = draw_wearer(config.trackers, NormalNumbers(config.seed ^ zlib.crc32(person.encode())))
        random = NormalNumbers(config.seed ^ zlib.crc32(name.encode()))
        frames = corpus.clip_slice(number)
        positions, rotations = simulate(
            corpus.positions[frames], corpus.rotations[frames], wearer, config.trackers, random
        )
        tracked = np.concatenate([positions, rotations], axis=-1).reshape(len(positions), -1)
        legs = (
            np.full((len(positions), len(LEG_JOINTS), 3), np.nan, np.float32)
            if corpus.legs is None
            else corpus.legs[frames]
        )
        truth = np.concatenate([corpus.positions[frames], legs], axis=1).reshape(len(positions), -1)
        # What arms ahead would have measured: by the person's other clips, with one error for all of them.
        error = np.random.default_rng([config.seed, 2, zlib.crc32(person.encode())])
        tilts = measured_tilts(forearms.elsewhere(number), wearer.hand_turns, config.trackers, error)
        file = f"{number:04d}.f32"
        (config.out / file).write_bytes(np.concatenate([tracked, truth], axis=1).astype("<f4").tobytes())
        clips.append(
            {"name": name, "person": person, "file": file, "frames": len(positions), "handTilts": _as_calibrated(tilts)}
        )
    index = {
        "version": VERSION,
        "rateHz": corpus.rate_hz,
        "corpusHash": corpus.corpus_hash,
        "seed": config.seed,
        "trackers": asdict(config.trackers),
        "columns": COLUMNS,
        "joints": JOINTS,
        "people": {name: _measures(corpus, name, config.seed) for name in corpus.people},
        "clips": clips,
        "problems": corpus.problems,
    }
    path = config.out / "index.json"
    path.write_text(json.dumps(index, ensure_ascii=False, indent=1))
    return path


def _measures(corpus: PreparedCorpus, name: str, seed: int) -> dict[str, float]:
    """Returns a person's measurements [m]; the forearm has the error of a typed value."""
    person = corpus.people[name]
    error = np.random.default_rng([seed, 3, zlib.crc32(name.encode())]).normal() * FOREARM_ERROR
    return {"eyeHeight": person.eye_height, "armSpan": person.arm_span, "forearm": corpus.forearm(name) + error}


def _as_calibrated(tilts: Array) -> dict[str, dict[str, float]]:
    """Converts tilts [2, 2] to the page's calibration, without implausible ones."""
    sides = zip(("left", "right"), tilts.tolist(), hand_tilt.plausible(tilts), strict=True)
    return {side: {"pitch": pitch, "yaw": yaw} for side, (pitch, yaw), known in sides if known}


def main(config: RecordingsConfig) -> Path:
    """Prepares the motion and writes its recordings."""
    return write(prepare.main(config.prepare, lambda name: print(f"  {name}", file=sys.stderr)), config)


def _arguments() -> RecordingsConfig:
    parser = argparse.ArgumentParser(description="Mocap files to recordings with their truth, for the evaluation.")
    parser.add_argument("--mocap", type=Path, required=True)
    parser.add_argument("--skeleton", type=Path)
    parser.add_argument("--people", help="only these, separated by commas; naming people of the lockbox is logged")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--cache", type=Path)
    parser.add_argument("--seed", type=int, default=RecordingsConfig.seed)
    given = parser.parse_args()
    people = tuple(given.people.split(",")) if given.people else None
    return RecordingsConfig(
        prepare=prepare.PrepareConfig(
            given.mocap, given.skeleton, people, given.cache, LockboxAccess("npm run tool -- evaluate")
        ),
        out=given.out,
        seed=given.seed,
    )


if __name__ == "__main__":
    try:
        main(_arguments())
    except MocapError as error:
        sys.exit(f"{error}")
