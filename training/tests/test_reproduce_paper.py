"""The reproduction of the paper: stages that are kept, samples that the options make, and input that is refused."""

import json
from dataclasses import replace

import numpy as np
import pytest

pytestmark = pytest.mark.training


@pytest.fixture(scope="module")
def corpus():
    from threepoint_training.generated_motion import generate_corpus

    return generate_corpus(people=5, clips=2, frames=200, seed=3)


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    from threepoint_training.reproduce_paper import ReproductionConfig

    return ReproductionConfig(out=tmp_path_factory.mktemp("paper"), epochs=1, stages=("ik", "page", "six"))


@pytest.fixture(scope="module")
def folder(corpus, config):
    """The stages of a whole run."""
    from threepoint_training import reproduce_paper

    return reproduce_paper.main(corpus, config, lambda _: None)


def figures(folder, name):
    return json.loads((folder / f"{name}.json").read_text())["figures"]


def run_again(corpus, config):
    from threepoint_training import reproduce_paper

    printed = []
    reproduce_paper.main(corpus, config, printed.append)
    return printed


def test_a_reading_has_the_figures_of_the_papers_tables(folder):
    page = figures(folder, "page")
    assert page["parameters"] == pytest.approx(1.58e6, rel=0.005)
    assert page["train"]["frames"] == 4 * page["test"]["frames"]
    assert len(page["lastEpoch"]["loss"]) == page["iterations"]
    for side in ("train", "test"):
        squares = page[side]["mseCm2"]
        assert set(squares) == {"j4", "j5", "j6", "j7", "j8", "j9"}
        # By Jensen's inequality, with three coordinates a joint.
        assert page[side]["mpjpeCm"] < np.sqrt(3 * np.mean(list(squares.values())))
        assert page[side]["rightShoulderMaeCm"] < np.sqrt(squares["j7"])


def test_ik_is_measured_on_the_same_joints(folder):
    assert 0.5 < figures(folder, "ik")["test"]["mpjpeCm"] < 20
    assert figures(folder, "ik")["test"]["frames"] == figures(folder, "page")["test"]["frames"]


def test_a_finished_stage_is_not_run_again_and_a_missing_one_is(corpus, config, folder):
    before = (folder / "page.json").stat().st_mtime_ns
    (folder / "six.json").unlink()
    printed = run_again(corpus, config)
    assert printed[-3:-1] == ["ik: finished before", "page: finished before"]
    assert printed[-1].startswith("six: MPJPE")
    assert (folder / "page.json").stat().st_mtime_ns == before


def test_a_damaged_stage_gets_a_sentence_and_is_run_again(corpus, config, folder):
    whole = (folder / "ik.json").read_text()
    (folder / "ik.json").write_text(whole[: len(whole) // 2])
    printed = run_again(corpus, replace(config, stages=("ik",)))
    assert f"{folder / 'ik.json'} is damaged. This stage is measured again." in printed
    assert (folder / "ik.json").read_text() == whole


def test_other_options_run_a_stage_again(corpus, config, folder, tmp_path):
    from threepoint_training.stage_files import read_stage

    options = json.loads((folder / "page.json").read_text())["options"]
    assert read_stage(folder / "page.json", options) is not None
    assert read_stage(folder / "page.json", options | {"seed": 1}) is None
    assert read_stage(tmp_path / "page.json", None) is None


def test_missing_people_get_a_sentence_and_lose_no_other_stage(corpus, config, tmp_path):
    # No one of fold B's people is in the motion.
    keep = [clip for clip, person in enumerate(corpus.clip_people) if person not in ("002", "014", "127")]
    frames = np.concatenate([np.arange(*corpus.clip_starts[clip : clip + 2]) for clip in keep])
    lengths = [int(np.diff(corpus.clip_starts)[clip]) for clip in keep]
    others = replace(
        corpus,
        positions=corpus.positions[frames],
        rotations=corpus.rotations[frames],
        clips=tuple(corpus.clips[clip] for clip in keep),
        clip_people=tuple(corpus.clip_people[clip] for clip in keep),
        clip_starts=np.concatenate([[0], np.cumsum(lengths)]),
        people={name: person for name, person in corpus.people.items() if name in set(corpus.clip_people) - {"002"}},
    )
    printed = run_again(others, replace(config, out=tmp_path, stages=("held-out", "ik")))
    assert printed[0].startswith("The page's network was also trained on people that are missing here: 002")
    assert printed[1] == "held-out is left out: it needs 014, 127, 002 and others besides them"
    assert printed[2].startswith("ik: MPJPE")


def test_an_unknown_stage_is_refused_with_the_names(corpus, config):
    from threepoint_training.motion_files import MocapError

    with pytest.raises(MocapError, match="no stage table-9; there are ik, held-out, page"):
        run_again(corpus, replace(config, stages=("table-9",)))


def test_similar_poses_are_left_out_until_a_share_remains(corpus):
    from threepoint_training.train_paper import PaperInputs, frames_of

    people = ("002", "003")
    every, filtered = (frames_of(corpus, people, 1, PaperInputs(share_kept=share)) for share in (1.0, 0.3))
    assert len(filtered.inputs) / len(every.inputs) == pytest.approx(0.3, abs=0.05)

    def steps(frames):
        same = np.diff(frames.clips) == 0
        return np.linalg.norm(np.diff(frames.targets, axis=0)[same].reshape(-1, 6, 3), axis=-1).max(axis=-1)

    assert np.median(steps(filtered)) > 1.5 * np.median(steps(every))


def test_axes_of_the_heading_do_not_change_when_a_person_turns(corpus):
    from threepoint_training import quaternion
    from threepoint_training.train_paper import PaperInputs, frames_of

    turn = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array(1.2))
    turned = replace(
        corpus,
        positions=quaternion.rotate(np.broadcast_to(turn, (*corpus.positions.shape[:2], 4)), corpus.positions).astype(np.float32),
        rotations=quaternion.multiply(np.broadcast_to(turn, corpus.rotations.shape), corpus.rotations).astype(np.float32),
    )  # fmt: skip
    for axes, same in (("heading", True), ("room", False)):
        options = PaperInputs(points="joints", axes=axes)
        here, there = (frames_of(motion, ("002",), 1, options) for motion in (corpus, turned))
        assert (np.abs(here.targets - there.targets).max() < 1e-4) == same
        assert (np.abs(here.inputs[:, 0] - there.inputs[:, 0]).max() < 1e-4) == same


def test_hands_relative_to_the_forearm_change_their_angles_alone(corpus):
    from threepoint_training.train_paper import PaperInputs, frames_of

    room, parent = (
        frames_of(corpus, ("002",), 1, PaperInputs(points="joints", axes="room", hands=hands))
        for hands in ("axes", "parent")
    )
    np.testing.assert_array_equal(room.inputs[:, :, :, 0], parent.inputs[:, :, :, 0])
    np.testing.assert_array_equal(room.inputs[:, 0], parent.inputs[:, 0])
    assert np.abs(room.inputs[:, 1, :, 1:] - parent.inputs[:, 1, :, 1:]).max() > 0.1


@pytest.mark.parametrize(("networks", "filters", "width"), [(1, 32, 2304), (6, 32, 256), (18, 16, 192)])
def test_readings_of_22_megabytes_have_them(networks, filters, width):
    from threepoint_training.model import PaperShape, RepeatedPaperNetwork

    network = RepeatedPaperNetwork(PaperShape(networks, filters, width))
    assert 4 * sum(p.numel() for p in network.parameters()) / 2**20 == pytest.approx(22, abs=0.5)


def test_the_page_has_a_label_for_every_reading():
    from threepoint_training.paper_page import LABELS
    from threepoint_training.reproduce_paper import READINGS

    assert list(LABELS) == list(READINGS)
