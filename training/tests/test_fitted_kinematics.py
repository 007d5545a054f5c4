"""Facts about proportions and IK parameters that are fitted for a fold."""

import pytest
from threepoint_training import fitted_kinematics, skeleton, solve_ik
from threepoint_training.fit_ik import FitIkConfig
from threepoint_training.generated_motion import generate_corpus

CORPUS = generate_corpus(people=3, clips=1, frames=80, seed=8)


def test_fitted_kinematics_are_used_for_as_long_as_they_are_asked_for():
    before = skeleton.load_proportions(), solve_ik.load_parameters()
    fitted = fitted_kinematics.fit(CORPUS, tuple(CORPUS.people), FitIkConfig(iterations=1, frames_per_person=40))
    with pytest.raises(ValueError, match="on the way"), fitted_kinematics.used(fitted):
        assert skeleton.load_proportions() == fitted.proportions != before[0]
        raise ValueError("on the way")
    assert (skeleton.load_proportions(), solve_ik.load_parameters()) == before
