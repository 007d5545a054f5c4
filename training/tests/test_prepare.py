"""Facts about the prepared corpus, on a person written as BVH here: axes, wrists, rates, teleports, problems."""

import json
from pathlib import Path

import numpy as np
import pytest
from threepoint_training import prepare, quaternion, recordings
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.motion_files import MocapError
from threepoint_training.prepared_corpus import JOINTS, PreparedCorpus


def person_bvh(frames: list[tuple[float, float, float, float]], frame_time: float = 1 / 60) -> str:
    """A person in centimetres, T-pose at rest, facing +Z, left = +X. A frame: the hips' x, y, z [cm] and yaw [degrees].
    """

    def joint(name: str, offset: tuple[float, float, float], *children: str) -> str:
        body = "".join(children) or "End Site\n{\nOFFSET 0 1 0\n}\n"
        return f"JOINT {name}\n{{\nOFFSET {offset[0]} {offset[1]} {offset[2]}\nCHANNELS 3 Zrotation Xrotation Yrotation\n{body}}}\n"

    def arm(side: str, sign: int) -> str:
        hand = joint(f"{side}Hand", (sign * 26, 0, 0))
        return joint(f"{side}Arm", (sign * 18, 0, 0), joint(f"{side}ForeArm", (sign * 28, 0, 0), hand))

    def leg(side: str, sign: int) -> str:
        toes = joint(f"{side}ToeBase", (0, -5, 12))
        foot = joint(f"{side}Foot", (0, -42, 0), toes)
        return joint(f"{side}UpLeg", (sign * 9, -2, 0), joint(f"{side}Leg", (0, -43, 0), foot))

    neck = joint("Neck", (0, 12, 0), joint("Head", (0, 16, 0)))
    spine1 = joint("Spine1", (0, 12, 0), neck, arm("Left", 1), arm("Right", -1))
    trunk = joint("Spine", (0, 11, 0), spine1)
    header = f"HIERARCHY\nROOT Hips\n{{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n{trunk}{leg('Left', 1)}{leg('Right', -1)}}}\n"
    joints = header.count("JOINT")
    rows = [f"{x} {y} {z} 0 0 {yaw} " + " ".join(["0"] * 3 * joints) for x, y, z, yaw in frames]
    return f"{header}MOTION\nFrames: {len(rows)}\nFrame Time: {frame_time}\n" + "\n".join(rows) + "\n"


def corpus_of(folder: Path, **files: str) -> PreparedCorpus:
    for name, text in files.items():
        (folder / f"{name}.bvh").write_text(text)
    return prepare.main(prepare.PrepareConfig(folder))


def joint(corpus: PreparedCorpus, name: str, frame: int = 0) -> np.ndarray:
    return corpus.positions[frame, JOINTS.index(name)].astype(float)


STANDING = [(0.0, 92.0, 0.0, 0.0)] * 60


def test_people_face_minus_z_with_their_left_on_minus_x_in_metres(tmp_path: Path) -> None:
    corpus = corpus_of(tmp_path, p1_walk=person_bvh(STANDING))
    assert joint(corpus, "leftHand")[0] == pytest.approx(-0.72, abs=1e-6)
    assert joint(corpus, "rightHand")[0] == pytest.approx(0.72, abs=1e-6)
    assert joint(corpus, "head")[1] == pytest.approx(1.43, abs=1e-6)
    gaze = quaternion.rotate(corpus.rotations[0, 0].astype(float), np.array([0.0, 0.0, -1.0]))
    np.testing.assert_allclose(gaze, [0, 0, -1], atol=1e-6)


def test_in_t_pose_the_knuckles_point_sideways_and_the_palms_down(tmp_path: Path) -> None:
    corpus = corpus_of(tmp_path, p1_walk=person_bvh(STANDING))
    for index, sideways in ((1, -1.0), (2, 1.0)):
        q = corpus.rotations[0, index].astype(float)
        np.testing.assert_allclose(quaternion.rotate(q, np.array([0.0, 0.0, -1.0])), [sideways, 0, 0], atol=1e-6)
        np.testing.assert_allclose(quaternion.rotate(q, np.array([0.0, 1.0, 0.0])), [0, 1, 0], atol=1e-6)


def test_turning_the_person_turns_the_joints(tmp_path: Path) -> None:
    corpus = corpus_of(tmp_path, p1_turn=person_bvh([(10.0, 92.0, 5.0, 90.0)] * 60))
    # A quarter to the left: the left hand, on −X before, is then behind, on +Z.
    hips = joint(corpus, "hips")
    np.testing.assert_allclose(joint(corpus, "leftHand") - hips, [0, 0.23, 0.72], atol=1e-6)


def test_the_calibration_is_that_of_a_measured_person(tmp_path: Path) -> None:
    person = corpus_of(tmp_path, p1_walk=person_bvh(STANDING)).people["p1"]
    assert person.arm_span == pytest.approx(1.44, abs=1e-6)
    assert 1.45 < person.eye_height < 1.6


def test_other_rates_are_brought_to_60(tmp_path: Path) -> None:
    walk = [(float(i), 92.0, 0.0, 0.0) for i in range(101)]
    corpus = corpus_of(tmp_path, p1_walk=person_bvh(walk, frame_time=1 / 100))
    assert len(corpus.positions) == 61
    # One centimetre a frame at 100 Hz is one metre a second, to the left of a person facing −Z.
    np.testing.assert_allclose(np.diff(corpus.positions[:, 0, 0]), -1 / 60, atol=1e-5)


def test_a_teleport_cuts_the_clip_and_is_reported(tmp_path: Path) -> None:
    jump = [(0.0, 92.0, 0.0, 0.0)] * 60 + [(300.0, 92.0, 0.0, 0.0)] * 60
    corpus = corpus_of(tmp_path, p1_jump=person_bvh(jump))
    assert corpus.clips == ("p1_jump#1", "p1_jump#2")
    assert corpus.problems == ("p1_jump: teleports at frame 61; cut there",)


def test_what_is_too_short_to_be_motion_is_left_out_and_reported(tmp_path: Path) -> None:
    jump = [(0.0, 92.0, 0.0, 0.0)] * 20 + [(300.0, 92.0, 0.0, 0.0)] * 60
    corpus = corpus_of(tmp_path, p1_jump=person_bvh(jump), p1_short=person_bvh(STANDING[:20]))
    assert corpus.clips == ("p1_jump",)
    assert corpus.problems == (
        "p1_jump: teleports at frame 21; cut there",
        "p1_jump: 1 of 2 pieces shorter than 0.5 s; left out",
        "p1_short: shorter than 0.5 s; left out",
    )


def with_head_upside_down(bvh: str, first: int, last: int) -> str:
    """The motion with the head rolled by half a turn from frame `first` to before frame `last`."""
    header, rows = bvh.split("Frame Time: ")
    time, *frames = rows.splitlines()
    # Six numbers of the hips, three of each joint: Spine, Spine1 and Neck precede the head.
    roll = 6 + 3 * 3
    for index in range(first, last):
        numbers = frames[index].split()
        numbers[roll] = "180"
        frames[index] = " ".join(numbers)
    return f"{header}Frame Time: {time}\n" + "\n".join(frames) + "\n"


def test_frames_with_the_head_upside_down_are_left_out_and_reported(tmp_path: Path) -> None:
    bvh = person_bvh([(float(i) / 10, 92.0, 0.0, 0.0) for i in range(150)])
    corpus = corpus_of(tmp_path, p1_ends=with_head_upside_down(bvh, 40, 110), p1_walk=bvh)
    assert corpus.clips == ("p1_ends#1", "p1_ends#2", "p1_walk")
    assert corpus.clip_starts.tolist() == [0, 40, 80, 230]
    assert joint(corpus, "hips", 40)[0] == pytest.approx(-0.11, abs=1e-6)
    assert corpus.problems == ("p1_ends: the head is upside down in 70 of 150 frames; they are left out",)


def test_a_head_that_is_upside_down_throughout_was_turned_at_rest(tmp_path: Path) -> None:
    bvh = person_bvh([(0.0, 92.0, 0.0, 0.0)] * 60)
    corpus = corpus_of(tmp_path, p1_walk=bvh, p1_wrong=with_head_upside_down(bvh, 0, 60))
    assert corpus.clips == ("p1_walk", "p1_wrong")
    plain, wrong = corpus.rotations[:60, 0], corpus.rotations[60:, 0]
    assert np.abs(np.sum(plain * wrong, axis=-1)).min() > 1 - 1e-6
    assert "its rest pose is not a T-pose" in corpus.problems[0]


def test_a_somersault_is_kept(tmp_path: Path) -> None:
    """It turns head and trunk alike."""
    rows = person_bvh(STANDING).splitlines()
    at = next(index for index, row in enumerate(rows) if row.startswith("Frame Time")) + 1
    turned = [" ".join([*row.split()[:3], "0", "180", *row.split()[5:]]) for row in rows[at:]]
    corpus = corpus_of(tmp_path, p1_walk=person_bvh(STANDING * 3), p1_flip="\n".join([*rows[:at], *turned]) + "\n")
    assert corpus.clips == ("p1_flip", "p1_walk")


def test_a_broken_file_is_reported_and_the_rest_is_read(tmp_path: Path) -> None:
    good = person_bvh(STANDING)
    corpus = corpus_of(tmp_path, p1_walk=good, p2_walk=good.replace("MOTION", "MOTTION"))
    assert corpus.clips == ("p1_walk",)
    assert len(corpus.problems) == 1
    assert "p2_walk.bvh: line" in corpus.problems[0]


def test_amc_without_a_skeleton_is_refused(tmp_path: Path) -> None:
    (tmp_path / "take.amc").write_text("1\nroot 0\n")
    with pytest.raises(MocapError, match="nothing could be read:\ntake.amc: no .asf skeleton beside it"):
        prepare.main(prepare.PrepareConfig(tmp_path))


def test_a_map_reads_a_skeleton_with_names_of_its_own(tmp_path: Path) -> None:
    renamed = person_bvh(STANDING).replace("LeftForeArm", "elbow_l").replace("RightForeArm", "elbow_r")
    (tmp_path / "p1_x.bvh").write_text(renamed)
    found = prepare.main(prepare.PrepareConfig(tmp_path))
    names = {"hips": "Hips", "chest": "Spine1", "neck": "Neck", "head": "Head"}
    for side, letter in (("Left", "l"), ("Right", "r")):
        ours = side.lower()
        names |= {f"{ours}UpperArm": f"{side}Arm", f"{ours}LowerArm": f"elbow_{letter}", f"{ours}Hand": f"{side}Hand"}
    path = tmp_path / "map.json"
    path.write_text(json.dumps({"scale": 0.01, "joints": names}))
    corpus = prepare.main(prepare.PrepareConfig(tmp_path, path))
    assert joint(corpus, "leftLowerArm")[0] == pytest.approx(-0.46, abs=1e-6)
    assert joint(found, "leftLowerArm")[0] == pytest.approx(-0.46, abs=1e-6)


def test_recordings_carry_what_was_tracked_beside_the_truth(tmp_path: Path) -> None:
    corpus = corpus_of(tmp_path, p1_walk=person_bvh(STANDING))
    config = recordings.RecordingsConfig(prepare.PrepareConfig(tmp_path), tmp_path / "out")
    recordings.write(corpus, config)
    index = json.loads((tmp_path / "out/index.json").read_text())
    frames = np.fromfile(tmp_path / "out" / index["clips"][0]["file"], "<f4").reshape(-1, len(index["columns"]))
    assert len(frames) == len(corpus.positions)
    column = index["columns"].index("truth.leftHand.x")
    np.testing.assert_allclose(frames[:, column : column + 3], corpus.positions[:, JOINTS.index("leftHand")], atol=1e-6)
    tracked = index["columns"].index("leftHand.px")
    off = np.linalg.norm(frames[:, tracked : tracked + 3] - frames[:, column : column + 3], axis=1)
    # A constant offset of centimetres at most, and noise of a millimetre at most.
    assert off.max() < 0.04
    assert off.std() < 0.001
    first = (tmp_path / "out" / index["clips"][0]["file"]).read_bytes()
    recordings.write(corpus, config)
    assert (tmp_path / "out" / index["clips"][0]["file"]).read_bytes() == first


def test_frames_of_people_are_those_of_their_clips_and_a_stride_begins_anew_in_each():
    corpus = generate_corpus(people=3, clips=2, frames=10, seed=1)
    assert corpus.frames_of({"003"}).tolist() == list(range(20, 40))
    assert corpus.frames_of(("002", "004"), stride=7).tolist() == [0, 7, 10, 17, 40, 47, 50, 57]
    assert corpus.minutes_of({"002", "004"}) == pytest.approx(40 / 60 / 60)
