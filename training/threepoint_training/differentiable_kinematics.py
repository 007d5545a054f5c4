"""Torso and arm fitting as a layer that gradients pass: where joints come to lie on bones of constant length.

The twin of src/threepoint/core/estimation/trunk/fit-torso.ts and fit-arms.ts for a frame that none came before. All in the
frame of IK's chest, in eye heights, from the headset. What is left out moves no estimated joint of a person who stands
or sits: the floor under hips, and the rotations of vertebrae, forearms and hands.
"""

from dataclasses import dataclass, fields

import numpy as np
import torch
from torch import Tensor

from .chest_features import ARM_COLUMNS, ARMS, CHEST_FEATURES, CHEST_HEAD_AXES
from .features import ARM_LENGTH, IK_JOINTS
from .shared_constants import LIMB, REACH, TORSO, TORSO_EXTREME
from .skeleton import body_from_calibration, rest_offsets
from .swivel_limiter import ElbowCircles, Trunk, limit_swivel


@dataclass(frozen=True)
class FittingConfig:
    """How closely fitting follows the page. The defaults are the loss's: as little as gradients need, and far from
    where they grow.
    """

    # The trunk leans after hands so many times; beyond anatomicalPasses only after those out of reach, its joints going
    # to their extremes.
    reach_passes: int = 1
    # Hands further away than this are out of reach [arm lengths]; nearer to it than that they count as reached [eye
    # heights].
    reach: float = 1.0
    least_missing: float = 0.0
    # Shoulder to wrist of the straightest arm [arm lengths] and, beyond the difference of its bones, of the most bent
    # one [eye heights].
    straightest: float = 0.999
    most_bent: float = 1e-3
    swivel_limiter: bool = False


LOSS = FittingConfig()


def as_the_page_fits(eye_height: float) -> FittingConfig:
    """All that the page does, for a body of this eye height [m]."""
    return FittingConfig(
        reach_passes=REACH["anatomicalPasses"] + REACH["extremePasses"],
        reach=LIMB["straightest"],
        least_missing=1e-5 / eye_height,
        straightest=LIMB["straightest"],
        most_bent=LIMB["maxBent"] / eye_height,
        swivel_limiter=True,
    )


@dataclass(frozen=True)
class _FittingInput:
    """What fitting starts from, frame and unit as above: estimated joints [N, 6, 3], wrists [N, 2, 3], head joint [N,
    3], the heading's right axis [N, 3], and the lengths of the arm [N, 1, 1] and of the upper arms [N, 2, 1].
    """

    estimated: Tensor
    wrists: Tensor
    head_joint: Tensor
    heading_right: Tensor
    arm: Tensor
    upper_arm: Tensor


@dataclass(frozen=True)
class _Unleaned:
    """What leans start from, frame and unit as above: the thorax's side and up directions [N, 3], unit, at right
    angles, the neck's base to the head joint [N, 3], and what chest joint and hips follow of the neck's way onto its
    bone's length from the head [N, 3].
    """

    line: Tensor
    up: Tensor
    neck_to_head: Tensor
    moved: Tensor


class DifferentiableKinematics:
    """Fits joints to the skeleton of the proportions in use."""

    def __init__(self, dtype: torch.dtype = torch.float32) -> None:
        unit = body_from_calibration(np.array(1.0), np.array(1.0))
        self.rest = {joint: torch.tensor(offset, dtype=dtype) for joint, offset in rest_offsets(unit).items()}
        self.x = torch.tensor([1.0, 0.0, 0.0], dtype=dtype)
        self.thorax = self.rest["upperChest"] + self.rest["neck"]
        self.lower_back_length = (self.rest["spine"] + self.rest["chest"]).norm()
        # The midpoint of the shoulders at rest, relative to the neck's base.
        left, right = (self.rest[f"{side}Shoulder"] + self.rest[f"{side}UpperArm"] for side in ("left", "right"))
        self.shoulders_from_neck = (left + right) / 2 - self.rest["neck"]
        self.shoulder_width = (right - left)[0]

    def __call__(self, corrections: Tensor, inputs: Tensor, config: FittingConfig = LOSS) -> Tensor:
        """The corrections [N, 6, 3] of IK's joints that remain after torso and arm fitting; inputs [N, T·46 + 38]: of
        the network.
        """
        return self.fit(corrections, inputs, config)[0]

    def fit(self, corrections: Tensor, inputs: Tensor, config: FittingConfig) -> tuple[Tensor, Tensor]:
        """Returns the fitted joints, and which elbows the swivel limiter keeps out of the trunk [N, 2]."""
        axes, ik_joints = _in_chest_frame(inputs)
        chest_features, arm = inputs[:, -CHEST_FEATURES:], inputs[:, ARM_LENGTH, None, None]
        given = _FittingInput(
            estimated=ik_joints + corrections,
            wrists=ik_joints[:, 2:4] + chest_features[:, ARMS].view(-1, 2, ARM_COLUMNS)[:, :, :3] * arm,
            head_joint=self._head_joint(chest_features),
            heading_right=axes[:, :, 0],
            arm=arm,
            # IK's arms have the calibrated bones.
            upper_arm=(ik_joints[:, :2] - ik_joints[:, 2:4]).norm(dim=-1, keepdim=True),
        )
        trunk, shoulders = self.fit_torso(given, config)
        elbows, limited = self.fit_arms(given, trunk, shoulders, config)
        joints = torch.cat([elbows, shoulders, trunk.chest.unsqueeze(1), trunk.hips.unsqueeze(1)], dim=1)
        return joints - ik_joints, limited

    def _head_joint(self, chest_features: Tensor) -> Tensor:
        x, y = chest_features[:, CHEST_HEAD_AXES].split(3, dim=1)
        head = torch.stack([x, y, torch.cross(x, y, dim=-1)], dim=-1)
        return -head @ self.rest["eyesInHead"]

    def fit_torso(self, given: _FittingInput, config: FittingConfig) -> tuple[Trunk, Tensor]:
        """The trunk and the shoulders [N, 2, 3], leaning after hands that the arms alone do not reach, or would have to
        be straight to.
        """
        leans = torch.zeros_like(given.estimated[:, 2:4])
        # How far clavicles and neck go beyond anatomy [share of the way to their extremes].
        extremity = torch.zeros_like(leans[..., :1])
        upright = self._place_upright_neck(given)
        trunk, shoulders = self._place_trunk(given, upright, leans, extremity)
        reach = config.reach * given.arm
        soft = _softened(_length(given.wrists - shoulders), reach)
        for number in range(config.reach_passes):
            to_wrist = given.wrists - shoulders
            wanted = soft if number < REACH["anatomicalPasses"] else reach
            missing = (_length(to_wrist) - wanted).clamp_min(0.0)
            missing = torch.where(missing > config.least_missing, missing, 0.0)
            leans = leans + _unit(to_wrist) * missing
            leans = leans * (reach / _length(leans)).clamp_max(1.0)
            if number >= REACH["anatomicalPasses"]:
                extremity = (extremity + missing / (REACH["extremeReach"] * reach)).clamp_max(1.0)
            placed = self._place_trunk(given, upright, leans, extremity)
            if config.reach_passes > 1:
                placed = _chosen((missing > 0.0).any(dim=1), placed, (trunk, shoulders))
            trunk, shoulders = placed
        return trunk, shoulders

    def _place_upright_neck(self, given: _FittingInput) -> _Unleaned:
        """The neck below the head and the thorax below it as they are estimated, before any lean."""
        estimated, head_joint = given.estimated, given.head_joint
        middle = estimated[:, 2:4].mean(1)
        up = _unit(middle - estimated[:, 4])
        chest = self._aligned(self.thorax, up, _unit(estimated[:, 3] - estimated[:, 2]))
        implied_neck = middle - chest @ self.shoulders_from_neck
        neck_bone = self.rest["head"]
        anatomical = _limit("neckBend", torch.zeros_like(up[:, :1]))
        neck_to_head = _swung(chest @ neck_bone, head_joint - implied_neck, anatomical)
        # Chest joint and hips follow a share of what the neck is moved by.
        shift = head_joint - neck_to_head - implied_neck
        moved = shift * TORSO["neckShiftShare"] * (neck_bone.norm() / _length(shift)).clamp_max(1.0)
        return _Unleaned(chest @ self.x, up, neck_to_head, moved)

    def _place_trunk(
        self, given: _FittingInput, upright: _Unleaned, leans: Tensor, extremity: Tensor
    ) -> tuple[Trunk, Tensor]:
        """Chest joint, hips and shoulders on their bones below the head, for estimated shoulders that lean by these
        offsets [N, 2, 3].

        A lean turns the thorax about its length, then its length and the neck, by less than a right angle each; what it
        asks back along them is left to the clavicles. extremity: of each side, how far on the way from anatomical limits
        to extreme ones [N, 2, 1].
        """
        estimated, head_joint = given.estimated, given.head_joint
        targets, mean = estimated[:, 2:4] + leans, leans.mean(1)
        turned = _leaned(upright.line, self.shoulder_width, _across(leans[:, 1] - leans[:, 0], upright.up))
        leaned_up = _leaned(upright.up, self.thorax.norm(), mean)
        rough = self._aligned(self.thorax, leaned_up, _carried(turned, upright.up, leaned_up))
        neck_bone = self.rest["head"]
        neck_to_head = _leaned(_unit(upright.neck_to_head), neck_bone.norm(), -mean)
        neck = head_joint - _swung(rough @ neck_bone, neck_to_head, _limit("neckBend", extremity.amax(dim=1)))
        up = _unit(neck - estimated[:, 4] - upright.moved)
        line = _carried(turned, upright.up, up)
        chest = neck - up * self.thorax.norm()
        hips = chest + _unit(estimated[:, 5] + upright.moved - chest) * self.lower_back_length
        pelvis_line = _unit(torch.lerp(line, given.heading_right, TORSO["pelvisToHead"]))
        lower, upper = (
            self._aligned(self.thorax, up, side)
            for side in (torch.lerp(pelvis_line, line, TORSO["chestToShoulders"]), line)
        )
        shoulders = []
        for number, side in enumerate(("left", "right")):
            swing = _limit("clavicleSwing", extremity[:, number])
            root = chest + lower @ self.rest["upperChest"] + upper @ self.rest[f"{side}Shoulder"]
            clavicle, wanted = upper @ self.rest[f"{side}UpperArm"], targets[:, number] - root
            along = (wanted * clavicle).sum(-1, keepdim=True) / clavicle.square().sum(-1, keepdim=True)
            wanted = wanted + clavicle * (TORSO["shortestClavicle"] - along).clamp_min(0)
            shoulders.append(root + _swung(clavicle, wanted, swing))
        return Trunk(hips, chest, neck, upper), torch.stack(shoulders, dim=1)

    def fit_arms(
        self, given: _FittingInput, trunk: Trunk, shoulders: Tensor, config: FittingConfig
    ) -> tuple[Tensor, Tensor]:
        """Elbows [N, 2, 3] where upper arm and forearm let them be, on the side where they are estimated, from the
        estimated shoulders.

        Also which of them the swivel limiter moved [N, 2].
        """
        estimated, wrists, arm, upper = given.estimated, given.wrists, given.arm, given.upper_arm
        fore = arm - upper
        own, axis = _unit(wrists - estimated[:, 2:4]), _unit(wrists - shoulders)
        pole = _carried(_across(estimated[:, :2] - estimated[:, 2:4], own), own, axis)
        reached = torch.minimum(
            torch.maximum(_length(wrists - shoulders), (upper - fore).abs() + config.most_bent),
            config.straightest * arm,
        )
        along = (upper**2 - fore**2 + reached**2) / (2 * reached)
        centre, radius = shoulders + along * axis, torch.sqrt((upper**2 - along**2).clamp_min(1e-8))
        pole = _unit(_across(pole, axis))
        limited = torch.zeros(pole.shape[:2], dtype=torch.bool)
        if config.swivel_limiter:
            pole, limited = limit_swivel(ElbowCircles(centre, axis, radius), pole, trunk)
        return centre + radius * pole, limited

    def _aligned(self, main: Tensor, to_main: Tensor, to_x: Tensor) -> Tensor:
        """The rotations [N, 3, 3] that take `main` [3] to the directions `to_main` [N, 3], and x as nearly as that
        allows to `to_x` [N, 3].
        """
        return _frame(to_main, to_x) @ _frame(main, self.x).T


def _leaned(direction: Tensor, length: Tensor, offset: Tensor) -> Tensor:
    """Returns the direction [N, 3] of a bone after its end moves by an offset, without the offset's part against the
    bone.
    """
    return _unit(offset + direction * (length - _dot(offset, direction).clamp_max(0.0)))


def _chosen(bodies: Tensor, a: tuple[Trunk, Tensor], b: tuple[Trunk, Tensor]) -> tuple[Trunk, Tensor]:
    """Trunk and shoulders `a` of these bodies [N], `b` of the others."""

    def choose(x: Tensor, y: Tensor) -> Tensor:
        return torch.where(bodies.view(-1, *[1] * (x.dim() - 1)), x, y)

    trunk = Trunk(*(choose(getattr(a[0], each.name), getattr(b[0], each.name)) for each in fields(Trunk)))
    return trunk, choose(a[1], b[1])


def _in_chest_frame(inputs: Tensor) -> tuple[Tensor, Tensor]:
    """The axes of IK's chest as rows [N, 3, 3], heading frame, and IK's joints [N, 6, 3] along them."""
    joints = inputs[:, IK_JOINTS].reshape(-1, 6, 3)
    left, right, chest = joints[:, 2], joints[:, 3], joints[:, 4]
    x = _unit(right - left)
    up = _unit(_across((left + right) / 2 - chest, x))
    axes = torch.stack([x, up, torch.cross(x, up, dim=-1)], dim=1)
    return axes, joints @ axes.transpose(1, 2)


def _limit(joint: str, extremity: Tensor) -> Tensor:
    """How far this joint swings from rest against the thorax [rad], so far on the way from anatomy to the extreme [0 to
    1].
    """
    return TORSO[joint] + extremity * (TORSO_EXTREME[joint] - TORSO[joint])


def _softened(far: Tensor, reach: Tensor) -> Tensor:
    """How far arms that reach `reach` stretch after hands `far` away, in one unit; the twin of softenedReach in
    src/threepoint/core/body/two-bone-ik.ts.
    """
    near = LIMB["softReach"] * reach
    # Clamped, for what is not chosen has a gradient as well.
    straightening = reach - (reach - near) * torch.exp((near - far).clamp_max(0.0) / (reach - near))
    return torch.where(far > near, straightening, far)


def _length(vectors: Tensor) -> Tensor:
    """[..., 1]; of nothing a hundred-thousandth, so that gradients stay finite."""
    return torch.sqrt((vectors * vectors).sum(-1, keepdim=True) + 1e-10)


def _unit(vectors: Tensor) -> Tensor:
    return vectors / _length(vectors)


def _dot(a: Tensor, b: Tensor) -> Tensor:
    return (a * b).sum(-1, keepdim=True)


def _across(vectors: Tensor, axis: Tensor) -> Tensor:
    return vectors - _dot(vectors, axis) * axis


def _frame(main: Tensor, side: Tensor) -> Tensor:
    first = _unit(main)
    normal = _unit(torch.cross(first, side, dim=-1))
    return torch.stack([first, torch.cross(normal, first, dim=-1), normal], dim=-1)


def _swung(rest: Tensor, towards: Tensor, limit: Tensor) -> Tensor:
    """Bones as long as `rest` [N, 3] in these directions [N, 3], but no further than `limit` [N, 1] [rad] from it."""
    start, end = _unit(rest), _unit(towards)
    aside = _across(end, start)
    furthest = start * torch.cos(limit) + _unit(aside) * torch.sin(limit)
    within = torch.atan2(_length(aside), _dot(start, end)) <= limit
    return _length(rest) * torch.where(within, end, furthest)


def _carried(vectors: Tensor, before: Tensor, after: Tensor) -> Tensor:
    """Turned as the direction `before` is turned into `after`."""
    normal = torch.cross(before, after, dim=-1)
    once = torch.cross(normal, vectors, dim=-1)
    return vectors + once + torch.cross(normal, once, dim=-1) / (1 + _dot(before, after)).clamp_min(1e-3)
