"""Facts about the conditions under which people held out are tracked."""

import numpy as np
import pytest
from threepoint_training import train_learned
from threepoint_training.features import HEADSET_HEIGHT, SEEN
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.train_learned import Condition

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=2, clips=2, frames=200, seed=3)
WINDOW = (0.0, 0.1)


def test_every_condition_makes_ik_worse_and_none_touches_the_frames():
    people = tuple(CORPUS.people)
    plain = train_learned.held_out(CORPUS, people, WINDOW)
    base = train_learned.ik_errors_cm(plain).mean()
    for condition in (
        Condition(offset=0.03),
        Condition(eye_height=1.05),
        Condition(lost_hand=True),
        Condition(late=4),
        Condition(seated=0.28),
        Condition(tilt=np.radians(8.0)),
    ):
        worse = train_learned.held_out(CORPUS, people, WINDOW, condition=condition)
        assert worse.inputs.shape == plain.inputs.shape
        np.testing.assert_array_equal(worse.people, plain.people)
        assert train_learned.ik_errors_cm(worse).mean() > base, condition


def test_a_lost_hand_is_masked_and_a_seated_head_is_lower():
    people = tuple(CORPUS.people)
    lost = train_learned.held_out(CORPUS, people, WINDOW, condition=Condition(lost_hand=True))
    # Two seconds of every four: the last 80 of each clip's 200 frames.
    seen = lost.inputs[:, SEEN].reshape(-1, 200, 2)
    assert (seen[:, :120] == 1).all()
    assert (seen[:, 120:].sum(axis=2) == 1).all()
    seated = train_learned.held_out(CORPUS, people, WINDOW, condition=Condition(seated=0.28))
    plain = train_learned.held_out(CORPUS, people, WINDOW)
    assert np.median(plain.inputs[:, HEADSET_HEIGHT] - seated.inputs[:, HEADSET_HEIGHT]) == pytest.approx(0.28, abs=0.01)
