"""The two networks. Normalisation lives inside both: SI units or ratios go in and come out."""

import torch
from torch import Tensor, nn
from torch.nn import functional

from .features import CHEST_FEATURES, FEATURES, IK_JOINTS, OUTPUTS
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


class CorrectionNetwork(nn.Module):
    """[N, T·46 + 38] features -> [N, 18]: what to add to IK's six joints, seen from IK's chest, in eye heights.

    From the chest an arm looks the same whichever way its body turns and leans. A trunk corrects shoulders, chest joint and hips; an arm,
    the same network for both sides, then corrects an elbow, knowing of nothing but its own hand and shoulder. Whatever is said of a body
    is said of its mirror image.

    In a browser a node of the graph costs more than its arithmetic: what is linear is one matrix.
    """

    def __init__(self, taps: int, width: int, dropout: float, hidden_layers: int = 2) -> None:
        super().__init__()
        self.inputs = taps * FEATURES + CHEST_FEATURES
        self.trunk = _perceptron(self.inputs, width, hidden_layers, dropout, 12)
        self.arm = _perceptron(ARM_FEATURES, max(width // 2, 16), hidden_layers, dropout, 3)
        for name, inputs, outputs in (("trunk", self.inputs, 12), ("arm", ARM_FEATURES, 3)):
            self.register_buffer(f"{name}_input_mean", torch.zeros(1, inputs))
            self.register_buffer(f"{name}_input_scale", torch.ones(1, inputs))
            self.register_buffer(f"{name}_output_mean", torch.zeros(outputs))
            self.register_buffer(f"{name}_output_scale", torch.ones(outputs))
        self.mirror_column, self.mirror_sign = _mirror_image(taps)
        self.arm_columns = _arm_columns(taps)
        self.from_trunk, self.from_arms = _from_trunk(), _from_arms()

    def normalise(self, inputs: Tensor, targets: Tensor) -> None:
        """Takes mean and deviation from the training data; constant features keep their size."""
        bodies, corrections = self._with_mirror_images(inputs), targets.view(-1, 6, 3)
        corrections = torch.stack([corrections, corrections[:, MIRRORED_JOINTS] * FLIP], dim=1).flatten(0, 1)
        self._take("trunk", bodies, corrections[:, 2:].flatten(1))
        self._take("arm", self._right_arm(bodies, corrections[:, 3]), corrections[:, 1] - corrections[:, 3])

    def _take(self, name: str, inputs: Tensor, outputs: Tensor) -> None:
        getattr(self, f"{name}_input_mean").copy_(inputs.mean(0, keepdim=True))
        getattr(self, f"{name}_input_scale").copy_(inputs.std(0, keepdim=True).clamp_min(2e-2))
        getattr(self, f"{name}_output_mean").copy_(outputs.mean(0))
        getattr(self, f"{name}_output_scale").copy_(outputs.std(0).clamp_min(1e-4))

    def shrink(self, share: float) -> None:
        """Leaves this share of the trunk's correction."""
        self.trunk_output_mean *= share
        self.trunk_output_scale *= share

    def forward(self, inputs: Tensor) -> Tensor:
        bodies = self._with_mirror_images(inputs)
        trunk = self._apply("trunk", bodies)
        moved, shoulders = (trunk.view(-1, 24) @ self.from_trunk).split([18, 6], dim=1)
        arms = self._apply("arm", self._right_arm(bodies, shoulders.reshape(-1, 3)))
        return moved + arms.view(-1, 6) @ self.from_arms

    def _apply(self, name: str, inputs: Tensor) -> Tensor:
        mean, scale, output_mean, output_scale = (
            getattr(self, f"{name}_{key}") for key in ("input_mean", "input_scale", "output_mean", "output_scale")
        )
        # Trackers never leave four deviations on anybody the network knows: beyond, it is held there.
        x = torch.clamp((inputs - mean) * (1 / scale), -4.0, 4.0)
        *hidden, last = getattr(self, name)
        for layer in hidden:
            x = layer(x)
        # Its scale is the last layer's own: a layer, not two more nodes.
        return functional.linear(x, last.weight * output_scale[:, None], last.bias * output_scale + output_mean)

    def _with_mirror_images(self, inputs: Tensor) -> Tensor:
        """Each body, then its mirror image [2 N, T·46 + 38]."""
        return (inputs[:, self.mirror_column] * self.mirror_sign).view(-1, self.inputs)

    def _right_arm(self, bodies: Tensor, shift: Tensor) -> Tensor:
        """What the right arm is told [N, ARM_FEATURES], its shoulder being so far from IK's [N, 3]."""
        reach, others, arm = bodies[:, self.arm_columns].split([3, 13, 1], dim=1)
        # Without a body, as when a page tries the network, no division by nothing.
        reach = reach - shift / arm.clamp_min(1e-3)
        return torch.cat([reach, reach.norm(dim=-1, keepdim=True), others], dim=1)


# Reach, its length, axes of the hand, IK's elbow, the room's up, whether the hand is seen.
ARM_FEATURES = 17

FLIP = torch.tensor([-1.0, 1.0, 1.0])
# What the chest sees of an arm (reach, two axes of the hand, IK's elbow), mirrored; a mirrored rotation's x axis is turned round too.
ARM_FLIP = torch.cat([FLIP, -FLIP, FLIP, FLIP])


def _perceptron(inputs: int, width: int, hidden_layers: int, dropout: float, outputs: int) -> nn.Sequential:
    layers: list[nn.Module] = []
    for layer in range(hidden_layers):
        layers += [nn.Linear(inputs if layer == 0 else width, width), nn.ELU(), nn.Dropout(dropout)]
    return nn.Sequential(*layers, nn.Linear(width, outputs))


def _from_trunk() -> Tensor:
    """[24, 18 + 6]: what the trunk says of a body and its image to how the six joints move, elbows with their shoulders, and both right shoulders."""
    body, image = torch.eye(24).view(2, 4, 3, 24)
    left, right, chest, hips = ((body[joint] + FLIP[:, None] * image[twin]) / 2 for joint, twin in enumerate([1, 0, 2, 3]))
    return torch.cat([left, right, left, right, chest, hips, right, FLIP[:, None] * left]).T


def _from_arms() -> Tensor:
    """[6, 18]: the right elbow's move in a body and in its image to those of the six joints."""
    right, image = torch.eye(6).view(2, 3, 6)
    return torch.cat([FLIP[:, None] * image, right, torch.zeros(12, 6)]).T


def _arm_columns(taps: int) -> Tensor:
    """Of a body's features: the right arm's reach, what else it is told, the arm's length."""
    chest = taps * FEATURES
    return torch.tensor([*range(chest + 12, chest + 24), *range(chest + 33, chest + 36), 26, 45])


def _mirror_image(taps: int) -> tuple[Tensor, Tensor]:
    """Column and sign of each feature of a body [2 · (T·46 + 38)] and of its mirror image, over all frames of the window."""
    frame, frame_sign = torch.arange(FEATURES), torch.ones(FEATURES)
    frame[7:25] = torch.cat([torch.arange(16, 25), torch.arange(7, 16)])
    frame[25:27] = torch.tensor([26, 25])
    frame[IK_JOINTS] = torch.arange(27, 45).view(6, 3)[MIRRORED_JOINTS].flatten()
    # A mirrored rotation's x axis is mirrored and turned round.
    frame_sign[1:7] = torch.cat([-FLIP, FLIP])
    frame_sign[7:25] = torch.cat([FLIP, -FLIP, FLIP]).repeat(2)
    frame_sign[IK_JOINTS] = FLIP.repeat(6)
    chest, chest_sign = torch.arange(CHEST_FEATURES), torch.ones(CHEST_FEATURES)
    chest[:24] = torch.cat([torch.arange(12, 24), torch.arange(12)])
    chest[36:] = torch.tensor([37, 36])
    chest_sign[:24] = ARM_FLIP.repeat(2)
    chest_sign[24:36] = torch.cat([-FLIP, FLIP, FLIP, FLIP])
    inputs = taps * FEATURES + CHEST_FEATURES
    column = torch.cat([*(frame + tap * FEATURES for tap in range(taps)), chest + taps * FEATURES])
    sign = torch.cat([*[frame_sign] * taps, chest_sign])
    return torch.cat([torch.arange(inputs), column]), torch.cat([torch.ones(inputs), sign])
