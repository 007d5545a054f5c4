"""Facts about skeletons of other programs: lost bones are put back, a rest that is no T-pose is refused or mapped,
links are followed.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from threepoint_training import prepare, quaternion
from threepoint_training.motion_files import MocapError
from threepoint_training.prepared_corpus import JOINTS, LEG_JOINTS, PreparedCorpus
from threepoint_training.synthetic_skeletons import (
    IDENTITY,
    along,
    angles_of,
    game_bvh,
    write_asf_amc,
    write_cmuconvert_bvh,
)

X, Y, Z = np.eye(3)


def prepared(folder: Path, skeleton: Path | None = None) -> PreparedCorpus:
    return prepare.main(prepare.PrepareConfig(folder, skeleton))


def folder(parent: Path, name: str) -> Path:
    path = parent / name
    path.mkdir(parents=True)
    return path


def furthest(a: PreparedCorpus, b: PreparedCorpus, joint: str) -> float:
    column = JOINTS.index(joint)
    return float(np.linalg.norm(a.positions[:, column] - b.positions[:, column], axis=-1).max())


def test_a_bvh_of_cmuconvert_has_the_joints_of_its_original(tmp_path: Path) -> None:
    angles = angles_of(1, 120)
    original = folder(tmp_path, "asf")
    write_asf_amc(original, angles)
    for file, name in (("p.asf", "02.asf"), ("p_01.amc", "02_01.amc")):
        (original / file).rename(original / name)
    converted = folder(tmp_path, "bvh")
    write_cmuconvert_bvh(converted / "02_01.bvh", angles)
    a, b = prepared(original), prepared(converted)
    # Lost: 11 cm of the trunk and 10 cm of the forearm. The thorax is an estimate, which this skeleton is near to;
    # nothing else is.
    for joint in ("head", "neck", "leftUpperArm", "rightLowerArm", "leftHand", "rightHand"):
        assert furthest(a, b, joint) < 0.005, joint
    for joint in ("hips", "spine", "chest"):
        assert furthest(a, b, joint) < 1e-5, joint
    for side in ("left", "right"):
        wrist, elbow = JOINTS.index(f"{side}Hand"), JOINTS.index(f"{side}LowerArm")
        forearms = [corpus.positions[:, wrist] - corpus.positions[:, elbow] for corpus in (a, b)]
        np.testing.assert_allclose(*forearms, atol=1e-5)
    assert np.abs(np.sum(a.rotations * b.rotations, axis=-1)).min() > 1 - 1e-6
    assert [problem.split(":")[0] for problem in b.problems] == ["02_01.bvh"] * 4
    assert "lost the thorax bone; it is put back" in b.problems[0]


def yaw(degrees: float) -> np.ndarray:
    return quaternion.from_axis_angle(Y, np.array(np.radians(degrees)))


def moving(frames: int = 60) -> tuple[list[dict[str, np.ndarray]], list[np.ndarray]]:
    """Walks in a T-pose that faces 40° to the left of +Z, then turns head, an arm and a hand and bends."""
    turns, hips = [], []
    for frame in range(frames):
        share = frame / (frames - 1)
        body = yaw(40)
        bend = quaternion.multiply(body, quaternion.from_axis_angle(X, np.array(0.5 * share)))
        arm = quaternion.multiply(bend, quaternion.from_axis_angle(Z, np.array(-1.1 * share)))
        hand = quaternion.multiply(arm, quaternion.from_axis_angle(X, np.array(0.8 * share)))
        turns.append(
            {
                "Hips": body,
                "Spine": bend,
                "Head": quaternion.multiply(bend, yaw(30 * share)),
                "LeftArm": arm,
                "LeftHand": hand,
            }
        )
        hips.append(np.array([20 * share, 93.0, 50 * share]))
    return turns, hips


def write_map(path: Path, **entries: object) -> Path:
    names = {"hips": "Hips", "spine": "Spine", "chest": "Spine1", "neck": "Neck", "head": "Head"}
    for side in ("Left", "Right"):
        theirs = {
            "UpperArm": "Arm",
            "LowerArm": "ForeArm",
            "Hand": "Hand",
            "UpperLeg": "UpLeg",
            "LowerLeg": "Leg",
            "Foot": "Foot",
            "Toes": "Toe",
        }
        names |= {f"{side.lower()}{ours}": f"{side}{name}" for ours, name in theirs.items()}
    path.write_text(json.dumps({"joints": names, **entries}))
    return path


def people_folded(parent: Path, axes: dict[str, np.ndarray]) -> dict[str, list[float]]:
    """Writes the same motion by skeletons that are folded along these axes, for each a person of that name; returns the
    last one's angles in T-pose.
    """
    for name, axis in axes.items():
        text, t_pose = game_bvh(along(axis), *moving())
        (folder(parent, name) / f"{name}.bvh").write_text(text)
    return t_pose


def write_plain(parent: Path) -> None:
    rest = {name: IDENTITY for name in along(X)}
    (folder(parent, "plain") / "plain.bvh").write_text(game_bvh(rest, *moving())[0])


def frames_by_person(corpus: PreparedCorpus) -> dict[str, slice]:
    return {person: corpus.clip_slice(clip) for clip, person in enumerate(corpus.clip_people)}


def test_a_skeleton_folded_along_an_axis_is_read_as_the_plain_one(tmp_path: Path) -> None:
    write_plain(tmp_path)
    people_folded(tmp_path, {"x": X, "y": Y, "down": -Y, "z": Z})
    corpus = prepared(tmp_path)
    frames = frames_by_person(corpus)
    for name in ("x", "y", "down", "z"):
        np.testing.assert_allclose(
            corpus.positions[frames[name]], corpus.positions[frames["plain"]], atol=1e-5, err_msg=name
        )
    assert "not a T-pose" in corpus.problems[0]


def test_one_bad_file_does_not_end_the_reading_of_the_others(tmp_path: Path) -> None:
    text = game_bvh({name: IDENTITY for name in along(X)}, *moving())[0]
    (tmp_path / "a_1.bvh").write_text(text.replace("26.000000000", "26,0 x"))
    (tmp_path / "b_1.bvh").write_text(text)
    corpus = prepared(tmp_path)
    assert sorted(corpus.people) == ["b"]
    assert corpus.problems[0].startswith("a_1.bvh: line ")


def test_a_map_with_the_t_pose_reads_a_folded_skeleton(tmp_path: Path) -> None:
    write_plain(tmp_path / "plain")
    expected = prepared(tmp_path / "plain")
    people_folded(tmp_path / "folded", {"x": X, "down": -Y})
    t_pose = people_folded(tmp_path / "z", {"z": Z})
    (tmp_path / "t-pose.bvh").write_text((tmp_path / "z/z/z.bvh").read_text())
    # The first frame is a T-pose that stands turned and elsewhere.
    for people, entry in (
        ("folded", {"restFrame": 1}),
        ("z", {"restPose": t_pose}),
        ("z", {"restFrame": {"file": "t-pose.bvh", "frame": 1}}),
    ):
        corpus = prepared(tmp_path / people, write_map(tmp_path / "map.json", **entry))
        for name, frames in frames_by_person(corpus).items():
            np.testing.assert_allclose(corpus.positions[frames], expected.positions, atol=1e-5)
            np.testing.assert_allclose(corpus.legs[frames], expected.legs, atol=1e-5)
            assert np.abs(np.sum(corpus.rotations[frames] * expected.rotations, axis=-1)).min() > 1 - 1e-6
            eyes = expected.people["plain"].eye_height
            assert corpus.people[name].eye_height == pytest.approx(eyes, abs=1e-6)


@pytest.mark.parametrize(
    ("entry", "sentence"),
    [
        ({"unit": 3}, "map.json: “unit” is not known"),
        ({"restFrame": {"file": "none.bvh"}}, "map.json: ENOENT: no such file"),
        ({"restFrame": 61}, "nothing could be read:\nwalk.bvh: restFrame 61, but there are 60 frames"),
    ],
)
def test_a_faulty_map_is_refused(tmp_path: Path, entry: dict[str, object], sentence: str) -> None:
    own = folder(tmp_path, "p")
    (own / "walk.bvh").write_text(game_bvh(along(X), *moving())[0])
    with pytest.raises(MocapError) as error:
        prepared(tmp_path, write_map(tmp_path / "map.json", **entry))
    assert str(error.value).startswith(sentence)


def test_a_table_of_frame_rates_goes_before_those_of_the_database(tmp_path: Path) -> None:
    write_asf_amc(tmp_path, angles_of(1, 120))
    for file, name in (("p.asf", "02.asf"), ("p_01.amc", "02_01.amc")):
        (tmp_path / file).rename(tmp_path / name)
    assert len(prepared(tmp_path).positions) == 60
    (tmp_path / "index.csv").write_text("Subject,Trial #,framerate\n2,1,60\n")
    assert len(prepared(tmp_path).positions) == 120


def test_folders_that_are_links_are_followed_and_no_one_is_two_people(tmp_path: Path) -> None:
    text = game_bvh({name: IDENTITY for name in along(X)}, *moving())[0]
    elsewhere = folder(tmp_path, "elsewhere")
    (elsewhere / "walk.bvh").write_text(text)
    mocap = folder(tmp_path, "mocap")
    (folder(mocap, "anna") / "walk.bvh").write_text(text)
    (mocap / "bert").symlink_to(elsewhere)
    (mocap / "copy-of-anna").symlink_to(mocap / "anna")
    (mocap / "anna" / "round").symlink_to(mocap)
    (mocap / "gone").symlink_to(tmp_path / "nowhere")
    assert sorted(prepared(mocap).people) == ["anna", "bert"]


def test_legs_are_kept_as_truth_in_the_same_floor_frame(tmp_path: Path) -> None:
    turns, hips = moving()
    (folder(tmp_path, "p") / "walk.bvh").write_text(game_bvh({name: IDENTITY for name in along(X)}, turns, hips)[0])
    corpus = prepared(tmp_path)
    assert corpus.legs is not None
    foot, hip = (corpus.legs[:, LEG_JOINTS.index(joint)] for joint in ("leftFoot", "leftUpperLeg"))
    np.testing.assert_allclose(hip[:, 1] - foot[:, 1], 0.85, atol=1e-5)
    np.testing.assert_allclose(corpus.positions[:, JOINTS.index("hips"), 1] - foot[:, 1], 0.89, atol=1e-5)


def test_a_forearm_without_length_is_refused(tmp_path: Path) -> None:
    text = game_bvh({name: IDENTITY for name in along(X)}, *moving())[0]
    (folder(tmp_path, "p") / "walk.bvh").write_text(
        text.replace("OFFSET 26.000000000 0.000000000 0.000000000", "OFFSET 0 0 0")
    )
    with pytest.raises(
        MocapError, match=r"walk.bvh: LeftHand \(leftHand\) lies on LeftForeArm \(leftLowerArm\) in the rest pose"
    ):
        prepared(tmp_path)
