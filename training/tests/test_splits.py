"""Facts about who trains and who only measures."""

import pytest
from threepoint_training import splits

SUBJECTS = ("001", "005", "014", "135", "901", "bk")


def test_people_of_another_laboratory_train_in_no_fold():
    assert splits.trainable(SUBJECTS) == ("001", "005", "014", "135")
    assert splits.measured_only(SUBJECTS) == ("901", "bk")
    assert splits.training_people("A", SUBJECTS) == ("001", "014")


@pytest.mark.training
def test_weights_of_people_who_only_measure_are_not_written():
    from threepoint_training.export import Provenance

    with pytest.raises(ValueError, match="901: people who only measure"):
        Provenance("motion", "", ("001", "901"), 1, {})
