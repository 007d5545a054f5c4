"""Facts about holding each person out in turn."""

import pytest
from threepoint_training import fitted_kinematics, leave_one_out, skeleton, solve_ik, train_learned
from threepoint_training.fit_ik import FitIkConfig
from threepoint_training.generated_motion import generate_corpus

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=3, clips=1, frames=80, seed=8)
QUICK = FitIkConfig(iterations=1, frames_per_person=40)


def test_each_person_has_a_row_and_the_mean_counts_them_alike():
    recipe = train_learned.TrainLearnedConfig(width=8, batch=32, steps=2)
    reported = []
    rows = leave_one_out.main(CORPUS, recipe, QUICK, reported.append)
    people = sorted(CORPUS.people)
    assert reported == people
    assert [row[0] for row in rows] == [*people, "all alike"]
    assert all(len(row) == 1 + len(leave_one_out.COLUMNS) for row in rows)
    of_ik = [float(row[1]) for row in rows]
    assert of_ik[-1] == pytest.approx(sum(of_ik[:-1]) / len(people), abs=0.01)


def test_fitted_kinematics_are_used_for_as_long_as_they_are_asked_for():
    before = skeleton.load_proportions(), solve_ik.load_parameters()
    fitted = fitted_kinematics.fit(CORPUS, tuple(CORPUS.people), QUICK)
    with pytest.raises(ValueError, match="on the way"), fitted_kinematics.used(fitted):
        assert skeleton.load_proportions() == fitted.proportions != before[0]
        raise ValueError("on the way")
    assert (skeleton.load_proportions(), solve_ik.load_parameters()) == before
