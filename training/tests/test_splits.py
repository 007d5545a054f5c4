"""Facts about who trains, who is held out together, who is evaluation-only and who is in the lockbox."""

import pytest
from threepoint_training import splits

SUBJECTS = ("001", "005", "014", "135", "901", "bk")


def test_people_of_another_laboratory_and_of_the_lockbox_train_in_no_fold():
    assert splits.trainable(SUBJECTS) == ("005", "014")
    assert splits.evaluation_only(SUBJECTS) == ("901", "bk")
    assert splits.training_people("A", SUBJECTS) == ("014",)


def test_the_lockbox_is_the_one_that_was_drawn_from_the_varied_people():
    assert splits.draw_lockbox() == splits.LOCKBOX
    assert set(splits.LOCKBOX) < set(splits.VARIED)


def test_groups_in_turn_hold_everybody_out_once_and_partners_together():
    people = ("002", "003", "018", "019", "060", "061", "088")
    groups = splits.groups_in_turn(people, 3)
    assert sorted(person for group in groups for person in group) == list(people)
    assert all({"018", "019"} <= set(group) or not {"018", "019"} & set(group) for group in groups)
    assert all({"060", "061"} <= set(group) or not {"060", "061"} & set(group) for group in groups)


@pytest.mark.parametrize("count", [None, 9])
def test_people_are_held_out_alone_but_for_partners(count):
    assert splits.groups_in_turn(("002", "018", "019", "088"), count) == [("002",), ("018", "019"), ("088",)]


def test_who_has_no_partner_among_the_people_is_held_out_alone():
    assert splits.groups_in_turn(("002", "019", "061"), 3) == [("002",), ("019",), ("061",)]


def test_the_paper_s_network_is_made_of_the_varied_people_at_hand_and_ours_of_all():
    training = splits.training_people("A", ("001", "005", "006", "014", "132", "135", "901"))
    assert splits.trained_on("paper", training) == ("014",)
    assert splits.trained_on("learned", training) == training == ("006", "014", "132")
    eleven = tuple(sorted(splits.VARIED))
    assert splits.trained_on("paper", (*eleven, "132")) == splits.trained_on("paper", eleven) == eleven


def test_the_paper_s_network_is_made_of_all_where_no_varied_person_is_at_hand():
    assert splits.trained_on("paper", ("anna", "bert")) == ("anna", "bert")


def test_people_are_counted_of_those_who_may_be_trained_on_and_named_where_not_all():
    assert splits.counted(("005", "014"), SUBJECTS) == "all 2 people"
    assert splits.counted(("014",), SUBJECTS) == "1 of 2 people: 014"


@pytest.mark.training
@pytest.mark.parametrize(("person", "why"), [("901", "evaluation-only"), ("049", "in the lockbox")])
def test_no_weights_are_written_of_people_who_never_train(person, why):
    from threepoint_training.export import Provenance

    with pytest.raises(ValueError, match=f"{person}: {why}"):
        Provenance("motion", "", ("002", person), 1, {})
