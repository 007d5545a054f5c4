"""Facts about holding each person out in turn."""

from dataclasses import replace

import numpy as np
import pytest
from threepoint_training import fitted_kinematics, leave_one_out, postures, skeleton, solve_ik, train_learned
from threepoint_training.chest_features import CHEST_FEATURES, REACH_LENGTHS
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


@pytest.mark.parametrize(("count", "groups"), [(None, [("1",), ("2",), ("3",)]), (2, [("1", "3"), ("2",)]), (9, [("1",), ("2",), ("3",)])])
def test_people_are_held_out_alone_or_in_groups(count, groups):
    assert leave_one_out.groups_of(("1", "2", "3"), count) == groups


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
    assert any(name.startswith("another laboratory: ") for name, *_ in rows.postures)
    assert trained_on == [("003",), ("002",), ("002", "003")]


def test_postures_count_people_alike_and_distances_part_all_frames():
    """Two people, one with ten times the frames; who has more motion weighs no more."""
    names = ("002", "003")

    def person(frames, of_ik, ours, furthest):
        errors = (np.full((frames, 6), value) for value in (of_ik, ours))
        return leave_one_out.HeldOutPerson(*errors, {"crouching": np.arange(frames) < frames // 2}, np.linspace(0, furthest, frames))

    found = {"002": person(40, 4.0, 2.0, furthest=1.0), "003": person(400, 8.0, 8.0, furthest=4.0)}
    corpus = replace(CORPUS, people={name: CORPUS.people[name] for name in names})
    crouching, *distances = leave_one_out.tables(corpus, found).postures
    assert crouching == ["crouching", "50.0 %", "6.00", "5.00", "0.83", "0.83"]
    shares = [float(row[1].split()[0]) for row in distances]
    assert shares == pytest.approx([25, 25, 25, 15, 10], abs=3)
    assert float(distances[-1][4]) == 1.0 > float(distances[0][4])


def test_frames_are_told_apart_by_what_their_features_say():
    crouching = train_learned.held_out(CORPUS, ("002",), (0.0,)).inputs[:1].repeat(3, axis=0)
    crouching[:, 0] = 0.5, 1.0, 1.0
    # The right hand, up from the headset; then a head that looks at the floor.
    crouching[:, 17] = -0.5, 0.4, -0.5
    crouching[:, 8] = -0.5
    crouching[:, 5] = 1.0, 1.0, 0.2
    crouching[:, -CHEST_FEATURES:][:, REACH_LENGTHS] = 0.9
    of = {name: frames.tolist() for name, frames in postures.of_frames(crouching).items()}
    assert of["head under 0.9 of the eye height"] == [True, False, False]
    assert of["a hand above the headset"] == [False, True, False]
    assert of["head tilted by over 45°"] == [False, False, True]
    assert of["both arms bent, reach under 0.65"] == [False] * 3
    assert of[postures.UPRIGHT] == [False] * 3


def test_fitted_kinematics_are_used_for_as_long_as_they_are_asked_for():
    before = skeleton.load_proportions(), solve_ik.load_parameters()
    fitted = fitted_kinematics.fit(CORPUS, tuple(CORPUS.people), QUICK)
    with pytest.raises(ValueError, match="on the way"), fitted_kinematics.used(fitted):
        assert skeleton.load_proportions() == fitted.proportions != before[0]
        raise ValueError("on the way")
    assert (skeleton.load_proportions(), solve_ik.load_parameters()) == before
