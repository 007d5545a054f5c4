"""Reads files of motion by the page's reader, of any humanoid skeleton: ASF/AMC, BVH and VRM Animations."""

import json
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import quaternion
from .arrays import Array
from .motion_files import MocapError, Source
from .prepared_corpus import JOINTS, LEG_JOINTS, ROTATIONS
from .shared_constants import REPOSITORY

_READER = "scripts/motion/read-files.ts"


@dataclass(frozen=True)
class Clip:
    """
    A motion in our joints, floor frame [m], at its file's rate [Hz]: positions [frames, joints, 3], rotations of head
    and hands [frames, 3, 4], legs [frames, 8, 3] (NaN: not in the file), the rest pose by joint, and what was assumed,
    a sentence each.
    """

    positions: Array
    rotations: Array
    legs: Array
    rest: dict[str, Array]
    rate: float
    notes: tuple[str, ...] = ()


def read_motion(
    sources: Sequence[Source], skeleton_map: Path | None, rates: dict[str, float]
) -> Iterator[tuple[Source, Clip | str]]:
    """Each file with its clip, or with a sentence where it is refused.

    rates: frame rates [Hz] from `index_rates`. A faulty map raises MocapError.
    """
    node = os.environ.get("npm_node_execpath") or shutil.which("node")
    if node is None:
        raise MocapError("Node.js is needed to read files of motion, and there is none on the PATH")
    command = [node, "-C", "source", "--import", "tsx", _READER]
    with tempfile.TemporaryDirectory() as out, tempfile.TemporaryFile("w+") as errors:
        request = {
            "files": [
                {
                    "path": str(source.path.resolve()),
                    "asf": str(source.asf.resolve()) if source.asf else None,
                    "rateHz": _indexed_rate(source.path, rates),
                }
                for source in sources
            ],
            "map": str(skeleton_map.resolve()) if skeleton_map else None,
            "out": out,
        }
        pipe = subprocess.PIPE
        with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=errors, text=True, cwd=REPOSITORY) as reader:
            assert reader.stdin and reader.stdout
            json.dump(request, reader.stdin)
            reader.stdin.close()
            for number, (source, line) in enumerate(zip(sources, reader.stdout, strict=False)):
                yield source, _clip(Path(out), number, json.loads(line))
        if reader.returncode != 0:
            errors.seek(0)
            raise MocapError(errors.read().strip() or f"the reader of motion files ended with {reader.returncode}")


def _indexed_rate(path: Path, rates: dict[str, float]) -> float | None:
    match = re.fullmatch(r"0*(\d+)_0*(\d+)", path.stem)
    return rates.get(f"{match[1]}_{match[2]}") if match else None


def _clip(out: Path, number: int, found: dict[str, object]) -> Clip | str:
    if "refused" in found:
        return str(found["refused"])
    positions = np.fromfile(out / f"{number}.positions").reshape(-1, len(JOINTS) + len(LEG_JOINTS), 3)
    rotations = np.fromfile(out / f"{number}.rotations").reshape(len(positions), -1, 4)
    rest, notes = found["rest"], found["notes"]
    assert isinstance(rest, dict)
    assert isinstance(notes, list)
    return Clip(
        positions=positions[:, : len(JOINTS)],
        rotations=np.stack([quaternion.continuous(rotations[:, i]) for i in range(len(ROTATIONS))], axis=1),
        legs=positions[:, len(JOINTS) :],
        rest={joint: np.array(at) for joint, at in rest.items()},
        rate=float(str(found["rateHz"])),
        notes=tuple(map(str, notes)),
    )
