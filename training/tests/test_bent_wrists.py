"""Facts about wearers who bend their wrists while their hands are measured."""

import numpy as np
from threepoint_training import hand_tilt
from threepoint_training.features import HANDS
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.kinematic_limits import LIMB
from threepoint_training.train_learned import Condition, held_out

CORPUS = generate_corpus(people=1, clips=3, frames=90, seed=12)


def inputs(condition, corpus=CORPUS):
    return held_out(corpus, ("002",), (0.0,), condition=condition).inputs


def test_a_wrist_that_is_bent_too_far_is_not_believed():
    """Its hand is then taken for one of which nothing is told."""
    steepest = LIMB["steepestHandTilt"]
    assert hand_tilt.believed(np.array([[steepest - 0.01, 0.0], [0.0, -steepest - 0.01]])).tolist() == [True, False]
    untold = inputs(Condition(hands_measured=False))
    np.testing.assert_array_equal(inputs(Condition(bent_wrists=1.5)), untold)
    for believed in (Condition(), Condition(bent_wrists=0.4)):
        assert np.abs(inputs(believed) - untold).max() > 0.1


def test_a_bent_wrist_is_found_out_while_the_hands_move():
    """After twenty seconds hands are turned much as if the wrists had been straight; never, when nothing is noticed."""
    corpus = generate_corpus(people=1, clips=1, frames=1200, seed=12)

    def along(angle, noticed):
        rows = inputs(Condition(bent_wrists=angle, hands_noticed=noticed), corpus)[[0, -1]]
        axes = [np.split(rows[:, hand][:, 3:], 2, axis=1) for hand in HANDS]
        return np.stack([-np.cross(x, y) for x, y in axes], axis=1)

    def apart(noticed):
        return np.arccos(np.clip(np.sum(along(0.0, noticed) * along(0.5, noticed), axis=-1), -1, 1))

    at_first, at_last = apart(True)
    np.testing.assert_allclose(at_first, 0.5, atol=0.01)
    assert (at_last < 0.3 * at_first).all()
    np.testing.assert_allclose(apart(False), np.stack([at_first, at_first]), atol=1e-3)
