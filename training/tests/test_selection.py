"""Facts about the figures by which recipes are chosen."""

import numpy as np
import pytest
import torch
from threepoint_training import postures, selection, splits, train_learned
from threepoint_training.features import HANDS, HEAD_AXES, HEADSET_HEIGHT
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.model import CorrectionNetwork
from threepoint_training.recipes import RECIPES
from threepoint_training.selection import PersonErrors

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
    assert postures.active(inputs).tolist() == [False, True, True, True]


def test_a_network_that_corrects_nothing_errs_as_ik_does():
    held_out = train_learned.held_out(CORPUS, tuple(CORPUS.people), (0.0,), selection.CONDITION)
    network = CorrectionNetwork(1, 8, 0.0).eval()
    network.normalise(torch.from_numpy(held_out.inputs), torch.from_numpy(held_out.targets))
    network.shrink(0.0, 0.0)
    by_frames = selection.errors_by_person(network, held_out)
    assert set(by_frames["all"]) == set(CORPUS.people)
    assert sum(each.frames for each in by_frames["active"].values()) == postures.active(held_out.inputs).sum() > 0
    for people in by_frames.values():
        assert all(each.ratio == pytest.approx(1.0, abs=1e-6) for each in people.values())


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
    another = [{name: person(10.0, each.ours.mean() + random.normal(scale=0.5)) for name, each in seed.items()} for seed in one]
    assert selection.compare(another, one)["all people, all joints"].is_tie


def test_no_recipe_trains_on_the_lockbox_or_on_another_laboratory():
    subjects = tuple(sorted({*splits.VARIED, *splits.ADDED, "006", "132", "901"}))
    for recipe in RECIPES.values():
        people = recipe.trained_on(subjects)
        assert people and not splits.in_lockbox(people) and not splits.evaluation_only(people)
    assert RECIPES["old, varied"].trained_on(subjects) == ("002", "003", "005", "014", "016", "017", "127")
    assert not set(RECIPES["old, first"].trained_on(subjects)) & set(splits.ADDED)
    assert set(RECIPES["old, all"].trained_on(subjects)) == set(splits.trainable(subjects))
