"""Facts about inverse kinematics as the page runs it."""

import numpy as np
import pytest
from ik_errors import errors_cm
from threepoint_training import fit_ik, mirror, quaternion, solve_ik
from threepoint_training.generated_motion import generate_clip
from threepoint_training.prepared_corpus import Person
from threepoint_training.simulate_trackers import TrackerConfig, draw_wearer, simulate
from threepoint_training.skeleton import body_from_calibration, load_proportions, rest_offsets

EYES, SPAN = 1.6, 1.53
BODY = body_from_calibration(np.array(EYES), np.array(SPAN))
LEFT_ELBOW, RIGHT_ELBOW, LEFT_SHOULDER, RIGHT_SHOULDER, CHEST, HIPS = range(6)
# Knuckles down, thumbs forward: hands of arms that hang.
HANGING = {
    sign: quaternion.from_matrix(np.array([[0.0, sign, 0.0], [0.0, 0.0, 1.0], [sign, 0.0, 0.0]]))
    for sign in (-1.0, 1.0)
}


def pose(left, right, head=(0.0, EYES, 0.0), pitch=0.0):
    """The six joints with wrists at these points [m]; hands as in hanging arms."""
    gaze = quaternion.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.array(np.radians(pitch)))
    positions = np.array([[head, left, right]], np.float64)
    return solve_ik.solve(positions, np.stack([gaze, HANGING[-1.0], HANGING[1.0]])[None], BODY)[0]


def symmetric(x, y, z, **head):
    return pose((-x, y, z), (x, y, z), **head)


STANDING = symmetric(0.22, 0.82, -0.02)


@pytest.fixture(params=range(3))
def motion(request):
    random = np.random.default_rng([8, request.param])
    joints, turns = generate_clip(random, 200, Person("test", EYES, SPAN))
    trackers = TrackerConfig()
    positions, rotations = simulate(joints, turns, draw_wearer(trackers, random), trackers, random)
    return solve_ik.to_heading(positions, rotations)[:2]


def test_who_stands_upright_has_the_pelvis_under_the_head_at_the_height_of_hips():
    hips = STANDING[HIPS]
    assert abs(hips[0]) < 1e-9
    assert 0 < hips[2] < 0.2  # The eyes are ten centimetres before the spine.
    assert hips[1] == pytest.approx(load_proportions()["hipsHeight"] * EYES, abs=0.05)
    assert hips[1] < STANDING[CHEST][1] < STANDING[LEFT_SHOULDER][1] < EYES


def test_shoulders_are_a_shoulder_width_apart():
    width = STANDING[RIGHT_SHOULDER][0] - STANDING[LEFT_SHOULDER][0]
    assert width == pytest.approx(2 * float(BODY.shoulder[0]), abs=0.06)


def test_elbows_point_down_when_the_hands_are_held_before_the_chest():
    joints = symmetric(0.2, 1.2, -0.35)
    for elbow, shoulder in ((LEFT_ELBOW, LEFT_SHOULDER), (RIGHT_ELBOW, RIGHT_SHOULDER)):
        assert joints[elbow][1] < (joints[shoulder][1] + 1.2) / 2


def test_elbows_point_backward_when_the_hands_rest_at_the_hips():
    joints = symmetric(0.2, 1.0, -0.05)
    for elbow, shoulder, sign in ((LEFT_ELBOW, LEFT_SHOULDER, -1), (RIGHT_ELBOW, RIGHT_SHOULDER, 1)):
        halfway = (joints[shoulder] + [sign * 0.2, 1.0, -0.05]) / 2
        assert joints[elbow][2] > halfway[2]
        assert joints[elbow][1] < joints[shoulder][1]
        assert sign * joints[elbow][0] > 0.1


def test_a_hand_out_of_reach_has_a_straight_arm_towards_it():
    far = np.array([1.6, 1.3, -0.6])
    joints = pose((-0.22, 0.82, 0.0), far)
    arm = joints[RIGHT_ELBOW] - joints[RIGHT_SHOULDER]
    wanted = far - joints[RIGHT_SHOULDER]
    assert np.dot(arm, wanted) / np.linalg.norm(arm) / np.linalg.norm(wanted) == pytest.approx(1, abs=1e-3)


def test_bowing_puts_the_hips_behind_the_head():
    joints = symmetric(0.2, 0.5, -0.5, head=(0.0, 1.1, 0.0), pitch=-60)
    assert joints[HIPS][2] > 0.2
    assert joints[HIPS][1] < STANDING[HIPS][1] + 0.02


def test_hips_never_sink_into_the_floor():
    for height in (0.0, 0.1, 0.3, 0.5):
        assert symmetric(0.2, 0.1, -0.2, head=(0.0, height, 0.0))[HIPS][1] >= 0.08 * EYES - 1e-9


def test_both_hands_to_the_right_turn_the_chest_to_the_right():
    joints = pose((0.1, 1.1, -0.4), (0.5, 1.1, -0.1))
    across = joints[RIGHT_SHOULDER] - joints[LEFT_SHOULDER]
    assert across[2] > 0.05  # Facing −Z, turning right brings the right shoulder back.


@pytest.mark.parametrize("body", [BODY, BODY.with_forearms(np.array([0.2, 0.32]))])
def test_bone_lengths_are_those_of_the_calibrated_body(motion, body):
    joints = solve_ik.solve(*motion, body)
    for side, (elbow, shoulder, hand) in enumerate(((LEFT_ELBOW, LEFT_SHOULDER, 1), (RIGHT_ELBOW, RIGHT_SHOULDER, 2))):
        upper = np.linalg.norm(joints[:, elbow] - joints[:, shoulder], axis=-1)
        np.testing.assert_allclose(upper, float(body.upper_arm[side]), rtol=1e-6)
        wrist = motion[0][:, hand]
        reach = np.linalg.norm(wrist - joints[:, shoulder], axis=-1)
        within = reach < float(BODY.arm[0]) * 0.999
        assert within.sum() > 20
        forearm = np.linalg.norm(wrist - joints[:, elbow], axis=-1)
        np.testing.assert_allclose(forearm[within], float(body.forearm[side]), rtol=1e-6)
    np.testing.assert_allclose(
        np.linalg.norm(joints[:, CHEST] - joints[:, HIPS], axis=-1), float(BODY.lower_back[0]), rtol=1e-6
    )


def test_the_mirror_image_has_the_mirrored_body(motion):
    positions, rotations = motion
    joints = solve_ik.solve(positions, rotations, BODY)
    mirrored_positions, mirrored_rotations = mirror.trackers(positions, rotations)
    np.testing.assert_allclose(
        solve_ik.solve(mirrored_positions, mirrored_rotations, BODY), mirror.joints(joints), atol=1e-9
    )


def test_finite_wherever_the_hands_are():
    """Hands in the shoulder, in the head, together, far away, below the floor; the head upside down."""
    random = np.random.default_rng(9)
    positions = random.normal(size=(2000, 3, 3)) * 0.6 + [0, 1.2, 0]
    positions[:200, 1] = positions[:200, 0]
    positions[200:400, 2] = positions[200:400, 1]
    positions[400:600, 1:] *= 50
    rotations = random.normal(size=(2000, 3, 4))
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    joints = solve_ik.solve(*solve_ik.to_heading(positions, rotations)[:2], BODY)
    assert np.isfinite(joints).all()


def test_fitting_finds_the_parameters_that_made_the_motion(motion):
    """From the prior, towards bodies that IK itself posed."""
    positions, rotations = motion
    truth = solve_ik.solve(positions, rotations, BODY)
    frames = fit_ik.Sample(positions, rotations, truth, BODY, np.full(len(truth), "test"))
    start = errors_cm(frames, fit_ik.PRIOR).mean()
    fitted = fit_ik.fit(frames, fit_ik.FitIkConfig(iterations=8, ridge=1e-7))
    assert errors_cm(frames, fitted).mean() < 0.2 * start


def test_parameters_survive_the_way_through_a_vector():
    parameters = solve_ik.load_parameters()
    assert fit_ik.unflatten(fit_ik.flatten(parameters)) == parameters


def test_the_rest_skeleton_stands_as_tall_as_its_calibration():
    offsets = rest_offsets(BODY)
    spine = ["hips", "spine", "chest", "upperChest", "neck", "head", "eyesInHead"]
    assert sum(offsets[joint][1] for joint in spine) == pytest.approx(EYES, abs=0.04)
    wrist = sum(offsets[f"right{joint}"][0] for joint in ("Shoulder", "UpperArm", "LowerArm", "Hand"))
    assert 2 * wrist == pytest.approx(SPAN, abs=0.03)
