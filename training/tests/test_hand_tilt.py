"""Facts about how hands stand to their forearms."""

from dataclasses import replace

import numpy as np
import pytest
from ik_errors import errors_cm
from threepoint_training import fit_ik, fitted_kinematics, hand_tilt, mirror, quaternion, solve_ik
from threepoint_training.features import frame_features
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.simulate_trackers import TrackerConfig, measured_tilts
from threepoint_training.skeleton import body_from_calibration, load_proportions

CORPUS = generate_corpus(people=2, clips=3, frames=90, seed=12)
BODY = body_from_calibration(np.array(1.6), np.array(1.52))
RANDOM = np.random.default_rng(3)
TILTS = RANDOM.normal(size=(50, 2)) * 0.4


def worn_off(corpus, left, right):
    """Returns the corpus with its hands rotated against their forearms."""
    turns = quaternion.from_rotation_vector(np.array([[0.0, 0.0, 0.0], left, right]))
    return replace(corpus, rotations=quaternion.multiply(corpus.rotations.astype(np.float64), turns).astype(np.float32))


def test_a_tilt_is_where_its_turn_takes_minus_z():
    along = np.broadcast_to([0.0, 0.0, -1.0], (50, 3))
    directions = quaternion.rotate(hand_tilt.turn_of(TILTS), along)
    np.testing.assert_allclose(hand_tilt.direction_of(TILTS), directions, atol=1e-12)
    np.testing.assert_allclose(hand_tilt.tilt_of(directions), TILTS, atol=1e-12)
    up, left = quaternion.rotate(hand_tilt.turn_of(np.array([[0.3, 0.0], [0.0, 0.3]])), along[:2])
    assert up[1] > 0.2
    assert left[0] < -0.2


def test_a_tracker_that_is_turned_sees_the_tilt_that_undoes_it():
    """−Z of the tracker, turned by that tilt, lies along the same forearm."""
    worn = quaternion.from_rotation_vector(RANDOM.normal(size=(50, 3)) * 0.2)
    along = np.broadcast_to([0.0, 0.0, -1.0], (50, 3))
    seen = quaternion.multiply(worn, hand_tilt.turn_of(hand_tilt.turned(TILTS, worn)))
    np.testing.assert_allclose(
        quaternion.rotate(seen, along), quaternion.rotate(hand_tilt.turn_of(TILTS), along), atol=1e-12
    )


def test_what_is_measured_of_a_clip_comes_from_the_others():
    forearms = hand_tilt.ForearmMeans(CORPUS, ("002",))
    clips = CORPUS.clips_of({"002"})
    rotations = CORPUS.rotations.copy()
    rotations[CORPUS.clip_slice(clips[0])] = quaternion.multiply(
        rotations[CORPUS.clip_slice(clips[0])].astype(np.float64),
        quaternion.from_rotation_vector(np.array([0.6, 0.0, 0.0])),
    )
    changed = hand_tilt.ForearmMeans(replace(CORPUS, rotations=rotations), ("002",))
    np.testing.assert_array_equal(changed.elsewhere(clips[0]), forearms.elsewhere(clips[0]))
    assert np.abs(changed.elsewhere(clips[1]) - forearms.elsewhere(clips[1])).max() > 0.1


def test_with_exact_tilts_it_does_not_matter_how_hands_are_worn():
    """Rotations about the forearm are excluded, because this calibration does not measure them."""
    positions, rotations = (
        part[:90].astype(np.float64) for part in (CORPUS.positions[:, [4, 7, 10]], CORPUS.rotations)
    )
    tilts = np.array([[0.3, -0.2], [-0.1, 0.4]])
    worn = quaternion.conjugate(hand_tilt.turn_of(tilts))
    turned = rotations.copy()
    turned[:, 1:] = quaternion.multiply(rotations[:, 1:], np.broadcast_to(worn, (90, 2, 4)))
    as_they_are, _ = frame_features(positions, rotations, BODY.with_hands(np.zeros((2, 2))))
    put_right, _ = frame_features(positions, turned, BODY.with_hands(tilts))
    np.testing.assert_allclose(put_right, as_they_are, atol=1e-9)


def test_the_calibration_errs_by_its_standard_deviation():
    errors = measured_tilts(
        np.zeros((4000, 2)), np.broadcast_to([0.0, 0.0, 0.0, 1.0], (4000, 4)), TrackerConfig(), RANDOM
    )
    assert np.sqrt((errors**2).sum(axis=1).mean()) == pytest.approx(TrackerConfig().hand_tilt_error, rel=0.05)


def test_ik_of_turned_hands_is_fitted_beside_that_of_hands_as_they_come():
    """Towards bodies that IK itself posed, every other frame with turned hands: each pole is found by its own frames.
    """
    tracked = CORPUS.positions[::3, [4, 7, 10]].astype(np.float64), CORPUS.rotations[::3].astype(np.float64)
    positions, rotations, _, _ = solve_ik.to_heading(*tracked)
    are_turned = np.broadcast_to(np.arange(len(positions))[:, None] % 2 == 1, (len(positions), 2))
    body = replace(BODY, hands_turned=are_turned)
    truth = solve_ik.solve(positions, rotations, body)
    frames = fit_ik.Sample(positions, rotations, truth, body, np.full(len(truth), "test"))
    fitted = fit_ik.fit(frames, fit_ik.FitIkConfig(iterations=8, ridge=1e-7))
    elbows = errors_cm(frames, fitted)[:, :2].mean()
    mistaken = replace(frames, body=replace(BODY, hands_turned=~are_turned))
    assert elbows < 0.5 * errors_cm(mistaken, fitted)[:, :2].mean()
    assert fit_ik.unflatten(fit_ik.flatten(fitted)) == fitted


def test_a_fit_sees_hands_of_both_kinds():
    """Proportions are the page's; half of the frames have hands that are turned by their tilts."""
    frames = fit_ik.sample(
        worn_off(CORPUS, [0.5, 0.0, 0.0], [0.5, 0.0, 0.0]), ("002",), load_proportions(), None, 1, mirrored=False
    )
    turned = frames.body.hands_turned.all(axis=1)
    np.testing.assert_array_equal(turned, frames.body.hands_turned.any(axis=1))
    assert turned.mean() == pytest.approx(0.5, abs=0.01)
    forearms = frames.positions[:, 1] - frames.truth[:, 0]
    forearms /= np.linalg.norm(forearms, axis=-1, keepdims=True)
    along = quaternion.rotate(frames.rotations[:, 1], np.broadcast_to([0.0, 0.0, -1.0], forearms.shape))
    bend = np.degrees(np.arccos(np.clip(np.sum(along * forearms, axis=-1), -1, 1)))
    assert np.median(bend[turned]) < 0.8 * np.median(bend[~turned])


def test_the_usual_tilt_is_that_of_people_s_right_hands_and_of_their_left_ones_in_a_mirror():
    """Worn off by a tilt, hands are found to have it besides the little that generated ones have."""
    tilt = np.array([0.3, -0.2])
    off = [np.append(-each, 0.0) for each in (tilt * mirror.TILT, tilt)]
    before, after = (
        fitted_kinematics.fit_proportions(corpus, tuple(CORPUS.people))["handTilt"] for corpus in (CORPUS, worn_off(CORPUS, *off))
    )
    np.testing.assert_allclose(np.subtract(after, before), tilt, atol=0.01)
