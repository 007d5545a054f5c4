"""Facts about the features: what turning, moving, mirroring, growing and another frame rate do to them."""

import numpy as np
import pytest
from threepoint_training import mirror, quaternion, solve_ik
from threepoint_training.chest_features import UP, chest_axes, chest_features
from threepoint_training.features import FEATURES, HANDS, HEAD_AXES, IK_JOINTS, SEEN, frame_features, windowed
from threepoint_training.generated_motion import generate_clip
from threepoint_training.paper_features import euler_yxz, paper_features
from threepoint_training.prepared_corpus import ESTIMATED_JOINTS, JOINTS, Person
from threepoint_training.residual import residual
from threepoint_training.simulate_trackers import TrackerConfig, draw_wearer, simulate
from threepoint_training.skeleton import body_from_calibration

PERSON = Person("test", 1.63, 1.55)
BODY = body_from_calibration(np.array(PERSON.eye_height), np.array(PERSON.arm_span))
SIDE_SWAPPED = [1, 0, 3, 2, 4, 5]


@pytest.fixture(params=range(3))
def motion(request):
    """Tracked points of generated motion that starts turned and away from the origin, and the true six joints."""
    random = np.random.default_rng([5, request.param])
    joints, turns = generate_clip(random, 120, PERSON)
    trackers = TrackerConfig()
    positions, rotations = simulate(joints, turns, draw_wearer(trackers, random), trackers, random)
    return positions, rotations, joints[:, [JOINTS.index(name) for name in ESTIMATED_JOINTS]]


def moved(positions, rotations, yaw, offset):
    turn = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array(yaw))
    return (
        quaternion.rotate(np.broadcast_to(turn, rotations.shape), positions) + offset,
        quaternion.multiply(np.broadcast_to(turn, rotations.shape), rotations),
    )


def mirrored_features(vector):
    """What the features of the mirrored motion must be: sides exchanged, x and the mirrored rotations' signs turned."""
    axis_x, axis_y = np.array([1.0, -1, -1]), np.array([-1.0, 1, 1])
    mirrored = vector.copy()
    mirrored[:, HEAD_AXES] *= np.concatenate([axis_x, axis_y])
    for hand, other in (HANDS, HANDS[::-1]):
        mirrored[:, hand] = vector[:, other] * np.concatenate([axis_y, axis_x, axis_y])
    mirrored[:, SEEN] = vector[:, SEEN][:, ::-1]
    mirrored[:, IK_JOINTS] = (vector[:, IK_JOINTS].reshape(-1, 6, 3)[:, SIDE_SWAPPED] * axis_y).reshape(-1, 18)
    return mirrored


def test_the_vector_has_46_finite_numbers(motion):
    vector, _ = frame_features(*motion[:2], BODY)
    assert vector.shape == (120, FEATURES)
    assert np.isfinite(vector).all()


@pytest.mark.parametrize("yaw", [-3.0, -1.2, 0.4, 2.9])
def test_walking_elsewhere_and_turning_changes_no_feature(motion, yaw):
    positions, rotations, truth = motion
    elsewhere = moved(positions, rotations, yaw, np.array([3.0, 0.0, -7.0]))
    before, joints = frame_features(positions, rotations, BODY)
    after, turned_joints = frame_features(*elsewhere, BODY)
    np.testing.assert_allclose(after, before, atol=1e-9)
    np.testing.assert_allclose(turned_joints, joints, atol=1e-9)
    turned_truth, _ = moved(truth, np.broadcast_to(rotations[:, :1], (120, 6, 4)), yaw, np.array([3.0, 0.0, -7.0]))
    np.testing.assert_allclose(
        residual(turned_truth, *elsewhere, BODY, after), residual(truth, positions, rotations, BODY, before), atol=1e-9
    )


def test_the_paper_s_input_does_not_turn_or_move_with_the_person(motion):
    positions, rotations, _ = motion
    elsewhere = moved(positions, rotations, 1.0, np.array([2.0, 0.0, 5.0]))
    before, after = (paper_features(*solve_ik.to_heading(*each)[:2]) for each in ((positions, rotations), elsewhere))
    np.testing.assert_allclose(after, before, atol=1e-9)


def test_the_mirror_image_has_the_mirrored_features(motion):
    positions, rotations, _ = motion
    seen = np.random.default_rng(2).uniform(size=(120, 2)) > 0.3
    vector, _ = frame_features(positions, rotations, BODY, seen)
    mirrored_positions, mirrored_rotations = mirror.trackers(positions, rotations)
    mirrored, _ = frame_features(mirrored_positions, mirrored_rotations, BODY, seen[:, ::-1])
    np.testing.assert_allclose(mirrored, mirrored_features(vector), atol=1e-9)


@pytest.mark.parametrize("size", [0.7, 1.3])
def test_a_child_in_an_adult_s_pose_has_the_adult_s_features(motion, size):
    positions, rotations, truth = motion
    grown = body_from_calibration(np.array(PERSON.eye_height * size), np.array(PERSON.arm_span * size))
    before, _ = frame_features(positions, rotations, BODY)
    after, _ = frame_features(positions * size, rotations, grown)
    np.testing.assert_allclose(after, before, atol=1e-6)
    np.testing.assert_allclose(
        residual(truth * size, positions * size, rotations, grown, after),
        residual(truth, positions, rotations, BODY, before),
        atol=1e-9,
    )


def test_an_unseen_hand_says_so_and_changes_nothing_else(motion):
    seen = np.ones((120, 2), bool)
    seen[:, 0] = False
    with_hand, _ = frame_features(*motion[:2], BODY)
    without, _ = frame_features(*motion[:2], BODY, seen)
    assert np.flatnonzero((with_hand != without).any(axis=0)).tolist() == [SEEN.start]


def test_the_ik_joints_within_are_those_of_the_solver(motion):
    positions, rotations, _ = motion
    vector, joints = frame_features(positions, rotations, BODY)
    local, turns, _, _ = solve_ik.to_heading(positions, rotations)
    expected = (solve_ik.solve(local, turns, BODY) - local[:, :1]) / PERSON.eye_height
    np.testing.assert_allclose(vector[:, IK_JOINTS].reshape(-1, 6, 3), expected, atol=1e-12)
    np.testing.assert_allclose((joints - local[:, :1]) / PERSON.eye_height, expected, atol=1e-12)


@pytest.mark.parametrize("rate", [60, 72, 90, 120])
def test_the_window_means_the_same_at_every_frame_rate(rate):
    """The features change linearly, and every rate samples the compared moment."""
    slope = np.random.default_rng(4).normal(size=FEATURES)
    times = np.arange(rate + 1) / rate
    window = windowed(times[:, None] * slope, times, (0.0, 0.1, 0.25))
    np.testing.assert_allclose(window[-1].reshape(3, -1), np.array([1.0, 0.9, 0.75])[:, None] * slope, atol=1e-12)


def test_before_there_is_a_history_the_oldest_frame_stands_in():
    vector = np.arange(5.0)[:, None] * np.ones(FEATURES)
    window = windowed(vector, np.arange(5) / 60, (0.0, 0.1, 0.25)).reshape(5, 3, -1)
    np.testing.assert_array_equal(window[:, 0], vector)
    np.testing.assert_array_equal(window[:, 1:], 0)
    alone = windowed(vector[:1], np.zeros(1), (0.0, 0.1))
    np.testing.assert_array_equal(alone, np.concatenate([vector[:1], vector[:1]], 1))


def test_euler_angles_compose_to_the_rotation():
    rotations = np.random.default_rng(6).normal(size=(200, 4))
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    angles = euler_yxz(rotations)
    x, y, z = (
        quaternion.from_axis_angle(np.broadcast_to(np.eye(3)[axis], (200, 3)), angles[:, axis]) for axis in range(3)
    )
    composed = quaternion.multiply(quaternion.multiply(y, x), z)
    np.testing.assert_allclose(np.abs(np.sum(composed * rotations, axis=-1)), 1, atol=1e-9)


def test_looking_straight_down_or_up_keeps_the_heading():
    """Towards the end of a bow the gaze is vertical; the heading comes from the ears, not from the gaze."""
    for pitch in np.radians([-89.9, -90.0, -90.1, 90.0]):
        yaw = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array(0.7))
        head = quaternion.multiply(yaw, quaternion.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.array(pitch)))
        np.testing.assert_allclose(quaternion.heading(head[None])[0], yaw, atol=1e-6)


def turned_about_the_headset(vector: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Features [F, 46] of hands and IK joints that turn about the headset; the head's own axes turn too."""
    turned = vector.copy()
    for part in (HEAD_AXES, *HANDS, IK_JOINTS):
        vectors = vector[:, part].reshape(len(vector), -1, 3)
        turned[:, part] = quaternion.rotate(np.broadcast_to(q, (*vectors.shape[:-1], 4)), vectors).reshape(
            len(vector), -1
        )
    return turned


def test_chest_frame_features_do_not_change_as_a_body_turns_and_leans(motion):
    vector, _ = frame_features(*motion[:2], BODY)
    q = quaternion.from_rotation_vector(np.array([0.4, -0.9, 0.2]))
    before, after = chest_features(vector), chest_features(turned_about_the_headset(vector, q))
    # All but which way the room's up is.
    assert np.abs(after[:, UP] - before[:, UP]).max() > 0.1
    after[:, UP] = before[:, UP]
    np.testing.assert_allclose(after, before, atol=1e-9)


def test_a_chest_s_axes_are_a_right_handed_frame_along_shoulders_and_spine(motion):
    vector, joints = frame_features(*motion[:2], BODY)
    axes = chest_axes(vector)
    np.testing.assert_allclose(axes @ np.swapaxes(axes, 1, 2), np.broadcast_to(np.eye(3), axes.shape), atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(axes), 1.0)
    assert (np.einsum("fi,fi->f", axes[:, 0], joints[:, 3] - joints[:, 2]) > 0.2).all()
    assert (np.einsum("fi,fi->f", axes[:, 1], (joints[:, 2] + joints[:, 3]) / 2 - joints[:, 4]) > 0.1).all()


def test_the_residual_is_what_to_add_to_ik(motion):
    positions, rotations = motion[:2]
    vector, joints = frame_features(positions, rotations, BODY)
    yaw, origin = quaternion.heading(rotations[:, 0]), positions[:, 0] * [1, 0, 1]
    floor = quaternion.rotate(np.broadcast_to(yaw[:, None], (*joints.shape[:-1], 4)), joints) + origin[:, None]
    up = np.array([0.0, 0.03, 0.0])
    np.testing.assert_allclose(residual(floor, positions, rotations, BODY, vector), 0.0, atol=1e-12)
    answer = residual(floor + up, positions, rotations, BODY, vector).reshape(-1, 6, 3)
    np.testing.assert_allclose(
        answer, 0.03 / BODY.eye_height[0] * np.repeat(chest_axes(vector)[:, None, :, 1], 6, axis=1), atol=1e-12
    )
