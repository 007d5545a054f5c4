"""Facts about where a lost hand is taken to be."""

import numpy as np
from threepoint_training import quaternion
from threepoint_training.complete_hands import carry_with_head, complete_hands
from threepoint_training.shared_constants import LOST_HAND

STILL = np.array([[0.0, 0.0, 0.0, 1.0]])
EYE_HEIGHT, ARM = np.array([1.6]), np.array([0.55])
HEAD, RAISED = np.array([0.0, 1.6, 0.0]), np.array([0.3, 1.8, -0.3])


def right_wrist(seconds):
    """The right wrist, raised when it was seen last, so long after that."""
    positions = np.stack([HEAD, [-0.3, 1.0, -0.2], RAISED])[None]
    rotations = np.broadcast_to(STILL, (1, 3, 4))
    places, turns = complete_hands(positions, rotations, np.array([[0.0, seconds]]), EYE_HEIGHT, ARM)
    np.testing.assert_allclose(places[:, :2], positions[:, :2])
    np.testing.assert_allclose(np.linalg.norm(turns, axis=-1), 1.0)
    return places[0, 2]


def test_a_lost_hand_is_held_then_lowered_and_then_rests_beside_the_hip():
    np.testing.assert_allclose(right_wrist(LOST_HAND["holdSeconds"]), RAISED)
    heights = [
        right_wrist(LOST_HAND["holdSeconds"] + share * LOST_HAND["restSeconds"])[1] for share in np.linspace(0, 1, 20)
    ]
    assert (np.diff(heights) < 0).all()
    rest = right_wrist(LOST_HAND["holdSeconds"] + LOST_HAND["restSeconds"])
    np.testing.assert_allclose(right_wrist(60.0), rest)
    assert 0.15 < rest[0] < 0.35
    assert 0.6 < rest[1] < 1.0


def test_half_way_in_time_is_half_way():
    middle = right_wrist(LOST_HAND["holdSeconds"] + LOST_HAND["restSeconds"] / 2)
    np.testing.assert_allclose(middle, (RAISED + right_wrist(60.0)) / 2)


def test_a_hand_that_is_carried_along_stays_where_it_was_before_the_face():
    """However its head moves and turns; a nod does not move it."""
    random = np.random.default_rng(3)
    yaw = quaternion.from_rotation_vector(np.array([[0.0, 1.2, 0.0]]))
    nod = quaternion.from_rotation_vector(np.array([[0.5, 0.0, 0.0]]))
    hand, turn = RAISED[None], quaternion.from_rotation_vector(random.normal(size=(1, 3)))
    step = np.array([[1.0, -0.2, 0.5]])
    place, turned = carry_with_head(hand, turn, (HEAD[None], STILL), (HEAD + step, quaternion.multiply(yaw, nod)))
    np.testing.assert_allclose(place, HEAD + step + quaternion.rotate(yaw, hand - HEAD))
    np.testing.assert_allclose(turned, quaternion.multiply(yaw, turn))
