"""Facts about the figures by which recipes are chosen."""

import io
from dataclasses import replace

import numpy as np
import pytest
import torch
from rich.console import Console
from threepoint_training import pipeline, selection, train_learned
from threepoint_training.features import HANDS, HEAD_AXES, HEADSET_HEIGHT
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.model import CorrectionNetwork
from threepoint_training.selection import PersonErrors
from threepoint_training.train_paper import predict
from threepoint_training.training_config import TrainConfig

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=2, clips=1, frames=120, seed=8)


def person(of_ik: float, ours: float, elbows: float | None = None) -> PersonErrors:
    joints = np.full(6, ours)
    joints[:2] = ours if elbows is None else elbows
    return PersonErrors(100, np.full(6, of_ik), joints)


def test_a_raised_wrist_a_low_head_and_a_tilted_head_are_active_and_a_still_person_is_not():
    inputs = train_learned.held_out(CORPUS, ("002",), (0.0,)).inputs[:1].repeat(4, axis=0)
    heights = [hand.start + 1 for hand in HANDS]
    inputs[:, heights], inputs[:, HEADSET_HEIGHT], inputs[:, HEAD_AXES.start + 4] = -0.9, 1.0, 1.0
    inputs[1, heights[1]] = -0.7
    inputs[2, HEADSET_HEIGHT] = 0.89
    inputs[3, HEAD_AXES.start + 4] = np.cos(np.radians(31))
    assert selection.active(inputs).tolist() == [False, True, True, True]


def test_a_network_that_corrects_nothing_errs_as_ik_does():
    held_out = train_learned.held_out(CORPUS, tuple(CORPUS.people), (0.0,), hands_measured=False)
    network = CorrectionNetwork(1, 8, 0.0).eval()
    network.normalise(torch.from_numpy(held_out.inputs), torch.from_numpy(held_out.targets))
    for name in ("trunk_output_mean", "trunk_output_scale", "arm_output_mean", "arm_output_scale"):
        getattr(network, name).zero_()
    by_frames = selection.errors_by_person(predict(network, held_out.inputs), held_out)
    assert set(by_frames["all"]) == set(CORPUS.people)
    assert sum(each.frames for each in by_frames["active"].values()) == selection.active(held_out.inputs).sum() > 0
    for people in by_frames.values():
        assert all(each.ratio == pytest.approx(1.0, abs=1e-6) for each in people.values())


def test_an_upside_down_head_has_iks_error_whatever_the_network_corrects():
    held_out = train_learned.held_out(CORPUS, ("002",), (0.0,), hands_measured=False)
    corrections = np.full((len(held_out.inputs), 18), 0.05, np.float32)
    upright, of_ik = train_learned.fitted_errors_cm(corrections, held_out), train_learned.ik_errors_cm(held_out)
    assert np.abs(upright - of_ik).mean() > 1
    held_out.inputs[:, HEAD_AXES.start + 4] = -1
    np.testing.assert_array_equal(
        train_learned.fitted_errors_cm(corrections, held_out), train_learned.ik_errors_cm(held_out)
    )


def test_the_worse_half_is_of_those_for_whom_the_network_does_least():
    people = {"a": person(10.0, 9.0), "b": person(4.0, 2.0), "c": person(5.0, 5.5), "d": person(8.0, 6.0)}
    assert selection.worse_half(people) == ("a", "c")
    found = selection.figures(people)
    assert found["all people, all joints"] == pytest.approx((9 + 2 + 5.5 + 6) / 27)
    assert found["worse half, all joints"] == pytest.approx(14.5 / 15)


def test_elbows_are_counted_by_themselves():
    people = {"a": person(10.0, 9.0, elbows=5.0), "b": person(10.0, 9.0, elbows=7.0)}
    assert selection.figures(people)["all people, elbows"] == pytest.approx(0.6)


def test_a_constant_gain_of_every_person_and_seed_is_no_tie_and_noise_is_one():
    random = np.random.default_rng(3)
    names = [str(number) for number in range(12)]
    one = [{name: person(10.0, 8.0 + random.normal(scale=0.5)) for name in names} for _ in range(3)]
    better = [{name: person(10.0, each.ours.mean() - 0.2) for name, each in seed.items()} for seed in one]
    gain = selection.compare(better, one)["all people, all joints"]
    assert (gain.mean, gain.standard_error) == (pytest.approx(-0.02), pytest.approx(0.0, abs=1e-9))
    assert not gain.is_tie
    another = [
        {name: person(10.0, each.ours.mean() + random.normal(scale=0.5)) for name, each in seed.items()} for seed in one
    ]
    assert selection.compare(another, one)["all people, all joints"].is_tie


def test_everyone_is_judged_by_networks_of_each_seed_that_have_not_seen_them(tmp_path):
    corpus = generate_corpus(people=3, clips=1, frames=60, seed=8)
    recipe = train_learned.TrainLearnedConfig(width=8, batch=32, steps=2)
    reported = []
    found = selection.main(corpus, recipe, selection.SelectionConfig(groups=2, seeds=2), reported.append)
    assert reported == [
        f"held out: {group}; seed {recipe.seed + number}" for group in ("002, 004", "003") for number in (0, 1)
    ]
    assert all(set(seed["all"]) == {"002", "003", "004"} for seed in found)
    network = train_learned.train(corpus, ("002", "004"), recipe)
    held_out = train_learned.held_out(corpus, ("003",), recipe.window_seconds, hands_measured=False)
    own = selection.errors_by_person(predict(network, held_out.inputs), held_out)["all"]["003"]
    np.testing.assert_array_equal(found[0]["all"]["003"].ours, own.ours)
    assert (found[1]["all"]["003"].ours != own.ours).any()
    selection.save(found, tmp_path / "selection/recipe.json")
    assert selection.figures(selection.load(tmp_path / "selection/recipe.json")[1]["all"]) == selection.figures(
        found[1]["all"]
    )


def test_the_command_compares_a_recipe_with_those_judged_before(tmp_path):
    printed = io.StringIO()
    config = TrainConfig(mocap=None, task="selection", groups=2, selections=tmp_path)
    first, second = (
        replace(config, learned=train_learned.TrainLearnedConfig(width=8, batch=32, steps=steps)) for steps in (1, 2)
    )
    pipeline.main(first, Console(quiet=True))
    pipeline.main(second, Console(file=printed, width=300))
    (earlier,) = tmp_path.glob("*-1.json")
    lines = printed.getvalue().splitlines()
    assert sum(line.startswith(f"minus {earlier.stem}, active frames, ") for line in lines) == 4
    assert sum(line.startswith("error relative to IK, ") for line in lines) == 2
    pipeline.main(second, Console(quiet=True))
    assert len(list(tmp_path.glob("*.json"))) == 2
