"""Facts about how hands stand to their forearms, as it is estimated while they are seen."""

from dataclasses import replace

import numpy as np
import pytest
from threepoint_training import hand_tilt, mirror, quaternion
from threepoint_training.estimate_hand_tilts import (
    NO_CALIBRATED_TILTS,
    CalibratedTilts,
    estimated_tilts,
    ik_forearms,
    with_estimated_hands,
)
from threepoint_training.features import frame_features
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.prepare import EYES_FROM_HEAD_JOINT
from threepoint_training.shared_constants import HAND_TILTS, LIMB
from threepoint_training.simulate_trackers import TrackerConfig, Wearer, simulate
from threepoint_training.skeleton import body_from_calibration

# One minute of one person.
CORPUS = generate_corpus(people=1, clips=1, frames=3600, seed=3)
(PERSON,) = CORPUS.people.values()
BODY = body_from_calibration(np.array(PERSON.eye_height), np.array(PERSON.arm_span))
STILL = np.array([0.0, 0.0, 0.0, 1.0])
BOTH = np.array([True, True])
CALIBRATED = np.array([[0.3, -0.2], [-0.1, 0.4]])


def tracked(corpus):
    """Its positions and rotations as exact trackers see them."""
    wearer = Wearer(EYES_FROM_HEAD_JOINT, STILL, np.zeros((2, 3)), np.stack([STILL, STILL]))
    return simulate(
        corpus.positions,
        corpus.rotations,
        wearer,
        TrackerConfig(*[0.0] * 4, (0.0,) * 3, (0.0,) * 3, 0.0),
        np.random.default_rng(0),
    )


def worn_off(corpus, right):
    """Returns the person with the right hand rotated against its forearm, and the left hand as its mirror image."""
    turns = quaternion.from_rotation_vector(np.array([np.zeros(3), right * np.array([1.0, -1.0, -1.0]), right]))
    return replace(corpus, rotations=quaternion.multiply(corpus.rotations.astype(np.float64), turns).astype(np.float32))


POSITIONS, ROTATIONS = tracked(CORPUS)
FOREARMS = ik_forearms(POSITIONS, ROTATIONS, BODY)
SECONDS = np.full(len(POSITIONS), 1 / 60)


def angles(tilts, others):
    """Between forearms of these tilts [rad]."""
    one, other = hand_tilt.direction_of(tilts), hand_tilt.direction_of(others)
    return np.arctan2(np.linalg.norm(np.cross(one, other), axis=-1), np.sum(one * other, axis=-1))


@pytest.mark.parametrize("known", [[True, True], [True, False], [False, True], [False, False]])
def test_a_tilt_that_is_known_before_is_kept_until_the_hand_is_seen(known):
    known = np.array(known)
    (first,) = estimated_tilts(FOREARMS[:1], SECONDS[:1], CalibratedTilts(CALIBRATED, known), np.zeros((1, 2), bool))
    np.testing.assert_allclose(first[known], CALIBRATED[known], atol=1e-12)
    np.testing.assert_allclose(first[~known], hand_tilt.usual()[~known], atol=1e-12)


def test_the_first_frame_weighs_its_forearm_against_the_known_tilt():
    (first,) = estimated_tilts(FOREARMS[:1], SECONDS[:1], CalibratedTilts(CALIBRATED, BOTH))
    balance = HAND_TILTS["calibratedWeight"] * hand_tilt.direction_of(CALIBRATED) + FOREARMS[0]
    np.testing.assert_allclose(first, hand_tilt.tilt_of(balance), atol=1e-12)


def test_the_usual_tilt_of_a_left_hand_is_that_of_the_right_one_in_a_mirror():
    (left_pitch, left_yaw), (right_pitch, right_yaw) = hand_tilt.usual()
    assert left_pitch == pytest.approx(right_pitch) != 0
    assert left_yaw == pytest.approx(-right_yaw) != 0


def test_a_hand_at_rest_has_the_same_tilt_whatever_it_did_before():
    rest = np.broadcast_to(FOREARMS[1000], (480, 2, 3))
    seconds = np.full(960, 1 / 60)
    ends = [
        estimated_tilts(np.concatenate([FOREARMS[start : start + 480], rest]), seconds)[[480, -1]]
        for start in (0, 1500, 3000)
    ]
    for end in ends[1:]:
        came, left = angles(end, ends[0])
        assert came.max() > 0.05
        assert left.max() < 0.004


def test_where_forearms_point_is_estimated_without_what_is_known_of_the_hands():
    """The estimate has no feedback: the body's tilts move IK's elbows, but not the estimated forearms."""
    turned = BODY.with_hands(CALIBRATED)
    np.testing.assert_array_equal(ik_forearms(POSITIONS, ROTATIONS, turned), FOREARMS)
    elbows = [frame_features(POSITIONS, ROTATIONS, body)[1][:, :2] for body in (turned, BODY)]
    assert np.abs(elbows[1] - elbows[0]).max() > 0.05
    tilts = [with_estimated_hands(body, POSITIONS, ROTATIONS, SECONDS).hand_tilts for body in (turned, BODY)]
    np.testing.assert_array_equal(tilts[0], tilts[1])


def test_a_calibrated_tilt_moves_less_than_the_usual_tilt():
    moved = [
        angles(
            estimated_tilts(FOREARMS, SECONDS, CalibratedTilts(hand_tilt.usual(), np.array([known] * 2))),
            hand_tilt.usual(),
        )
        for known in (True, False)
    ]
    assert (moved[0] < 0.8 * moved[1]).all()


@pytest.mark.parametrize("right", [[-0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, -0.5, 0.0]])
def test_hands_that_are_worn_off_their_forearms_are_found(right):
    """Other ways than the usual tilt goes. Generated wrists wave about straight ones."""
    corpus = worn_off(CORPUS, right)
    true = hand_tilt.ForearmMeans(corpus, (PERSON.name,)).of(PERSON.name)
    usual = angles(hand_tilt.usual(), true)
    assert (usual > 0.4).all()
    found = with_estimated_hands(BODY, *tracked(corpus), SECONDS).hand_tilts
    assert (angles(found, true).mean(axis=0) < 0.6 * usual).all()


def test_a_hand_that_is_not_seen_is_not_estimated():
    """For two seconds; the other one is, all the while."""
    seen = np.ones((600, 2), bool)
    seen[300:420, 0] = False
    tilts = estimated_tilts(FOREARMS[:600], SECONDS[:600], NO_CALIBRATED_TILTS, seen)
    unseen = tilts[299:420, 0]
    # Nothing but the last digits of doubles may differ.
    np.testing.assert_allclose(unseen, np.broadcast_to(unseen[0], unseen.shape), rtol=0, atol=1e-14)
    always = estimated_tilts(FOREARMS[:600], SECONDS[:600])
    np.testing.assert_array_equal(tilts[:, 1], always[:, 1])
    assert (np.abs(np.diff(always[299:420], axis=0)).max(axis=-1) > 0).all()
    assert np.abs(tilts[420] - unseen[-1])[0].max() > 1e-5


def test_hands_are_turned_no_further_than_the_steepest_tilt():
    """Towards where the sum points, and by all of it once it is no longer steep."""
    steepest = LIMB["steepestHandTilt"]
    steep = np.array([[0.9, -1.6], [-1.8, 0.3]])
    ahead = hand_tilt.direction_of(np.array([[0.2, 0.0], [0.0, -0.1]]))
    forearms = np.concatenate(
        [np.broadcast_to(hand_tilt.direction_of(steep), (1200, 2, 3)), np.broadcast_to(ahead, (2400, 2, 3))]
    )
    tilts = estimated_tilts(forearms, SECONDS, CalibratedTilts(steep, BOTH))
    size = np.linalg.norm(tilts, axis=-1)
    assert size.max() <= steepest + 1e-12
    np.testing.assert_allclose(tilts[0], steep * steepest / np.linalg.norm(steep, axis=-1, keepdims=True))
    assert (np.linalg.norm(estimated_tilts(forearms, SECONDS), axis=-1)[-1] < 0.9 * steepest).all()


def test_twice_the_frame_rate_gives_nearly_the_same_tilts():
    fast, slow = estimated_tilts(FOREARMS, SECONDS)[::2], estimated_tilts(FOREARMS[::2], 2 * SECONDS[::2])
    assert angles(fast, slow).max() < 0.01
    assert (angles(fast[-1], fast[0]) > 0.1).all()


def test_the_mirror_image_has_the_mirrored_tilts():
    positions, rotations = mirror.trackers(POSITIONS, ROTATIONS)
    seen = np.random.default_rng(2).uniform(size=(len(POSITIONS), 2)) > 0.3
    tilts = with_estimated_hands(
        BODY, POSITIONS, ROTATIONS, SECONDS, calibrated=CalibratedTilts(CALIBRATED, np.array([True, False])), seen=seen
    ).hand_tilts
    calibrated = CalibratedTilts(mirror.tilts(CALIBRATED), np.array([False, True]))
    mirrored = with_estimated_hands(
        BODY, positions, rotations, SECONDS, calibrated=calibrated, seen=seen[:, ::-1]
    ).hand_tilts
    np.testing.assert_allclose(mirrored, mirror.tilts(tilts), atol=1e-9)
