"""Where the page's skeleton puts estimated joints, differentiable: a network learns what its answer becomes, not what it says.

The twin of src/core/estimation/reconstruct-orientations.ts for one frame that nothing came before, without the trunk that elbows keep out of.
All in the frame of IK's chest, in eye heights, seen from the headset.
"""

import math

import torch
from torch import Tensor

from .features import CHEST_FEATURES, IK_JOINTS
from .skeleton import load_proportions, rest_offsets

# How far collarbone and neck swing [rad].
_CLAVICLE_LIMIT, _NECK_LIMIT = 0.61, 1.05
_X = torch.tensor([1.0, 0.0, 0.0])


class Placement:
    """The skeleton of the proportions in use."""

    def __init__(self) -> None:
        self.rest = {joint: torch.tensor(offset) for joint, offset in rest_offsets(1.0, 1.0).items()}
        self.upper_arm_share: float = load_proportions()["upperArmShare"]
        self.thorax = self.rest["upperChest"] + self.rest["neck"]
        self.lower_back_length = (self.rest["spine"] + self.rest["chest"]).norm()
        # Of shoulders at rest, their middle from the neck's base.
        left, right = (self.rest[f"{side}Shoulder"] + self.rest[f"{side}UpperArm"] for side in ("left", "right"))
        self.shoulders_from_neck = (left + right) / 2 - self.rest["neck"]

    def __call__(self, corrections: Tensor, inputs: Tensor, reach_passes: int = 1) -> Tensor:
        """What corrections of IK's joints [N, 6, 3] come to where the skeleton places them [N, 6, 3]; inputs [N, T·46 + 38]. The trunk goes after
        hands out of the arms' reach so many times."""
        axes, ik_joints = _seen_from_chest(inputs)
        seen, arm = inputs[:, -CHEST_FEATURES:], inputs[:, 45:46].unsqueeze(1)
        wrists = ik_joints[:, 2:4] + seen[:, :24].view(-1, 2, 4, 3)[:, :, 0] * arm
        estimated = ik_joints + corrections
        head_joint, heading_right = self._head_joint(seen), axes[:, :, 0]
        targets = estimated[:, 2:4]
        chest, hips, shoulders = self._trunk(targets, estimated, head_joint, heading_right)
        for _ in range(reach_passes):
            to_wrist = wrists - shoulders
            targets = targets + _unit(to_wrist) * (_length(to_wrist) - arm).clamp_min(0.0) * 1.3
            chest, hips, shoulders = self._trunk(targets, estimated, head_joint, heading_right)
        elbows = self._elbows(estimated, shoulders, wrists, arm)
        return torch.cat([elbows, shoulders, chest.unsqueeze(1), hips.unsqueeze(1)], dim=1) - ik_joints

    def _head_joint(self, seen: Tensor) -> Tensor:
        x, y = seen[:, 24:27], seen[:, 27:30]
        head = torch.stack([x, y, torch.cross(x, y, dim=-1)], dim=-1)
        return -head @ self.rest["eyesInHead"]

    def _trunk(self, targets: Tensor, estimated: Tensor, head_joint: Tensor, heading_right: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Chest joint, hips [N, 3] and shoulders [N, 2, 3] on their bones below the head, as nearly as that allows where they are wanted."""
        middle = targets.mean(1)
        line = _unit(targets[:, 1] - targets[:, 0])
        rough = _aligned(self.thorax, middle - estimated[:, 4], line)
        implied_neck = middle - rough @ self.shoulders_from_neck
        neck_bone = self.rest["head"]
        neck = head_joint - _swung(rough @ neck_bone, head_joint - implied_neck, _NECK_LIMIT)
        # Chest joint and hips follow half of what the neck was moved by.
        shift = neck - implied_neck
        moved = shift * 0.5 * (neck_bone.norm() / _length(shift)).clamp_max(1.0)
        up = _unit(neck - estimated[:, 4] - moved)
        chest = neck - up * self.thorax.norm()
        hips = chest + _unit(estimated[:, 5] + moved - chest) * self.lower_back_length
        pelvis_line = _unit(torch.lerp(line, heading_right, 0.35))
        lower, upper = (_aligned(self.thorax, up, side) for side in (torch.lerp(pelvis_line, line, 0.7), line))
        shoulders = []
        for number, side in enumerate(("left", "right")):
            root = chest + lower @ self.rest["upperChest"] + upper @ self.rest[f"{side}Shoulder"]
            shoulders.append(root + _swung(upper @ self.rest[f"{side}UpperArm"], targets[:, number] - root, _CLAVICLE_LIMIT))
        return chest, hips, torch.stack(shoulders, dim=1)

    def _elbows(self, estimated: Tensor, shoulders: Tensor, wrists: Tensor, arm: Tensor) -> Tensor:
        """Elbows [N, 2, 3] where upper arm and forearm let them be, on the side where they are estimated, as seen from the estimated shoulders."""
        upper, fore = self.upper_arm_share * arm, (1 - self.upper_arm_share) * arm
        own, axis = _unit(wrists - estimated[:, 2:4]), _unit(wrists - shoulders)
        aside = _carried(_across(estimated[:, :2] - estimated[:, 2:4], own), own, axis)
        reached = torch.minimum(torch.maximum(_length(wrists - shoulders), (upper - fore).abs() + 1e-3), 0.999 * arm)
        along = (upper**2 - fore**2 + reached**2) / (2 * reached)
        return shoulders + along * axis + torch.sqrt((upper**2 - along**2).clamp_min(1e-8)) * _unit(_across(aside, axis))


def _seen_from_chest(inputs: Tensor) -> tuple[Tensor, Tensor]:
    """The axes of IK's chest as rows [N, 3, 3], heading frame, and IK's joints [N, 6, 3] seen from it."""
    joints = inputs[:, IK_JOINTS].reshape(-1, 6, 3)
    left, right, chest = joints[:, 2], joints[:, 3], joints[:, 4]
    x = _unit(right - left)
    up = _unit(_across((left + right) / 2 - chest, x))
    axes = torch.stack([x, up, torch.cross(x, up, dim=-1)], dim=1)
    return axes, joints @ axes.transpose(1, 2)


def _length(vectors: Tensor) -> Tensor:
    """[..., 1]; of nothing a hundred-thousandth, so that gradients stay finite."""
    return torch.sqrt((vectors * vectors).sum(-1, keepdim=True) + 1e-10)


def _unit(vectors: Tensor) -> Tensor:
    return vectors / _length(vectors)


def _dot(a: Tensor, b: Tensor) -> Tensor:
    return (a * b).sum(-1, keepdim=True)


def _across(vectors: Tensor, axis: Tensor) -> Tensor:
    return vectors - _dot(vectors, axis) * axis


def _aligned(main: Tensor, to_main: Tensor, to_x: Tensor) -> Tensor:
    """The rotations [N, 3, 3] that take `main` [3] to the directions `to_main` [N, 3], and x as nearly as that allows to `to_x` [N, 3]."""
    return _frame(to_main, to_x) @ _frame(main, _X).T


def _frame(main: Tensor, side: Tensor) -> Tensor:
    first = _unit(main)
    normal = _unit(torch.cross(first, side, dim=-1))
    return torch.stack([first, torch.cross(normal, first, dim=-1), normal], dim=-1)


def _swung(rest: Tensor, towards: Tensor, limit: float) -> Tensor:
    """Bones as long as `rest` [N, 3] in these directions [N, 3], but no further than `limit` [rad] from it."""
    start, end = _unit(rest), _unit(towards)
    aside = _across(end, start)
    furthest = start * math.cos(limit) + _unit(aside) * math.sin(limit)
    within = torch.atan2(_length(aside), _dot(start, end)) <= limit
    return _length(rest) * torch.where(within, end, furthest)


def _carried(vectors: Tensor, before: Tensor, after: Tensor) -> Tensor:
    """Turned as the direction `before` is turned into `after`."""
    normal = torch.cross(before, after, dim=-1)
    once = torch.cross(normal, vectors, dim=-1)
    return vectors + once + torch.cross(normal, once, dim=-1) / (1 + _dot(before, after)).clamp_min(1e-3)
