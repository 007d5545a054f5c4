"""Facts about torso and arm fitting as the loss has it; tests/threepoint/core/estimation/fitted-joints.test.ts holds it
to the page's own.
"""

import numpy as np
import pytest
import torch
from golden_file import assert_as_committed
from threepoint_training import golden
from threepoint_training.augment import AugmentConfig, draw_batch
from threepoint_training.body_parts import BodyParts
from threepoint_training.chest_features import ARM_COLUMNS, ARMS, CHEST_FEATURES, REACH_LENGTHS
from threepoint_training.differentiable_kinematics import DifferentiableKinematics
from threepoint_training.features import ARM_LENGTH, IK_JOINTS
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.skeleton import load_proportions
from threepoint_training.train_learned import (
    HeldOut,
    fitted_errors_cm,
    held_out,
    ik_errors_cm,
    mean_distances,
    raw_errors_cm,
)

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=2, clips=1, frames=200, seed=4)
PEOPLE = held_out(CORPUS, tuple(CORPUS.people), (0.0, 0.1, 0.25))
INPUTS = torch.from_numpy(PEOPLE.inputs)


def corrections_of(size: float) -> torch.Tensor:
    return size * torch.randn((len(INPUTS), 6, 3), generator=torch.Generator().manual_seed(3))


def test_the_committed_vectors_are_those_that_this_code_makes():
    assert_as_committed("fitted-joints.json", golden.fitted_vectors(), atol=1e-7)


def test_ik_stays_within_a_centimetre_where_hands_are_in_reach():
    moved = DifferentiableKinematics()(torch.zeros(len(INPUTS), 6, 3), INPUTS)
    in_reach = (INPUTS[:, -CHEST_FEATURES:][:, REACH_LENGTHS] < 0.99).all(1)
    assert in_reach.sum() > 50
    torch.testing.assert_close(moved[in_reach], torch.zeros_like(moved[in_reach]), atol=6.5e-3, rtol=0)


@pytest.mark.parametrize("typed", [False, True])
def test_elbows_lie_where_both_bones_let_them_be(typed):
    """The calibrated ones, whether the forearm is typed or the average's."""
    config = AugmentConfig(typed_forearms=float(typed))
    people = draw_batch(BodyParts(CORPUS, tuple(CORPUS.people)), 200, config, np.random.default_rng(4))
    inputs = torch.from_numpy(people.inputs)
    fitted = DifferentiableKinematics()(corrections_of(0.02)[: len(inputs)], inputs).numpy()
    elbow_shift, shoulder_shift = fitted[:, :2], fitted[:, 2:4]
    arm = people.inputs[:, ARM_LENGTH]
    ik = people.inputs[:, IK_JOINTS].reshape(-1, 6, 3)
    upper = np.linalg.norm(ik[:, 0] - ik[:, 2], axis=1)
    average = load_proportions()["upperArmShare"]
    assert (np.abs(upper / arm - average).max() > 1e-4) == typed
    arms = people.inputs[:, -CHEST_FEATURES:][:, ARMS].reshape(-1, 2, ARM_COLUMNS // 3, 3)
    for side in (0, 1):
        # From IK's shoulder, chest frame.
        wrist, elbow, shoulder = (
            arms[:, side, 0] * arm[:, None],
            arms[:, side, 3] + elbow_shift[:, side],
            shoulder_shift[:, side],
        )
        reachable = np.linalg.norm(wrist - shoulder, axis=1) < 0.95 * arm
        assert reachable.sum() > 50
        for end, bone in ((wrist, arm - upper), (shoulder, upper)):
            length = np.linalg.norm(end - elbow, axis=1)
            np.testing.assert_allclose(length[reachable], bone[reachable], atol=1e-3)


def test_gradients_are_finite_wherever_joints_are_estimated():
    for size in (0.0, 0.02, 1.0):
        corrections = corrections_of(size).requires_grad_()
        DifferentiableKinematics()(corrections, INPUTS).square().sum().backward()
        assert corrections.grad is not None
        assert corrections.grad.isfinite().all()


def test_errors_are_those_of_joints_on_their_bones():
    """A pelvis estimated a forearm lower is fitted where IK had it: bones are as long as they are."""
    below = np.zeros((1, 6, 3), np.float32)
    below[:, 5, 1] = -0.1
    there = HeldOut(PEOPLE.inputs, np.zeros_like(PEOPLE.targets), PEOPLE.eye_height, PEOPLE.people, PEOPLE.clips)
    assert raw_errors_cm(below.reshape(1, 18), there)[:, 5].min() > 10
    np.testing.assert_allclose(
        fitted_errors_cm(below.reshape(1, 18), there)[:, :5], ik_errors_cm(there)[:, :5], atol=1e-3
    )
    assert np.median(fitted_errors_cm(below.reshape(1, 18), there)[:, 5]) < 3


def test_elbows_count_in_the_loss_for_what_their_share_says():
    """A third is every joint alike."""
    away = torch.zeros(10, 6, 3)
    away[:, :2, 0], away[:, 2:, 1] = 3.0, 1.5
    still = torch.zeros_like(away)
    torch.testing.assert_close(mean_distances(away, still), torch.full((10,), (2 * 3.0 + 4 * 1.5) / 6))
    torch.testing.assert_close(mean_distances(away, still, 0.8), torch.full((10,), 0.8 * 3.0 + 0.2 * 1.5))
