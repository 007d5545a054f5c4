"""Facts about how far above its usual place a headset is estimated to sit;
tests/threepoint/core/estimation/headset-rise.test.ts holds the page to it.
"""

from dataclasses import replace

import numpy as np
import pytest
from golden_file import assert_as_committed
from threepoint_training import golden
from threepoint_training.estimate_headset_rise import hanging_reach, reaches, rise
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.shared_constants import HEADSET_RISE
from threepoint_training.simulate_trackers import TrackerConfig, draw_wearer, simulate
from threepoint_training.skeleton import body_from_calibration

CORPUS = generate_corpus(people=1, clips=1, frames=1200, seed=5)
PERSON = next(iter(CORPUS.people.values()))
BODY = body_from_calibration(np.array(PERSON.eye_height), np.array(PERSON.arm_span))
USUAL = HEADSET_RISE["usualReach"]
ARM = np.array(0.6)


def test_the_committed_vectors_are_those_that_this_code_makes():
    assert_as_committed("headset-rise.json", golden.headset_rise_vectors(), atol=1e-9)


def hang(length, frames=1):
    """Both arms straight down, so long [arm lengths]."""
    return np.broadcast_to([0.0, -length, 0.0], (frames, 2, 3))


def test_a_headset_that_sits_higher_takes_the_shoulders_away_from_hands():
    wearer = draw_wearer(TrackerConfig(), np.random.default_rng(1))
    higher = replace(wearer, eyes_in_head=wearer.eyes_in_head + [0.0, 0.03, 0.0])
    of_both = [
        reaches(*simulate(CORPUS.positions, CORPUS.rotations, worn, TrackerConfig(), np.random.default_rng(2)), BODY)
        for worn in (wearer, higher)
    ]
    lower = -np.diff(np.median([each[..., 1] for each in of_both], axis=(1, 2)))
    assert lower.item() * BODY.arm == pytest.approx(0.03, abs=0.01)


def test_most_of_the_time_a_hanging_wrist_is_nearer_than_what_is_followed():
    random = np.random.default_rng(3)
    lengths = 0.95 + 0.02 * random.normal(size=60 * 1200)
    reach = np.stack([np.zeros_like(lengths), -lengths, np.zeros_like(lengths)], axis=-1)[:, None].repeat(2, axis=1)
    followed = hanging_reach(reach, np.full(len(reach), 1 / 60))[-20000:]
    assert (lengths[-20000:, None] < followed).mean() == pytest.approx(HEADSET_RISE["share"], abs=0.02)


def test_it_is_followed_slowly_and_only_while_an_arm_hangs_that_is_seen():
    minute = np.full(3600, 1 / 60)
    ahead = np.broadcast_to([0.0, -0.5, -0.8], (3600, 2, 3))
    assert (hanging_reach(ahead, minute) == USUAL).all()
    seen = np.array([True, False])
    left, right = hanging_reach(hang(1.2, 3600), minute, seen=np.broadcast_to(seen, (3600, 2)))[-1]
    assert left - USUAL == pytest.approx(60 * HEADSET_RISE["speed"] * HEADSET_RISE["share"], rel=1e-6)
    assert right == USUAL


def test_people_differ_by_what_is_unremarkable_and_no_headset_sits_further_than_the_furthest():
    def of(further):
        return rise(np.array([[USUAL + further] * 2]), ARM).item()

    beyond = HEADSET_RISE["unremarkable"]
    assert of(0.9 * beyond) == of(-0.9 * beyond) == 0.0
    assert of(beyond + 0.02) == pytest.approx(0.02 * ARM.item())
    assert of(-beyond - 0.02) == pytest.approx(-0.02 * ARM.item())
    assert of(0.5) == HEADSET_RISE["furthest"] == -of(-0.5)
