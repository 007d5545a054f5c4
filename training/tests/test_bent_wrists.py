"""Facts about wearers who bend their wrists while their hands are measured."""

import numpy as np
from threepoint_training import hand_tilt, train_learned
from threepoint_training.chest_features import MEASURED
from threepoint_training.features import FEATURES
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.kinematic_limits import LIMB

CORPUS = generate_corpus(people=1, clips=3, frames=90, seed=12)


def test_a_bent_wrist_is_not_believed():
    steepest = LIMB["steepestHandTilt"]
    assert hand_tilt.believed(np.array([[steepest - 0.01, 0.0], [0.0, -steepest - 0.01]])).tolist() == [True, False]
    bent = train_learned.held_out(CORPUS, ("001",), (0.0,), condition=train_learned.Condition(bent_wrists=1.5))
    assert (bent.inputs[:, FEATURES:][:, MEASURED] == 0).all()
    untold = train_learned.held_out(CORPUS, ("001",), (0.0,), condition=train_learned.Condition(hands_measured=False))
    np.testing.assert_array_equal(bent.inputs, untold.inputs)
