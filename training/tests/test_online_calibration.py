"""Tests of the estimation of calibration errors from minutes of motion."""

from dataclasses import replace

import pytest
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.shared_constants import HEADSET_RISE
from threepoint_training.online_calibration import FAULTS, OnlineCalibrationConfig, main, usual_reach
from threepoint_training.training_config import TrainConfig, quick

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=1, clips=1, frames=1200, seed=5)
CONFIG = OnlineCalibrationConfig(fewest_minutes=0.1, groups=2)


def test_the_usual_reach_is_that_of_people_who_are_worn_long_enough():
    names = tuple(CORPUS.people)
    assert 0.8 < usual_reach(CORPUS, names, CONFIG) < 1.05
    assert usual_reach(CORPUS, names, replace(CONFIG, fewest_minutes=10.0)) == HEADSET_RISE["usualReach"]


def test_each_person_is_judged_by_what_is_made_of_the_others():
    corpus = generate_corpus(people=3, clips=1, frames=900, seed=5)
    config = quick(TrainConfig(mocap=None))
    asked = []
    rows = main(corpus, replace(config.learned, steps=8), config.ik, CONFIG, asked.append)
    held_out = [people for said, _, people in (each.partition("held out: ") for each in asked) if not said]
    assert sorted(", ".join(held_out).split(", ")) == sorted(corpus.people)
    assert [label for label, *_ in rows] == list(FAULTS)
    # No one is of another laboratory.
    assert all(0 < float(cell) < 50 for row in rows for cell in row[1:5])
    assert all(cell == "nan" for row in rows for cell in row[5:])
