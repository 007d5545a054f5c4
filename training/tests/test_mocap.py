"""Facts about parsers: known rotations give known joints, and bad input gets a sentence that names file and line."""

from pathlib import Path

import numpy as np
import pytest
from threepoint_training import quaternion
from threepoint_training.mocap_asf_amc import parse_amc, parse_asf
from threepoint_training.motion import MocapError

ASF = """:version 1.10
:units
  length 1.0
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name upper
     direction 0 1 0
     length 2
     axis 0 0 30 XYZ
     dof rx rz
  end
  begin
     id 2
     name lower
     direction 1 0 0
     length 3
     axis 0 0 0 XYZ
     dof ry
  end
:hierarchy
  begin
    root upper
    upper lower
  end
"""



def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text)
    return path


def amc(*frames: str) -> str:
    return ":FULLY-SPECIFIED\n:DEGREES\n" + "".join(
        f"{number}\n{frame}\n" for number, frame in enumerate(frames, start=1)
    )


def test_a_bone_turns_about_its_own_axes(tmp_path: Path) -> None:
    skeleton = parse_asf(write(tmp_path, "01.asf", ASF))
    motion = parse_amc(
        write(
            tmp_path,
            "01_01.amc",
            amc("root 1 2 3 0 0 0\nupper 0 0\nlower 0", "root 0 0 0 0 90 0\nupper 0 90\nlower 90"),
        ),
        skeleton,
    )
    at = {name: motion.positions[:, motion.index(name)] for name in ("root", "upper:end", "lower:end")}
    # At rest: two up, three along X.
    np.testing.assert_allclose(at["upper:end"][0], [1, 4, 3], atol=1e-9)
    np.testing.assert_allclose(at["lower:end"][0], [4, 4, 3], atol=1e-9)
    # The root a quarter about Y; upper a quarter about its Z, which its axis leaves where it is: up becomes −X, which
    # the root takes to +Z.
    np.testing.assert_allclose(at["upper:end"][1], [0, 0, 2], atol=1e-9)


def test_rx_is_about_the_bones_tilted_axis(tmp_path: Path) -> None:
    skeleton = parse_asf(write(tmp_path, "01.asf", ASF))
    motion = parse_amc(write(tmp_path, "01_01.amc", amc("root 0 0 0 0 0 0\nupper 180 0\nlower 0")), skeleton)
    axis = np.array([np.cos(np.radians(30)), np.sin(np.radians(30)), 0])
    expected = quaternion.rotate(quaternion.from_axis_angle(axis, np.array(np.pi)), np.array([0.0, 2.0, 0.0]))
    np.testing.assert_allclose(motion.positions[0, motion.index("upper:end")], expected, atol=1e-9)


@pytest.mark.parametrize(
    ("frame", "sentence"),
    [
        ("root 0 0 0 0 0\nupper 0 0\nlower 0", "bad.amc, line 4: root has 5 numbers, its skeleton says 6"),
        ("root 0 0 0 0 0 0\nupper 0 0\nlower x", "bad.amc, line 6: “lower x” has something that is no number"),
        ("root 0 0 0 0 0 0\nelbow 0", "bad.amc, line 5: “elbow” is no bone with freedom in 01.asf"),
        ("root 0 0 0 0 0 0\nupper 0 0", "bad.amc, line 5: frame 1 ends without “lower”"),
        ("root 0 0 0 0 0 0\nupper nan 0\nlower 0", "bad.amc: frame 1 has a number that is not finite"),
    ],
)
def test_bad_motion_names_file_and_line(tmp_path: Path, frame: str, sentence: str) -> None:
    skeleton = parse_asf(write(tmp_path, "01.asf", ASF))
    with pytest.raises(MocapError) as error:
        parse_amc(write(tmp_path, "bad.amc", amc(frame)), skeleton)
    assert str(error.value) == sentence


@pytest.mark.parametrize(
    ("unit", "header", "angle"),
    [
        ("deg", ":DEGREES", 90.0),
        ("rad", ":RADIANS", np.pi / 2),
        ("deg", ":RADIANS", np.pi / 2),
        ("rad", ":degrees", 90.0),
        ("rad", "", np.pi / 2),
        ("Degrees", "", 90.0),
    ],
)
def test_angles_are_in_the_unit_that_the_motion_says_else_in_the_skeletons(
    tmp_path: Path, unit: str, header: str, angle: float
) -> None:
    tilt = np.pi / 6 if unit == "rad" else 30
    skeleton = parse_asf(
        write(tmp_path, "01.asf", ASF.replace("angle deg", f"angle {unit}").replace("axis 0 0 30", f"axis 0 0 {tilt}"))
    )
    frame = f"root 0 0 0 0 0 0\nupper {angle} 0\nlower 0"
    motion = parse_amc(write(tmp_path, "01_01.amc", amc(frame).replace(":DEGREES", header)), skeleton)
    expected = [np.sqrt(3) / 2, 0.5, np.sqrt(3)]
    np.testing.assert_allclose(motion.positions[0, motion.index("upper:end")], expected, atol=1e-9)


@pytest.mark.parametrize(
    ("unit", "sentence"),
    [
        ("angle grad", "01.asf, line 4: angles are in deg or rad, not in “grad”"),
        ("angle", "01.asf, line 4: angle should have a unit, deg or rad"),
    ],
)
def test_angles_of_another_unit_are_refused(tmp_path: Path, unit: str, sentence: str) -> None:
    with pytest.raises(MocapError) as error:
        parse_asf(write(tmp_path, "01.asf", ASF.replace("angle deg", unit)))
    assert str(error.value) == sentence


def test_a_skeleton_without_bones_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MocapError, match="no :bonedata with bones"):
        parse_asf(write(tmp_path, "empty.asf", ":version 1.10\n"))
