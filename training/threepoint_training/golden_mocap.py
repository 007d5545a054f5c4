"""Files of generated people, with what the evaluation makes of them: the page reads them and simulates their trackers
alike.
"""

import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from . import prepare, quaternion, recordings
from .synthetic_skeletons import GAME, IDENTITY, along, angles_of, game_bvh, write_asf_amc, write_cmuconvert_bvh

# Frames per clip, and the stride at which the page is compared.
FRAMES, STRIDE = 76, 6


def _turned(text: str) -> str:
    """An AMC text whose root walks and turns."""
    before, *frames = text.split("root 0 16.5 0 0 0 0\n")
    return before + "".join(
        f"root {0.02 * i + 3:.4f} 16.5 {0.01 * i:.4f} 2 {130 + 0.5 * i:.4f} 3\n{frame}"
        for i, frame in enumerate(frames)
    )


def _acclaim(folder: Path) -> str:
    write_asf_amc(folder, angles_of(3, FRAMES))
    (folder / "p.asf").rename(folder / "11.asf")
    (folder / "11_07.amc").write_text(_turned((folder / "p_01.amc").read_text()))
    (folder / "p_01.amc").unlink()
    return "11_07.amc"


def _cmuconvert(folder: Path) -> str:
    write_cmuconvert_bvh(folder / "7_02.bvh", angles_of(4, FRAMES))
    return "7_02.bvh"


def _about(axis: int, angle: float) -> Any:
    return quaternion.from_axis_angle(np.eye(3)[axis], np.array(angle))


def _turning(heading: float, **turned: Any) -> dict[str, Any]:
    """A body with this heading whose joints are turned in its own axes."""
    hips = _about(1, heading)
    return {"Hips": hips} | {name: quaternion.multiply(hips, turn) for name, turn in turned.items()}


def _leaping(folder: Path) -> str:
    """At 50 Hz, in centimetres, with a leap between two pieces."""
    times = np.arange(FRAMES) / 50

    turns = [
        _turning(2 + 0.6 * t, LeftArm=_about(2, -0.9 * np.sin(3 * t)), Head=_about(0, 0.2 + 0.3 * t)) for t in times
    ]
    hips = [np.array([20 * t + (300 if i >= FRAMES // 2 else 0), 100, 5 * t]) for i, t in enumerate(times)]
    text, _ = game_bvh({name: IDENTITY for name, *_ in GAME}, turns, hips)
    (folder / "someone_walks.bvh").write_text(text.replace("Frame Time: 0.016666667", "Frame Time: 0.02"))
    return "someone_walks.bvh"


def _moving(times: Any) -> list[dict[str, Any]]:
    return [
        _turning(0.7 + 0.6 * t, RightArm=_about(2, 0.9 * np.sin(3 * t)), Head=_about(0, 0.2 - 0.3 * t)) for t in times
    ]


def _map(folder: Path, **more: Any) -> None:
    joints = {"hips": "Hips", "spine": "Spine", "chest": "Spine1", "neck": "Neck", "head": "Head"}
    for side in ("left", "right"):
        theirs = side.capitalize()
        joints |= {
            f"{side}UpperArm": f"{theirs}Arm",
            f"{side}LowerArm": f"{theirs}ForeArm",
            f"{side}Hand": f"{theirs}Hand",
        }
        joints |= {
            f"{side}UpperLeg": f"{theirs}UpLeg",
            f"{side}LowerLeg": f"{theirs}Leg",
            f"{side}Foot": f"{theirs}Foot",
            f"{side}Toes": f"{theirs}Toe",
        }
    (folder / "map.json").write_text(
        json.dumps({"joints": {ours: f"bip_{name}" for ours, name in joints.items()}, **more})
    )


def _foreign(text: str) -> str:
    return text.replace("ROOT ", "ROOT bip_").replace("JOINT ", "JOINT bip_")


def _folded(folder: Path) -> str:
    """All bones along one axis at angles of 0, names of another program: the map gives the angles of the T-pose."""
    times = np.arange(FRAMES) / 60
    hips = [np.array([20 * t, 100, 5 * t]) for t in times]
    text, rest = game_bvh(along(np.eye(3)[0]), _moving(times), hips)
    (folder / "folded_1.bvh").write_text(_foreign(text))
    _map(folder, restPose={f"bip_{name}": angles for name, angles in rest.items()})
    return "folded_1.bvh"


def _sideways(folder: Path) -> str:
    """+Z up, facing +X, in T-pose in its first frame alone, turned there."""
    times = np.arange(FRAMES) / 60
    turned = {"Hips": _about(1, 1.1)}
    hips = [np.array([20 * t, 100, 5 * t]) for t in times]
    text, _ = game_bvh(along(np.eye(3)[0]), [turned, *_moving(times)[1:]], hips)
    # x to y, y to z, z to x.
    lines = []
    for line in _foreign(text).splitlines():
        words = line.split()
        if words[:1] == ["OFFSET"]:
            line = f"OFFSET {words[3]} {words[1]} {words[2]}"
        elif words[:1] == ["CHANNELS"]:
            line = " ".join([*words[:2], *("YZX"["XYZ".index(word[0])] + word[1:] for word in words[2:])])
        lines.append(line)
    (folder / "sideways_1.bvh").write_text("\n".join(lines) + "\n")
    _map(folder, up="+z", forward="+x", restFrame=1, scale=0.01)
    return "sideways_1.bvh"


def mocap_vectors() -> list[dict[str, Any]]:
    """Files, and every nth frame of the recordings that the evaluation would make of each."""
    cases = []
    for write in (_acclaim, _cmuconvert, _leaping, _folded, _sideways):
        with tempfile.TemporaryDirectory() as name:
            mocap, out = Path(name, "mocap"), Path(name, "out")
            mocap.mkdir()
            motion = write(mocap)
            skeleton = mocap / "map.json"
            config = prepare.PrepareConfig(mocap, skeleton if skeleton.exists() else None)
            index = json.loads(recordings.main(recordings.RecordingsConfig(config, out)).read_text())
            clips = []
            for clip in index["clips"]:
                rows = np.fromfile(out / clip["file"], "<f4").reshape(clip["frames"], -1)
                person = index["people"][clip["person"]]
                clips.append(
                    {"name": clip["name"], "frames": clip["frames"], "calibration": person, "rows": rows[::STRIDE]}
                )
            files = {path.name: path.read_text() for path in sorted(mocap.iterdir())}
            cases.append(
                {"motion": motion, "files": files, "columns": index["columns"], "stride": STRIDE, "clips": clips}
            )
    return cases
