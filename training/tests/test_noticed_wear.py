"""Facts about what minutes of wearing tell of a calibration that is wrong."""

from dataclasses import replace

import numpy as np
import pytest
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.noticed_wear import FAULTS, Fault, NoticedWearConfig, Reader, main, signs
from threepoint_training.simulate_trackers import TrackerConfig, draw_wearer, simulate
from threepoint_training.skeleton import body_from_calibration
from threepoint_training.training_config import TrainConfig, quick

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=1, clips=1, frames=1200, seed=5)
PERSON = next(iter(CORPUS.people.values()))


def signs_of(fault):
    wearer = fault.worn(draw_wearer(TrackerConfig(), np.random.default_rng(1)))
    tracked = simulate(CORPUS.positions, CORPUS.rotations, wearer, TrackerConfig(), np.random.default_rng(2))
    body = body_from_calibration(np.array(PERSON.eye_height * (1 + fault.eye_height)), np.array(PERSON.arm_span))
    return signs(*tracked, body, NoticedWearConfig())


def test_a_headset_that_sits_higher_is_higher_and_further_from_hands_that_hang():
    right, higher = signs_of(Fault()), signs_of(Fault(up=0.03))
    assert higher[0] - right[0] == pytest.approx(0.03 / PERSON.eye_height, abs=0.005)
    assert higher[1] > right[1]


def test_a_body_taken_for_too_small_stands_too_high():
    assert signs_of(Fault(eye_height=-0.05))[0] == pytest.approx(signs_of(Fault())[0] / 0.95, abs=0.005)


def test_faults_that_signs_follow_from_are_read_and_what_was_not_seen_says_nothing():
    random = np.random.default_rng(3)
    faults = random.normal(size=(400, 3)) * [0.03, 0.03, 0.05]
    seen = 1 + faults @ random.normal(size=(3, 3))
    reader = Reader(seen, faults, ridge=1e-3)
    read = reader(seen[7])
    np.testing.assert_allclose([read.up, read.back, read.eye_height], faults[7], atol=1e-4)
    nothing = reader(np.full(3, np.nan))
    np.testing.assert_allclose([nothing.up, nothing.back, nothing.eye_height], faults.mean(axis=0), atol=1e-9)


def test_each_person_is_judged_by_what_is_made_of_the_others():
    corpus = generate_corpus(people=3, clips=1, frames=900, seed=5)
    config = quick(TrainConfig(mocap=None))
    asked = []
    rows = main(corpus, replace(config.learned, steps=8), config.ik, NoticedWearConfig(fewest_minutes=0.1, groups=2, wearers=3), asked.append)
    assert sorted(", ".join(asked).split(", ")) == sorted(corpus.people)
    assert [label for label, *_ in rows] == list(FAULTS)
    # No one is of another laboratory.
    assert all(0 < float(cell) < 50 for row in rows for cell in row[1:5])
    assert all(cell == "nan" for row in rows for cell in row[5:])
