"""What is one person's own, learned beside the network and left out of it.

People are built and hold themselves differently. A network that has to explain that learns who is who, and nobody new is any of them. As in
a mixed-effects model everybody trained on therefore has a correction of their own on top of what holds for all: small, by a ridge, and zero
on average.
"""

import torch
from torch import Tensor, nn

from .features import CHEST_FEATURES
from .model import ARM_FLIP, FLIP

# An everyday effect in eye heights: keeps the parameters near one.
_EFFECT = 0.02


class PersonEffects(nn.Module):
    """Of each of `people` persons: how the corrections of shoulders, chest joint and hips go with what IK's chest sees, how an elbow goes with
    what it sees of that arm, and where the own arms' shoulders are."""

    def __init__(self, people: int, inputs: Tensor) -> None:
        """inputs [N, T·46 + 38]: some of the training's, for mean and deviation of what the chest sees."""
        super().__init__()
        self.trunk = nn.Parameter(torch.zeros(people, CHEST_FEATURES + 1, 12))
        # Of a right arm; the elbow from its shoulder.
        self.elbow = nn.Parameter(torch.zeros(people, _ARM_SEEN + 1, 3))
        self.shoulder = nn.Parameter(torch.zeros(people, 3))
        seen = inputs[:, -CHEST_FEATURES:]
        for name, values in (("trunk", seen), ("arm", _as_right_arms(seen).flatten(0, 1))):
            self.register_buffer(f"{name}_mean", values.mean(0))
            self.register_buffer(f"{name}_scale", values.std(0).clamp_min(2e-2))

    def forward(self, inputs: Tensor, people: Tensor) -> Tensor:
        """What to add to the corrections [N, 6, 3] of windows [N, T·46 + 38] of these people's torsos, left and right arms [N, 3]."""
        seen = inputs[:, -CHEST_FEATURES:]
        torso, arms = people[:, 0], people[:, 1:]
        trunk = torch.einsum("nf,nfo->no", self._told("trunk", seen), _centred(self.trunk)[torso]).view(-1, 4, 3)
        right = torch.stack([FLIP, torch.ones(3)])
        shoulders = trunk[:, :2] + right * _centred(self.shoulder)[arms]
        elbows = right * torch.einsum("naf,nafo->nao", self._told("arm", _as_right_arms(seen)), _centred(self.elbow)[arms])
        return _EFFECT * torch.cat([shoulders + elbows, shoulders, trunk[:, 2:]], dim=1)

    def size(self) -> Tensor:
        """The sum of squares that a ridge keeps small."""
        return sum((each.square().sum() for each in self.parameters()), torch.zeros(()))

    def _told(self, name: str, seen: Tensor) -> Tensor:
        """In deviations, and a one for what is constant."""
        mean, scale = getattr(self, f"{name}_mean"), getattr(self, f"{name}_scale")
        return nn.functional.pad(torch.clamp((seen - mean) / scale, -4.0, 4.0), (0, 1), value=1.0)


# Of what the chest sees, what is about one arm: reach, two axes of the hand, IK's elbow; the room's up; the reach's length.
_ARM_SEEN = 16
_MIRRORED = torch.cat([ARM_FLIP, FLIP, torch.ones(1)])


def _as_right_arms(seen: Tensor) -> Tensor:
    """Both arms [N, 2, 16] of what the chest sees [N, 38], the left one as its mirror image."""
    up = seen[:, None, 33:36].expand(-1, 2, -1)
    arms = torch.cat([seen[:, :24].view(-1, 2, 12), up, seen[:, 36:, None]], dim=2)
    return arms * torch.stack([_MIRRORED, torch.ones(_ARM_SEEN)])


def _centred(effects: Tensor) -> Tensor:
    """What everybody shares is the network's."""
    return effects - effects.mean(0)
