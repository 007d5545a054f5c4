"""What is one person's own, learned beside the network and left out of it.

People are built and hold themselves differently. A network that has to explain that learns who is who, and nobody new is any of them. As in
a mixed-effects model everybody trained on therefore has a correction of their own on top of what holds for all: small, by a ridge, and zero
on average.
"""

import torch
from torch import Tensor, nn

from .features import CHEST_FEATURES
from .model import FLIP

# An everyday effect in eye heights: keeps the parameters near one.
_EFFECT = 0.02


class PersonEffects(nn.Module):
    """Of each of `people` persons: how the corrections of shoulders, chest joint and hips go with what IK's chest sees, and where the own arms'
    shoulders and elbows are."""

    def __init__(self, people: int, inputs: Tensor) -> None:
        """inputs [N, T·46 + 38]: some of the training's, for mean and deviation of what the chest sees."""
        super().__init__()
        self.trunk = nn.Parameter(torch.zeros(people, CHEST_FEATURES + 1, 12))
        # Shoulder and elbow of a right arm, the elbow from its shoulder.
        self.arm = nn.Parameter(torch.zeros(people, 2, 3))
        seen = inputs[:, -CHEST_FEATURES:]
        self.register_buffer("mean", seen.mean(0))
        self.register_buffer("scale", seen.std(0).clamp_min(2e-2))

    def forward(self, inputs: Tensor, people: Tensor) -> Tensor:
        """What to add to the corrections [N, 6, 3] of windows [N, T·46 + 38] of these people's torsos, left and right arms [N, 3]."""
        seen = torch.clamp((inputs[:, -CHEST_FEATURES:] - self.mean) / self.scale, -4.0, 4.0)
        told = torch.cat([seen, torch.ones(len(seen), 1)], dim=1)
        trunk = torch.einsum("nf,nfo->no", told, _centred(self.trunk)[people[:, 0]]).view(-1, 4, 3)
        arms = _centred(self.arm)[people[:, 1:]] * torch.stack([FLIP, torch.ones(3)])[:, None]
        shoulders = trunk[:, :2] + arms[:, :, 0]
        return _EFFECT * torch.cat([shoulders + arms[:, :, 1], shoulders, trunk[:, 2:]], dim=1)

    def size(self) -> Tensor:
        """The sum of squares that a ridge keeps small."""
        return self.trunk.square().sum() + self.arm.square().sum()


def _centred(effects: Tensor) -> Tensor:
    """What everybody shares is the network's."""
    return effects - effects.mean(0)
