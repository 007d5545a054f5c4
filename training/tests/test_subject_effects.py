"""Facts about per-subject random effects, which are learned beside the network."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from threepoint_training.augment import AugmentConfig, BodyParts, draw_batch
from threepoint_training.chest_features import CHEST_FEATURES
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.model import FLIP, CorrectionNetwork
from threepoint_training.subject_effects import SubjectEffects
from threepoint_training.train_learned import TrainLearnedConfig, train

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=3, clips=2, frames=80, seed=6)
PARTS = BodyParts(CORPUS, tuple(CORPUS.people))
BATCH = draw_batch(PARTS, 256, AugmentConfig(), np.random.default_rng(1))
INPUTS, PEOPLE = torch.from_numpy(BATCH.inputs), torch.from_numpy(BATCH.people)


@pytest.fixture
def effects() -> SubjectEffects:
    """Of people who differ in every way that can be told."""
    torch.manual_seed(3)
    effects = SubjectEffects(len(PARTS.people), INPUTS)
    for parameter in effects.parameters():
        torch.nn.init.normal_(parameter, std=0.3)
    return effects


def test_no_subject_has_an_effect_before_training():
    assert SubjectEffects(len(PARTS.people), INPUTS)(INPUTS, PEOPLE).abs().max() == 0


def test_the_effects_of_all_people_on_one_window_are_zero_on_average(effects):
    of_each = [effects(INPUTS, torch.full_like(PEOPLE, person)) for person in range(len(PARTS.people))]
    assert max(float(effect.detach().abs().max()) for effect in of_each) > 0.01
    torch.testing.assert_close(sum(of_each), torch.zeros(len(INPUTS), 6, 3), atol=1e-5, rtol=0)


def test_a_mirrored_body_has_mirrored_arms(effects):
    torch.nn.init.zeros_(effects.trunk)
    network = CorrectionNetwork(len(AugmentConfig().window_frames), 16, 0.0)
    image = (INPUTS[:, network.mirror_column] * network.mirror_sign).view(len(INPUTS), 2, -1)[:, 1]
    moved, mirrored = effects(INPUTS, PEOPLE), effects(image, PEOPLE[:, [0, 2, 1]])
    for left, right in ((0, 1), (2, 3)):
        assert moved[:, right].detach().abs().max() > 1e-3
        torch.testing.assert_close(mirrored[:, left], moved[:, right] * FLIP)
        torch.testing.assert_close(mirrored[:, right], moved[:, left] * FLIP)


def test_an_arm_on_another_s_torso_takes_its_own_effect_with_it(effects):
    torch.nn.init.zeros_(effects.trunk)
    own = effects(INPUTS[:1], torch.tensor([[0, 0, 0]]))
    given = effects(INPUTS[:1], torch.tensor([[0, 2, 0]]))
    left, rest = [0, 2], [1, 3, 4, 5]
    torch.testing.assert_close(given[:, rest], own[:, rest])
    torch.testing.assert_close(given[:, left], effects(INPUTS[:1], torch.tensor([[2, 2, 2]]))[:, left])


def test_how_an_arm_is_held_changes_its_own_elbow_and_nothing_else(effects):
    torch.nn.init.zeros_(effects.trunk)
    with_left_hand_elsewhere = INPUTS.clone()
    with_left_hand_elsewhere[:, -CHEST_FEATURES : -CHEST_FEATURES + 3] += 0.1
    moved = effects(with_left_hand_elsewhere, PEOPLE) - effects(INPUTS, PEOPLE)
    assert moved[:, 0].detach().abs().max() > 1e-3
    torch.testing.assert_close(moved[:, 1:], torch.zeros(len(INPUTS), 5, 3))


def test_at_no_learning_rate_no_subject_has_an_effect():
    config = TrainLearnedConfig(width=16, steps=4, batch=64, effects_learning_rate=0.0)
    networks = [train(CORPUS, tuple(CORPUS.people), replace(config, effects_ridge=ridge)) for ridge in (1e-3, 10.0)]
    states = [network.state_dict() for network in networks]
    for name, value in states[0].items():
        torch.testing.assert_close(value, states[1][name], rtol=0, atol=0)
