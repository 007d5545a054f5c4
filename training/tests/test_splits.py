"""Facts about who trains and who is evaluation-only."""

import pytest
from threepoint_training import splits

SUBJECTS = ("001", "005", "014", "135", "901", "bk")


def test_people_of_another_laboratory_train_in_no_fold():
    assert splits.trainable(SUBJECTS) == ("001", "005", "014", "135")
    assert splits.evaluation_only(SUBJECTS) == ("901", "bk")
    assert splits.training_people("A", SUBJECTS) == ("001", "014")


def test_the_paper_s_network_is_made_of_the_varied_people_at_hand_and_ours_of_all():
    training = splits.training_people("A", ("001", "005", "006", "014", "132", "135", "901"))
    assert splits.trained_on("paper", training) == ("001", "014")
    assert splits.trained_on("learned", training) == training == ("001", "006", "014", "132")
    eleven = tuple(sorted(splits.VARIED))
    assert splits.trained_on("paper", (*eleven, "132")) == splits.trained_on("paper", eleven) == eleven


def test_the_paper_s_network_is_made_of_all_where_no_varied_person_is_at_hand():
    assert splits.trained_on("paper", ("anna", "bert")) == ("anna", "bert")


def test_people_are_counted_of_those_who_may_be_trained_on_and_named_where_not_all():
    assert splits.counted(("001", "005", "014", "135"), SUBJECTS) == "all 4 people"
    assert splits.counted(("001", "014"), SUBJECTS) == "2 of 4 people: 001, 014"


@pytest.mark.training
def test_weights_of_evaluation_only_subjects_are_not_written():
    from threepoint_training.export import Provenance

    with pytest.raises(ValueError, match="901: evaluation-only subjects"):
        Provenance("motion", "", ("001", "901"), 1, {})
