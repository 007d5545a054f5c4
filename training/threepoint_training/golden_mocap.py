"""Files of generated people, with what the evaluation makes of them: the page reads them and simulates their trackers alike."""

import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from . import prepare, quaternion, recordings
from .synthetic_skeletons import GAME, IDENTITY, angles_of, game_bvh, write_asf_amc, write_cmuconvert_bvh

# Of every clip; the page is held against every nth frame.
FRAMES, STRIDE = 76, 6


def _turned(text: str) -> str:
    """An AMC text whose root walks and turns."""
    before, *frames = text.split("root 0 16.5 0 0 0 0\n")
    return before + "".join(f"root {0.02 * i + 3:.4f} 16.5 {0.01 * i:.4f} 2 {130 + 0.5 * i:.4f} 3\n{frame}" for i, frame in enumerate(frames))


def _acclaim(folder: Path) -> str:
    write_asf_amc(folder, angles_of(3, FRAMES))
    (folder / "p.asf").rename(folder / "11.asf")
    (folder / "11_07.amc").write_text(_turned((folder / "p_01.amc").read_text()))
    (folder / "p_01.amc").unlink()
    return "11_07.amc"


def _cmuconvert(folder: Path) -> str:
    write_cmuconvert_bvh(folder / "7_02.bvh", angles_of(4, FRAMES))
    return "7_02.bvh"


def _leaping(folder: Path) -> str:
    """At 50 Hz, in centimetres, with a leap between two pieces."""
    times = np.arange(FRAMES) / 50

    def about(axis: int, angle: float) -> Any:
        return quaternion.from_axis_angle(np.eye(3)[axis], np.array(angle))

    turns = [{"Hips": about(1, 2 + 0.6 * t), "LeftArm": about(2, -0.9 * np.sin(3 * t)), "Head": about(0, 0.2 + 0.3 * t)} for t in times]
    hips = [np.array([20 * t + (300 if i >= FRAMES // 2 else 0), 100, 5 * t]) for i, t in enumerate(times)]
    text, _ = game_bvh({name: IDENTITY for name, *_ in GAME}, turns, hips)
    (folder / "someone_walks.bvh").write_text(text.replace("Frame Time: 0.016666667", "Frame Time: 0.02"))
    return "someone_walks.bvh"


def mocap_vectors() -> list[dict[str, Any]]:
    """Files, and every nth frame of the recordings that the evaluation would make of each."""
    cases = []
    for write in (_acclaim, _cmuconvert, _leaping):
        with tempfile.TemporaryDirectory() as name:
            mocap, out = Path(name, "mocap"), Path(name, "out")
            mocap.mkdir()
            motion = write(mocap)
            index = json.loads(recordings.main(recordings.RecordingsConfig(prepare.PrepareConfig(mocap), out)).read_text())
            clips = []
            for clip in index["clips"]:
                rows = np.fromfile(out / clip["file"], "<f4").reshape(clip["frames"], -1)
                person = index["people"][clip["person"]]
                clips.append({"name": clip["name"], "frames": clip["frames"], "calibration": person, "rows": rows[::STRIDE]})
            files = {path.name: path.read_text() for path in sorted(mocap.iterdir())}
            cases.append({"motion": motion, "files": files, "columns": index["columns"], "stride": STRIDE, "clips": clips})
    return cases
