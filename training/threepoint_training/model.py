"""The two networks. Normalisation lives inside both: SI units or ratios go in and come out."""

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from .features import FEATURES, IK_JOINTS, OUTPUTS
from .prepared_corpus import MIRRORED_JOINTS


class PaperNetwork(nn.Module):
    """Section 3.3 of the paper: [N, 2, 3, 3] -> [N, 18].

    Four 3×3 convolutions of 2^(4+layer) channels (32, 64, 128, 256), stride 1, zero padding, ReLU; dropout 0.3 after the first
    convolution and the first fully connected layer. Its width, 512, is the one that gives the 1.58 million parameters of a 6 MB file.
    """

    def __init__(self) -> None:
        super().__init__()
        channels = [2] + [2 ** (4 + layer) for layer in range(1, 5)]
        self.convolutions = nn.ModuleList(
            nn.Conv2d(before, after, 3, padding=1) for before, after in zip(channels[:-1], channels[1:], strict=True)
        )
        self.dropout = nn.Dropout(0.3)
        self.hidden = nn.Linear(channels[-1] * 9, 512)
        self.output = nn.Linear(512, OUTPUTS)
        self.register_buffer("input_mean", torch.zeros(1, 2, 3, 3))
        self.register_buffer("input_scale", torch.ones(1, 2, 3, 3))
        self.register_buffer("output_mean", torch.zeros(1, OUTPUTS))
        self.register_buffer("output_scale", torch.ones(1, OUTPUTS))

    def normalise(self, inputs: Tensor, targets: Tensor) -> None:
        """Takes mean and deviation from the training data."""
        self.input_mean.copy_(inputs.mean(0, keepdim=True))
        self.input_scale.copy_(inputs.std(0, keepdim=True).clamp_min(1e-4))
        self.output_mean.copy_(targets.mean(0, keepdim=True))
        self.output_scale.copy_(targets.std(0, keepdim=True).clamp_min(1e-4))

    def standardised(self, inputs: Tensor) -> Tensor:
        """The output in standard deviations, which the loss compares."""
        x = (inputs - self.input_mean) / self.input_scale
        for layer, convolution in enumerate(self.convolutions):
            x = torch.relu(convolution(x))
            if layer == 0:
                x = self.dropout(x)
        x = self.dropout(torch.relu(self.hidden(x.flatten(1))))
        return self.output(x)

    def forward(self, inputs: Tensor) -> Tensor:
        return self.standardised(inputs) * self.output_scale + self.output_mean


class ResidualNetwork(nn.Module):
    """[N, T·46] features -> [N, 18] joints: the IK solution in the newest frame plus a learned correction.

    Everything is seen from IK's chest, where an arm looks the same whichever way its body turns and leans. A trunk corrects shoulders,
    chest joint and hips; an arm, the same network for both sides, then corrects an elbow, knowing of nothing but its own hand and
    shoulder. Whatever is said of a body is said of its mirror image.

    In a browser a node of the graph costs more than its arithmetic: what is linear is one matrix.
    """

    def __init__(self, taps: int, width: int, dropout: float, hidden_layers: int = 2) -> None:
        super().__init__()
        self.inputs = taps * FEATURES
        trunk_inputs, arm_width = self.inputs + CHEST_FEATURES, max(width // 2, 16)
        self.trunk = _perceptron(trunk_inputs, width, hidden_layers, dropout, 12)
        self.arm = _perceptron(ARM_FEATURES, arm_width, hidden_layers, dropout, 3)
        for name, inputs, outputs in (("trunk", trunk_inputs, 12), ("arm", ARM_FEATURES, 3)):
            self.register_buffer(f"{name}_input_mean", torch.zeros(1, inputs))
            self.register_buffer(f"{name}_input_scale", torch.ones(1, inputs))
            self.register_buffer(f"{name}_output_mean", torch.zeros(1, outputs))
            self.register_buffer(f"{name}_output_scale", torch.ones(1, outputs))
        self.mirror_column, self.mirror_sign = _mirror_image(taps)
        self.vectors, self.from_trunk, self.from_arms = _vectors(taps), _from_trunk(), _from_arms()

    def normalise(self, inputs: Tensor, targets: Tensor) -> None:
        """Takes mean and deviation from the training data; constant features keep their size."""
        bodies, truth = self._with_mirror_images(inputs), targets.view(-1, 6, 3)
        truth = torch.stack([truth, truth[:, MIRRORED_JOINTS] * _FLIP], dim=1).flatten(0, 1)
        seen = self._from_chest(bodies)
        residuals = truth - bodies[:, IK_JOINTS].reshape(-1, 6, 3)
        in_chest = residuals @ seen.axes.transpose(1, 2)
        self._take("trunk", torch.cat([bodies, seen.told], dim=1), in_chest[:, 2:].flatten(1))
        self._take("arm", seen.right_arm(residuals[:, 3:4]), in_chest[:, 1] - in_chest[:, 3])

    def _take(self, name: str, inputs: Tensor, outputs: Tensor) -> None:
        for kind, values, smallest in (("input", inputs, 2e-2), ("output", outputs, 1e-4)):
            getattr(self, f"{name}_{kind}_mean").copy_(values.mean(0, keepdim=True))
            getattr(self, f"{name}_{kind}_scale").copy_(values.std(0, keepdim=True).clamp_min(smallest))

    def shrink(self, share: float) -> None:
        """Leaves this share of the trunk's correction."""
        self.trunk_output_mean *= share
        self.trunk_output_scale *= share

    def forward(self, inputs: Tensor) -> Tensor:
        bodies = self._with_mirror_images(inputs)
        seen = self._from_chest(bodies)
        trunk = self._apply("trunk", torch.cat([bodies, seen.told], dim=1)).view(-1, 4, 3) @ seen.axes
        moved, shoulders = (trunk.view(-1, 24) @ self.from_trunk).split([18, 6], dim=1)
        arms = self._apply("arm", seen.right_arm(shoulders.reshape(-1, 1, 3))).view(-1, 1, 3) @ seen.axes
        return inputs[:, IK_JOINTS] + moved + arms.view(-1, 6) @ self.from_arms

    def _apply(self, name: str, inputs: Tensor) -> Tensor:
        mean, scale, output_mean, output_scale = (
            getattr(self, f"{name}_{key}") for key in ("input_mean", "input_scale", "output_mean", "output_scale")
        )
        # Trackers never leave four deviations on anybody the network knows: beyond, it is held there.
        x = torch.clamp((inputs - mean) / scale, -4.0, 4.0)
        return getattr(self, name)(x) * output_scale + output_mean

    def _with_mirror_images(self, inputs: Tensor) -> Tensor:
        """Each body, then its mirror image [2 N, T·46]."""
        return torch.cat([inputs, inputs[:, self.mirror_column] * self.mirror_sign], dim=1).view(-1, self.inputs)

    def _from_chest(self, bodies: Tensor) -> "_FromChest":
        x, up, arm, hands, shoulders, others = (bodies @ self.vectors + _NO_BODY).view(-1, 16, 3).split([1, 1, 1, 2, 2, 9], dim=1)
        x = x / x.norm(dim=-1, keepdim=True)
        up = up - (up * x).sum(-1, keepdim=True) * x
        up = up / up.norm(dim=-1, keepdim=True)
        axes = torch.cat([x, up, up @ (x @ _SKEW).view(-1, 3, 3)], dim=1)
        turned = torch.cat([hands - shoulders / arm, others], dim=1) @ axes.transpose(1, 2)
        reaches, right, _ = turned.split([2, 3, 6], dim=1)
        level = axes[:, :, 1]
        told = torch.cat([turned.flatten(1), level, reaches.norm(dim=-1)], dim=1)
        return _FromChest(axes, told, arm, reaches[:, 1:], torch.cat([right.flatten(1), level, bodies[:, 26:27]], dim=1))


@dataclass(frozen=True)
class _FromChest:
    """Bodies as IK's chest sees them, x to its right, y up, z backward."""

    axes: Tensor  # x, y and z as rows, heading frame [N, 3, 3]
    # Reach of both hands; axes of the right hand and its elbow from the shoulder; the left's; axes of the head; the chest joint from the
    # headset; the room's up; lengths of both reaches [N, CHEST_FEATURES].
    told: Tensor
    arm: Tensor  # its length, thrice [N, 1, 3], eye heights
    reach: Tensor  # from IK's right shoulder to the hand, arm lengths [N, 1, 3]
    others: Tensor  # axes of the right hand, IK's elbow, the room's up, whether the hand is seen [N, 13]

    def right_arm(self, shift: Tensor) -> Tensor:
        """What the right arm is told [N, ARM_FEATURES], its shoulder being so far from IK's [N, 1, 3], heading frame."""
        reach = self.reach - (shift / self.arm) @ self.axes.transpose(1, 2)
        return torch.cat([reach.squeeze(1), reach.norm(dim=-1), self.others], dim=1)


CHEST_FEATURES = 38
ARM_FEATURES = 17

_FLIP = torch.tensor([-1.0, 1.0, 1.0])

# [3, 9]: x @ _SKEW, a 3 by 3 matrix, takes y to x × y.
_SKEW = -torch.linalg.cross(torch.eye(3).unsqueeze(1).expand(3, 3, 3), torch.eye(3).expand(3, 3, 3)).transpose(1, 2).reshape(3, 9)

# What the shoulders' line, up and the arm are where all features are 0, as when a page tries the network: no axis without a direction.
_NO_BODY = torch.zeros(16, 3)
_NO_BODY[0, 0] = _NO_BODY[1, 1] = 1e-6
_NO_BODY[2] = 1e-6
_NO_BODY = _NO_BODY.flatten()


def _perceptron(inputs: int, width: int, hidden_layers: int, dropout: float, outputs: int) -> nn.Sequential:
    layers: list[nn.Module] = []
    for layer in range(hidden_layers):
        layers += [nn.Linear(inputs if layer == 0 else width, width), nn.ELU(), nn.Dropout(dropout)]
    return nn.Sequential(*layers, nn.Linear(width, outputs))


def _vectors(taps: int) -> Tensor:
    """[T·46, 16·3]: from the newest frame to what the chest's axes, and what it sees, are made of.

    From left to right shoulder; from the chest joint up; the arm's length, thrice; hands [arm lengths], shoulders; then what
    _FromChest.told says of axes and joints.
    """
    result = torch.zeros(taps * FEATURES, 16, 3)
    axis = torch.arange(3)

    def add(vector: int, feature: int, weight: float = 1.0) -> None:
        result[feature + axis, vector, axis] += weight

    hands, elbows, shoulders, chest = (7, 16), (27, 30), (33, 36), 39
    add(0, shoulders[0], -1.0)
    add(0, shoulders[1])
    add(1, chest, -1.0)
    result[45, 2] = 1.0
    for side in (0, 1):
        add(1, shoulders[side], 0.5)
        add(3 + side, hands[side])
        add(5 + side, shoulders[side])
    for vector, side in ((7, 1), (10, 0)):
        add(vector, hands[side] + 3)
        add(vector + 1, hands[side] + 6)
        add(vector + 2, elbows[side])
        add(vector + 2, shoulders[side], -1.0)
    add(13, 1)
    add(14, 4)
    add(15, chest)
    return result.flatten(1)


def _from_trunk() -> Tensor:
    """[24, 18 + 6]: what the trunk says of a body and its image to how the six joints move, elbows with their shoulders, and both right shoulders."""
    body, image = torch.eye(24).view(2, 4, 3, 24)
    left, right, chest, hips = ((body[joint] + _FLIP[:, None] * image[twin]) / 2 for joint, twin in enumerate([1, 0, 2, 3]))
    return torch.cat([left, right, left, right, chest, hips, right, _FLIP[:, None] * left]).T


def _from_arms() -> Tensor:
    """[6, 18]: the right elbow's move in a body and in its image to those of the six joints."""
    right, image = torch.eye(6).view(2, 3, 6)
    return torch.cat([_FLIP[:, None] * image, right, torch.zeros(12, 6)]).T


def _mirror_image(taps: int) -> tuple[Tensor, Tensor]:
    """Column and sign of each feature of the mirror image, over all frames of the window."""
    column, sign = torch.arange(FEATURES), torch.ones(FEATURES)
    column[7:25] = torch.cat([torch.arange(16, 25), torch.arange(7, 16)])
    column[25:27] = torch.tensor([26, 25])
    column[IK_JOINTS] = torch.arange(27, 45).view(6, 3)[MIRRORED_JOINTS].flatten()
    # A mirrored rotation's x axis is mirrored and turned round.
    sign[1:7] = torch.cat([-_FLIP, _FLIP])
    sign[7:25] = torch.cat([_FLIP, -_FLIP, _FLIP]).repeat(2)
    sign[IK_JOINTS] = _FLIP.repeat(6)
    return torch.cat([column + tap * FEATURES for tap in range(taps)]), sign.repeat(taps)


def _length(vectors: Tensor) -> Tensor:
    """[..., 1]; of nothing a thousandth, so that gradients stay finite."""
    return torch.sqrt((vectors * vectors).sum(-1, keepdim=True) + 1e-6)


def on_circle(joints: Tensor, inputs: Tensor, upper_arm_share: float) -> Tensor:
    """Elbows [N, 2, 3] of these joints [N, 6, 3], where upper arm and forearm let them be between shoulder and tracked wrist."""
    arm = inputs[:, 45:46].unsqueeze(1)
    upper, fore = upper_arm_share * arm, (1 - upper_arm_share) * arm
    shoulders = joints[:, 2:4]
    way = inputs[:, 7:25].reshape(-1, 6, 3)[:, 0::3] * arm - shoulders
    distance = _length(way)
    axis = way / distance
    aside = joints[:, :2] - shoulders
    aside = aside - (aside * axis).sum(-1, keepdim=True) * axis
    reach = torch.minimum(torch.maximum(distance, (upper - fore).abs() + 1e-3), 0.999 * arm)
    along = (upper**2 - fore**2 + reach**2) / (2 * reach)
    return shoulders + along * axis + torch.sqrt((upper**2 - along**2).clamp_min(1e-8)) * aside / _length(aside)
