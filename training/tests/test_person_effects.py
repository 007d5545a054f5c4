"""Facts about what is learned of each person trained on, beside the network."""

import numpy as np
import pytest
import torch
from threepoint_training.augment import AugmentConfig, BodyParts, draw_batch
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.person_effects import PersonEffects

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=3, clips=2, frames=80, seed=6)
PARTS = BodyParts(CORPUS, tuple(CORPUS.people))
BATCH = draw_batch(PARTS, 256, AugmentConfig(), np.random.default_rng(1))
INPUTS, PEOPLE = torch.from_numpy(BATCH.inputs), torch.from_numpy(BATCH.people)
FLIP = torch.tensor([-1.0, 1.0, 1.0])


@pytest.fixture
def effects() -> PersonEffects:
    """Of people who differ in every way that can be told."""
    torch.manual_seed(3)
    effects = PersonEffects(len(PARTS.people), INPUTS)
    for parameter in effects.parameters():
        torch.nn.init.normal_(parameter, std=0.3)
    return effects


def test_nobody_has_an_effect_before_training():
    assert PersonEffects(len(PARTS.people), INPUTS)(INPUTS, PEOPLE).abs().max() == 0


def test_the_effects_of_all_people_on_one_window_are_zero_on_average(effects):
    of_each = [effects(INPUTS, torch.full_like(PEOPLE, person)) for person in range(len(PARTS.people))]
    assert max(float(effect.detach().abs().max()) for effect in of_each) > 0.01
    torch.testing.assert_close(sum(of_each), torch.zeros(len(INPUTS), 6, 3), atol=1e-5, rtol=0)


def test_somebody_s_left_arm_is_the_mirror_image_of_the_right_one(effects):
    torch.nn.init.zeros_(effects.trunk)
    moved = effects(INPUTS, PEOPLE.new_tensor([[0, 1, 1]]).expand(len(INPUTS), 3))
    for left, right in ((0, 1), (2, 3)):
        assert moved[:, right].detach().abs().max() > 1e-3
        torch.testing.assert_close(moved[:, left], moved[:, right] * FLIP)


def test_an_arm_on_another_s_torso_takes_its_own_effect_with_it(effects):
    torch.nn.init.zeros_(effects.trunk)
    own = effects(INPUTS[:1], torch.tensor([[0, 0, 0]]))
    given = effects(INPUTS[:1], torch.tensor([[0, 2, 0]]))
    left, rest = [0, 2], [1, 3, 4, 5]
    torch.testing.assert_close(given[:, rest], own[:, rest])
    torch.testing.assert_close(given[:, left], effects(INPUTS[:1], torch.tensor([[2, 2, 2]]))[:, left])
