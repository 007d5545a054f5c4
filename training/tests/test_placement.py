"""Facts about where the page's skeleton puts joints, as the loss has it; tests/core/estimation/placement.test.ts holds it to the page's own."""

import json

import numpy as np
import pytest
import torch
from threepoint_training import golden
from threepoint_training.features import CHEST_FEATURES
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.placement import Placement
from threepoint_training.skeleton import body_from_calibration
from threepoint_training.train_learned import HeldOut, errors_cm, held_out, ik_errors_cm, said_errors_cm

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=2, clips=1, frames=200, seed=4)
SEEN = held_out(CORPUS, tuple(CORPUS.people), (0.0, 0.1, 0.25))
INPUTS = torch.from_numpy(SEEN.inputs)


def said(size: float) -> torch.Tensor:
    return size * torch.randn((len(INPUTS), 6, 3), generator=torch.Generator().manual_seed(3))


def test_the_committed_vectors_are_those_that_this_code_makes():
    committed = json.loads((golden.GOLDEN / "placement.json").read_text())
    now = json.loads(json.dumps(golden._plain(golden.placement_vectors())))
    for before, after in zip(committed, now, strict=True):
        for one, other in zip(before["frames"], after["frames"], strict=True):
            for key in ("positions", "rotations", "estimated", "placed"):
                np.testing.assert_allclose(one[key], other[key], atol=1e-5, err_msg=key)


def test_what_ik_says_stays_within_a_centimetre_where_hands_are_in_reach():
    moved = Placement()(torch.zeros(len(INPUTS), 6, 3), INPUTS)
    in_reach = (INPUTS[:, -2:] < 0.99).all(1)
    assert in_reach.sum() > 50
    torch.testing.assert_close(moved[in_reach], torch.zeros_like(moved[in_reach]), atol=6.5e-3, rtol=0)


def test_elbows_lie_where_both_bones_let_them_be():
    came_to = Placement()(said(0.02), INPUTS).numpy()
    elbow_shift, shoulder_shift = came_to[:, :2], came_to[:, 2:4]
    arm = SEEN.inputs[:, 45]
    person = next(iter(CORPUS.people.values()))
    body = body_from_calibration(np.array(person.eye_height), np.array(person.arm_span))
    share = float(body.upper_arm[0] / body.arm[0])
    arms = SEEN.inputs[:, -CHEST_FEATURES:][:, :24].reshape(-1, 2, 4, 3)
    for side in (0, 1):
        # From IK's shoulder, as its chest sees them.
        wrist, elbow, shoulder = arms[:, side, 0] * arm[:, None], arms[:, side, 3] + elbow_shift[:, side], shoulder_shift[:, side]
        reachable = np.linalg.norm(wrist - shoulder, axis=1) < 0.95 * arm
        assert reachable.sum() > 50
        for end, bone in ((wrist, 1 - share), (shoulder, share)):
            length = np.linalg.norm(end - elbow, axis=1)
            np.testing.assert_allclose(length[reachable], bone * arm[reachable], atol=1e-3)


def test_gradients_are_finite_wherever_joints_are_said_to_be():
    for size in (0.0, 0.02, 1.0):
        corrections = said(size).requires_grad_()
        Placement()(corrections, INPUTS).square().sum().backward()
        assert corrections.grad is not None
        assert corrections.grad.isfinite().all()


def test_errors_are_those_of_joints_on_their_bones():
    """A pelvis that is said a forearm lower is placed where IK had it: bones are as long as they are."""
    below = np.zeros((1, 6, 3), np.float32)
    below[:, 5, 1] = -0.1
    there = HeldOut(SEEN.inputs, np.zeros_like(SEEN.targets), SEEN.eye_height, SEEN.people, SEEN.clips)
    assert said_errors_cm(below.reshape(1, 18), there)[:, 5].min() > 10
    np.testing.assert_allclose(errors_cm(below.reshape(1, 18), there)[:, :5], ik_errors_cm(there)[:, :5], atol=1e-3)
    assert np.median(errors_cm(below.reshape(1, 18), there)[:, 5]) < 3
