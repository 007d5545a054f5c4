"""Facts about how hands stand to their forearms, as it is estimated while they move."""

from dataclasses import replace

import numpy as np
import pytest
from threepoint_training import hand_tilt, mirror, quaternion
from threepoint_training.estimate_hand_tilts import (
    NO_CALIBRATED_TILTS,
    CalibratedTilts,
    estimated_tilts,
    ik_forearms,
    travel,
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
METRES = travel(POSITIONS)


def angles(tilts, others):
    """Between forearms of these tilts [rad]."""
    one, other = hand_tilt.direction_of(tilts), hand_tilt.direction_of(others)
    return np.arctan2(np.linalg.norm(np.cross(one, other), axis=-1), np.sum(one * other, axis=-1))


@pytest.mark.parametrize("known", [[True, True], [True, False], [False, True], [False, False]])
def test_a_tilt_starts_as_calibrated_or_usual(known):
    known = np.array(known)
    (first,) = estimated_tilts(FOREARMS[:1], METRES[:1], CalibratedTilts(CALIBRATED, known))
    np.testing.assert_allclose(first[known], CALIBRATED[known], atol=1e-12)
    np.testing.assert_allclose(first[~known], hand_tilt.usual()[~known], atol=1e-12)


def test_the_usual_tilt_of_a_left_hand_is_that_of_the_right_one_in_a_mirror():
    (left_pitch, left_yaw), (right_pitch, right_yaw) = estimated_tilts(FOREARMS[:1], METRES[:1])[0]
    assert left_pitch == pytest.approx(right_pitch) != 0
    assert left_yaw == pytest.approx(-right_yaw) != 0


def test_a_hand_travels_about_the_head_and_not_with_it():
    positions = np.zeros((3, 3, 3))
    positions[1:, :, 0] = 0.5
    positions[2, 2] += [0.0, 0.3, 0.4]
    np.testing.assert_allclose(travel(positions), [[0.0, 0.0], [0.0, 0.0], [0.0, 0.5]])


def test_nothing_is_estimated_while_hands_rest():
    tilts = estimated_tilts(FOREARMS[:100], np.zeros((100, 2)), CalibratedTilts(CALIBRATED, BOTH))
    np.testing.assert_allclose(tilts, np.broadcast_to(CALIBRATED, tilts.shape), atol=1e-12)


def test_where_forearms_point_is_estimated_without_what_is_known_of_the_hands():
    """The estimate has no feedback: the body's tilts move IK's elbows, but not the estimated forearms."""
    turned = BODY.with_hands(CALIBRATED)
    np.testing.assert_array_equal(ik_forearms(POSITIONS, ROTATIONS, turned), FOREARMS)
    elbows = [frame_features(POSITIONS, ROTATIONS, body)[1][:, :2] for body in (turned, BODY)]
    assert np.abs(elbows[1] - elbows[0]).max() > 0.05
    tilts = [with_estimated_hands(body, POSITIONS, ROTATIONS, METRES).hand_tilts for body in (turned, BODY)]
    np.testing.assert_array_equal(tilts[0], tilts[1])


def test_a_calibrated_tilt_is_outweighed_by_a_minute_of_motion():
    """Once the memory is full, the measured tilt weighs calibratedMetres and the estimate memoryMetres."""
    others = CALIBRATED + np.array([[-0.4, 0.2], [0.3, -0.4]])
    apart = angles(
        estimated_tilts(FOREARMS, METRES, CalibratedTilts(CALIBRATED, BOTH)),
        estimated_tilts(FOREARMS, METRES, CalibratedTilts(others, BOTH)),
    )
    at_first, *later = apart[[0, 600, 1800, 3599]]
    assert (at_first > 0.4).all()
    assert (np.diff([at_first, *later], axis=0) < 0).all()
    assert (later[-1] < 1.5 * HAND_TILTS["calibratedMetres"] / HAND_TILTS["memoryMetres"] * at_first).all()


def test_a_calibrated_tilt_is_kept_longer_than_the_usual_tilt():
    moved = [
        angles(tilts[60], tilts[0])
        for tilts in (
            estimated_tilts(FOREARMS[:61], METRES[:61], CalibratedTilts(hand_tilt.usual(), np.array([known] * 2)))
            for known in (True, False)
        )
    ]
    assert (moved[0] < 0.6 * moved[1]).all()


@pytest.mark.parametrize(("off", "way"), [(0.2, 0.5), (0.7, 0.8)])
def test_a_calibrated_tilt_is_doubted_where_hands_are_held_far_from_it(off, way):
    """After a travel that weighs as much as the measured tilt: half of the way to where hands are held, most of it
    where that is 40° away.
    """
    held = CALIBRATED + [0.0, off]
    metres = np.full((round(60 * HAND_TILTS["calibratedMetres"]) + 1, 2), 1 / 60)
    tilts = estimated_tilts(
        np.broadcast_to(hand_tilt.direction_of(held), (len(metres), 2, 3)), metres, CalibratedTilts(CALIBRATED, BOTH)
    )
    assert angles(tilts[-1], CALIBRATED) / angles(held, CALIBRATED) == pytest.approx(way, abs=0.03)


def test_estimates_are_forgotten_and_calibrated_tilts_are_not():
    """The user changes the grip after minutes; hands travel 10 cm between frames."""
    before, after = hand_tilt.direction_of(CALIBRATED + [0.0, 0.3]), hand_tilt.direction_of(CALIBRATED - [0.3, 0.0])
    minutes = np.broadcast_to(before, (3000, 2, 3))
    memory = np.broadcast_to(after, (round(10 * HAND_TILTS["memoryMetres"]), 2, 3))
    tilts = estimated_tilts(
        np.concatenate([minutes, memory]), np.full((3000 + len(memory), 2), 0.1), CalibratedTilts(CALIBRATED, BOTH)
    )
    balance = hand_tilt.tilt_of(
        HAND_TILTS["calibratedMetres"] * hand_tilt.direction_of(CALIBRATED) + HAND_TILTS["memoryMetres"] * before
    )
    np.testing.assert_allclose(tilts[2999], balance, atol=1e-3)
    assert (angles(tilts[-1], hand_tilt.tilt_of(after)) < angles(tilts[-1], hand_tilt.tilt_of(before))).all()


@pytest.mark.parametrize("right", [[-0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, -0.5, 0.0]])
def test_hands_that_are_worn_off_their_forearms_are_found(right):
    """Other ways than the usual tilt goes. Generated wrists wave about straight ones."""
    corpus = worn_off(CORPUS, right)
    true = hand_tilt.ForearmMeans(corpus, (PERSON.name,)).of(PERSON.name)
    usual = angles(hand_tilt.usual(), true)
    assert (usual > 0.4).all()
    found = with_estimated_hands(BODY, *tracked(corpus), METRES).hand_tilts[-1]
    assert (angles(found, true) < 0.4 * usual).all()


def test_a_hand_that_is_not_seen_is_not_estimated():
    """For two seconds; the other one is, all the while."""
    seen = np.ones((600, 2), bool)
    seen[300:420, 0] = False
    tilts = estimated_tilts(FOREARMS[:600], METRES[:600], NO_CALIBRATED_TILTS, seen)
    unseen = tilts[300:421, 0]
    # Nothing but the last digits of doubles may differ.
    np.testing.assert_allclose(unseen, np.broadcast_to(unseen[0], unseen.shape), rtol=0, atol=1e-14)
    always = estimated_tilts(FOREARMS[:600], METRES[:600])
    np.testing.assert_array_equal(tilts[:, 1], always[:, 1])
    assert (np.abs(np.diff(always[300:421], axis=0)).max(axis=-1) > 0).all()
    assert np.abs(tilts[421] - unseen[-1])[0].max() > 1e-5


def test_a_frame_s_tilts_come_of_the_frames_before_it():
    """The frame itself and later frames do not affect its tilts."""
    frame = 200
    positions, rotations = (part[:300].copy() for part in (POSITIONS, ROTATIONS))
    positions[frame:, 1:] += [0.0, 0.2, -0.1]
    rotations[frame:, 1:] = quaternion.multiply(
        rotations[frame:, 1:], quaternion.from_rotation_vector(np.array([0.4, 0.3, 0.0]))
    )
    before = with_estimated_hands(BODY, POSITIONS[:300], ROTATIONS[:300], METRES[:300]).hand_tilts
    after = with_estimated_hands(BODY, positions, rotations, METRES[:300]).hand_tilts
    np.testing.assert_array_equal(after[: frame + 1], before[: frame + 1])
    assert (np.abs(after[frame + 1] - before[frame + 1]).max(axis=-1) > 1e-4).all()


def test_hands_are_turned_no_further_than_the_steepest_tilt():
    """Towards where the sum points, and by all of it once it is no longer steep."""
    steepest = LIMB["steepestHandTilt"]
    steep = np.array([[0.9, -1.6], [-1.8, 0.3]])
    ahead = hand_tilt.direction_of(np.array([[0.2, 0.0], [0.0, -0.1]]))
    forearms = np.concatenate(
        [np.broadcast_to(hand_tilt.direction_of(steep), (1200, 2, 3)), np.broadcast_to(ahead, (2400, 2, 3))]
    )
    metres = np.full((len(forearms), 2), 1 / 60)
    tilts = estimated_tilts(forearms, metres)
    size = np.linalg.norm(tilts, axis=-1)
    assert size.max() <= steepest + 1e-12
    np.testing.assert_allclose(size[1200], steepest)
    far = estimated_tilts(forearms, metres, CalibratedTilts(steep, BOTH))
    np.testing.assert_allclose(far[0], steep * steepest / np.linalg.norm(steep, axis=-1, keepdims=True))
    assert (size[-1] < 0.9 * steepest).all()


def test_twice_the_frame_rate_gives_nearly_the_same_tilts():
    """At first a frame more or less is a part of the travel that the usual tilt weighs."""
    fast, slow = estimated_tilts(FOREARMS, METRES)[::2], estimated_tilts(FOREARMS[::2], travel(POSITIONS[::2]))
    apart = angles(fast, slow).max(axis=-1)
    assert apart.max() < 0.06
    # After five seconds.
    assert apart[150:].max() < 0.003
    assert (angles(fast[-1], fast[0]) > 0.2).all()


def test_the_mirror_image_has_the_mirrored_tilts():
    positions, rotations = mirror.trackers(POSITIONS, ROTATIONS)
    seen = np.random.default_rng(2).uniform(size=(len(POSITIONS), 2)) > 0.3
    tilts = with_estimated_hands(
        BODY, POSITIONS, ROTATIONS, METRES, calibrated=CalibratedTilts(CALIBRATED, np.array([True, False])), seen=seen
    ).hand_tilts
    calibrated = CalibratedTilts(mirror.tilts(CALIBRATED), np.array([False, True]))
    mirrored = with_estimated_hands(
        BODY, positions, rotations, METRES[:, ::-1], calibrated=calibrated, seen=seen[:, ::-1]
    ).hand_tilts
    np.testing.assert_allclose(mirrored, mirror.tilts(tilts), atol=1e-9)
