"""Keeps elbows out of the trunk: the twin of src/threepoint/core/estimation/arms/swivel-limiter.ts for one frame without a
frame before it.

Vectorised over bodies [N] and their two arms; any frame and unit of length that the trunk shares. No gradients go
through its choice.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import torch
from torch import Tensor

from .shared_constants import TRUNK_CAPSULE

# Angles are looked at in steps of this [rad]; borders are found to a sixty-fourth of it.
_STEP, _STEPS, _HALVINGS = math.pi / 18, 18, 6


@dataclass(frozen=True)
class ElbowCircles:
    """The circles on which the elbows of arms can lie, about the lines from shoulder to wrist: centre and axis (unit,
    towards the wrist) [N, 2, 3], radius [N, 2, 1].
    """

    centre: Tensor
    axis: Tensor
    radius: Tensor


@dataclass(frozen=True)
class Trunk:
    """Joints [N, 3] and rotation of the upper chest [N, 3, 3] (columns: its axes)."""

    hips: Tensor
    chest: Tensor
    neck: Tensor
    upper_chest: Tensor


def limit_swivel(circles: ElbowCircles, poles: Tensor, trunk: Trunk) -> tuple[Tensor, Tensor]:
    """The poles [N, 2, 3] nearest to these at which elbows are clear of the trunk, and which of them had to move [N,
    2].
    """
    sides = torch.stack([-trunk.upper_chest[:, :, 0], trunk.upper_chest[:, :, 0]], dim=1)
    outside = _across(sides, circles.axis)
    short = outside.norm(dim=-1, keepdim=True) <= 1e-3
    backward = trunk.upper_chest[:, None, :, 2].expand_as(outside)
    zero = _unit(torch.where(short, _across(backward, circles.axis), outside))
    quarter = torch.cross(circles.axis, zero, dim=-1)
    wanted = torch.atan2(_dot(poles, quarter), _dot(poles, zero))
    is_inside = _inside(circles, zero, quarter, trunk)
    low, high = -_border(is_inside, -1.0, wanted), _border(is_inside, 1.0, wanted)
    beyond_low, beyond_high = _wrapped(wanted - low).abs(), _wrapped(wanted - high).abs()
    free = (wanted >= low) & (wanted <= high)
    angle = torch.where(free, wanted, torch.where(beyond_low < beyond_high, low, high))[..., None]
    return torch.where(free[..., None], poles, torch.cos(angle) * zero + torch.sin(angle) * quarter), ~free


def _inside(circles: ElbowCircles, zero: Tensor, quarter: Tensor, trunk: Trunk) -> Callable[[Tensor], Tensor]:
    """Returns a predicate of swivel angles [N, 2], from `zero` towards `quarter` [rad]: whether the elbows are in the
    trunk capsule [N, 2].
    """
    unit = (trunk.neck - trunk.chest).norm(dim=-1)[:, None]
    spine = trunk.neck - trunk.hips
    up = _unit(spine)
    right = _unit(_across(trunk.upper_chest[:, :, 0], up))
    axes = torch.stack([right, up, torch.cross(right, up, dim=-1)], dim=1)[:, None]
    half_axes = torch.tensor([TRUNK_CAPSULE[key] for key in ("halfWidth", "cap", "halfDepth")], dtype=spine.dtype)

    def in_capsule(vectors: Tensor) -> Tensor:
        return (axes @ vectors[..., None])[..., 0] / (half_axes * unit[..., None])

    centre = in_capsule(circles.centre - trunk.hips[:, None])
    towards_zero, towards_quarter = (in_capsule(circles.radius * each) for each in (zero, quarter))
    height = spine.norm(dim=-1)[:, None] / (TRUNK_CAPSULE["cap"] * unit)

    def is_inside(angle: Tensor) -> Tensor:
        x, y, z = (
            centre + torch.cos(angle)[..., None] * towards_zero + torch.sin(angle)[..., None] * towards_quarter
        ).unbind(-1)
        beyond = y - y.clamp_min(0).minimum(height)
        return x * x + beyond * beyond + z * z < 1

    return is_inside


def _border(is_inside: Callable[[Tensor], Tensor], sign: float, like: Tensor) -> Tensor:
    """From 0 on in the direction of `sign`: the angle [rad, at least 0] up to which elbows are clear."""
    border = torch.full_like(like, math.pi)
    for step in range(_STEPS, 0, -1):
        border = torch.where(is_inside(torch.full_like(like, sign * step * _STEP)), step * _STEP, border)
    blocked = is_inside(sign * border)
    low, high = border - _STEP, border
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        inside = is_inside(sign * middle)
        low, high = torch.where(inside, low, middle), torch.where(inside, middle, high)
    return torch.where(blocked, low, border)


def _wrapped(angle: Tensor) -> Tensor:
    return torch.atan2(torch.sin(angle), torch.cos(angle))


def _dot(a: Tensor, b: Tensor) -> Tensor:
    return (a * b).sum(-1)


def _across(vectors: Tensor, axis: Tensor) -> Tensor:
    return vectors - _dot(vectors, axis)[..., None] * axis


def _unit(vectors: Tensor) -> Tensor:
    return vectors / vectors.norm(dim=-1, keepdim=True).clamp_min(1e-12)
