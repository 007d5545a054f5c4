"""Facts about holding each person out in turn."""

from dataclasses import replace

import numpy as np
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
    rows = leave_one_out.main(CORPUS, recipe, QUICK, reported.append).people
    people = sorted(CORPUS.people)
    assert reported == people
    assert [row[0] for row in rows] == [*people, "all alike"]
    assert all(len(row) == 1 + len(leave_one_out.COLUMNS) for row in rows)
    of_ik = [float(row[1]) for row in rows]
    assert of_ik[-1] == pytest.approx(sum(of_ik[:-1]) / len(people), abs=0.01)


def test_a_contract_gets_what_was_found_of_people_in_turn():
    recipe = train_learned.TrainLearnedConfig(width=8, batch=32, steps=2)
    rows = leave_one_out.main(CORPUS, recipe, QUICK)
    (measured,) = (row for row in rows.hands if row[0] == leave_one_out.MEASURED)
    stated = {row: f"{errors.mean():.2f}" for row, errors in rows.errors.items()}
    assert stated["IK, 3 people in turn, hands measured"] == measured[1]
    assert stated["learned, 3 people in turn, hands measured"] == measured[2]


def test_evaluation_only_subjects_have_rows_of_their_own_and_are_trained_on_by_none(monkeypatch):
    person = CORPUS.people["004"]
    others = {name: each for name, each in CORPUS.people.items() if name != "004"}
    corpus = replace(
        CORPUS,
        people=others | {"901": replace(person, name="901")},
        clip_people=tuple("901" if name == "004" else name for name in CORPUS.clip_people),
    )
    trained_on = []
    train = train_learned.train

    def watched(given, people, config):
        trained_on.append(people)
        return train(given, people, config)

    monkeypatch.setattr(train_learned, "train", watched)
    rows = leave_one_out.main(corpus, train_learned.TrainLearnedConfig(width=8, batch=32, steps=2), QUICK)
    assert [row[0] for row in rows.people] == ["002", "003", "all alike", "901", "another laboratory, all alike"]
    by_hands = {name: cells for name, *cells in rows.hands}
    elsewhere = {name: cells for name, *cells in rows.people}["901"]
    assert list(by_hands) == [f"{whose}{told}" for whose in ("", "another laboratory: ") for told in leave_one_out.HANDS]
    assert float(by_hands[f"another laboratory: {leave_one_out.MEASURED}"][0]) == pytest.approx(float(elsewhere[0]), rel=0.1)
    assert trained_on == [("003",), ("002",), ("002", "003")]


def test_fitted_kinematics_are_used_for_as_long_as_they_are_asked_for():
    before = skeleton.load_proportions(), solve_ik.load_parameters()
    fitted = fitted_kinematics.fit(CORPUS, tuple(CORPUS.people), QUICK)
    with pytest.raises(ValueError, match="on the way"), fitted_kinematics.used(fitted):
        assert skeleton.load_proportions() == fitted.proportions != before[0]
        raise ValueError("on the way")
    assert (skeleton.load_proportions(), solve_ik.load_parameters()) == before
