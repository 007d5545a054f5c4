"""Per-subject random effects: corrections of each training subject's own, learned beside the network and left out of it.

People are built and hold themselves differently. A network that has to explain that learns to tell the training subjects apart, and a new
wearer is none of them. As in a mixed-effects model (Laird and Ware, Biometrics 38(4), 1982) each training subject therefore has a correction
of their own on top of the shared one: small, by a ridge, and zero on average.
"""

import torch
from torch import Tensor, nn

from .chest_features import ARM_COLUMNS, ARMS, CHEST_FEATURES, REACH_LENGTHS, UP
from .model import ARM_FLIP, FLIP, MOST_DEVIATIONS

# A typical effect [eye heights]; parameters are multiplied by it, and so stay near one.
_EFFECT = 0.02


class SubjectEffects(nn.Module):
    """Corrections of each of `subjects`' own: of shoulders, chest joint and hips, linear in the chest-frame features; of elbows, linear in the
    features of their arm; and a constant one of the shoulder that an arm of this subject hangs from."""

    def __init__(self, subjects: int, inputs: Tensor) -> None:
        """inputs [N, T·46 + 38]: some of the training's, for mean and deviation of the chest-frame features."""
        super().__init__()
        self.trunk = nn.Parameter(torch.zeros(subjects, CHEST_FEATURES + 1, 12))
        # Of a right arm; the elbow from its shoulder.
        self.elbow = nn.Parameter(torch.zeros(subjects, _ARM_FEATURES + 1, 3))
        self.shoulder = nn.Parameter(torch.zeros(subjects, 3))
        features = inputs[:, -CHEST_FEATURES:]
        for name, values in (("trunk", features), ("arm", _as_right_arms(features).flatten(0, 1))):
            self.register_buffer(f"{name}_mean", values.mean(0))
            self.register_buffer(f"{name}_scale", values.std(0).clamp_min(2e-2))

    def forward(self, inputs: Tensor, subjects: Tensor) -> Tensor:
        """What to add to the corrections [N, 6, 3] of windows [N, T·46 + 38], whose torsos, left and right arms are these subjects' [N, 3]."""
        features = inputs[:, -CHEST_FEATURES:]
        torso, arms = subjects[:, 0], subjects[:, 1:]
        trunk = torch.einsum("nf,nfo->no", self._standardised("trunk", features), _centred(self.trunk)[torso]).view(-1, 4, 3)
        right = torch.stack([FLIP, torch.ones(3)])
        shoulders = trunk[:, :2] + right * _centred(self.shoulder)[arms]
        elbows = right * torch.einsum("naf,nafo->nao", self._standardised("arm", _as_right_arms(features)), _centred(self.elbow)[arms])
        return _EFFECT * torch.cat([shoulders + elbows, shoulders, trunk[:, 2:]], dim=1)

    def penalty(self) -> Tensor:
        """The sum of squares that a ridge keeps small."""
        return sum((each.square().sum() for each in self.parameters()), torch.zeros(()))

    def _standardised(self, name: str, features: Tensor) -> Tensor:
        """In standard deviations, at most MOST_DEVIATIONS, and a column of ones for the constant part."""
        mean, scale = getattr(self, f"{name}_mean"), getattr(self, f"{name}_scale")
        return nn.functional.pad(torch.clamp((features - mean) / scale, -MOST_DEVIATIONS, MOST_DEVIATIONS), (0, 1), value=1.0)


# Chest-frame features that are about one arm: reach, two axes of the hand, IK's elbow; the room's up; the reach's length.
_ARM_FEATURES = ARM_COLUMNS + 4
_MIRRORED = torch.cat([ARM_FLIP, FLIP, torch.ones(1)])


def _as_right_arms(features: Tensor) -> Tensor:
    """Both arms [N, 2, 16] of chest-frame features [N, 38], the left one as its mirror image."""
    up = features[:, None, UP].expand(-1, 2, -1)
    arms = torch.cat([features[:, ARMS].view(-1, 2, ARM_COLUMNS), up, features[:, REACH_LENGTHS, None]], dim=2)
    return arms * torch.stack([_MIRRORED, torch.ones(_ARM_FEATURES)])


def _centred(effects: Tensor) -> Tensor:
    """Without what all subjects share, which is the network's."""
    return effects - effects.mean(0)
