"""Facts about what is drawn into a batch."""

import numpy as np
import pytest
from threepoint_training.posture_balance import cluster, weights

WALKING, REACHING = np.array([0.0, 0.0]), np.array([3.0, 1.0])


def motion(walking: int, reaching: int):
    """Frames of two postures, a little different each time."""
    random = np.random.default_rng(2)
    which = np.repeat([0, 1], [walking, reaching])
    return np.stack([WALKING, REACHING])[which] + 0.05 * random.normal(size=(len(which), 2)), which


def test_frames_of_one_posture_share_a_cluster_and_others_do_not():
    postures, which = motion(900, 100)
    labels = cluster(postures, 12, seed=1)
    assert not set(labels[which == 0]) & set(labels[which == 1])


def test_a_cluster_that_loses_all_its_postures_stays_finite():
    labels = cluster(np.zeros((50, 3)), 8, seed=1)
    assert set(labels) == {0}


@pytest.mark.parametrize(("exponent", "share"), [(0.0, 0.1), (1.0, 0.5)])
def test_the_exponent_goes_from_frames_alike_to_postures_alike(exponent, share):
    postures, which = motion(900, 100)
    weight = weights(np.zeros(1000, np.int64), postures, 2, (0.0, exponent), seed=1)
    assert weight[which == 1].sum() / weight.sum() == pytest.approx(share, abs=1e-9)


def test_people_count_alike_at_an_exponent_of_one():
    people = np.repeat([0, 1, 2], [10, 200, 790])
    weight = weights(people, np.zeros((1000, 1)), 1, (1.0, 0.0), seed=1)
    np.testing.assert_allclose(np.bincount(people, weight), 1.0)
