"""The two networks. Normalisation lives inside both: SI units or ratios go in and come out."""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from . import mirror
from .chest_features import ARM_COLUMNS, ARMS, CHEST_FEATURES, CHEST_HEAD_AXES, CHEST_JOINT, REACH_LENGTHS, UP
from .features import ARM_LENGTH, FEATURES, HANDS, HEAD_AXES, IK_JOINTS, SEEN
from .residual import OUTPUTS

# Inputs of the people trained on lie within so many standard deviations of their mean; what lies beyond is held there,
# here as in the page's Perceptron.
MOST_DEVIATIONS = 4.0


@dataclass(frozen=True)
class PaperShape:
    """What section 3.3 of the paper leaves open: how many networks share the 18 outputs, the filters of the first
    convolution, and the width of the first fully connected layer.
    """

    networks: int = 1
    first_filters: int = 32
    width: int = 512


class PaperNetwork(nn.Module):
    """Section 3.3 of the paper: [N, 2, 3, 3] -> [N, 18], or this many of the outputs.

    Four 3×3 convolutions, each with twice the filters of the one before (32 to 256 by default), stride 1, zero padding,
    ReLU; dropout 0.3 after the first convolution and the first fully connected layer. Its default width, 512, gives
    1.58 million parameters, a file of 6 MB.
    """

    def __init__(self, shape: PaperShape = PaperShape(), outputs: int = OUTPUTS) -> None:
        super().__init__()
        channels = [2] + [shape.first_filters * 2**layer for layer in range(4)]
        self.convolutions = nn.ModuleList(
            nn.Conv2d(before, after, 3, padding=1) for before, after in zip(channels[:-1], channels[1:], strict=True)
        )
        self.dropout = nn.Dropout(0.3)
        self.hidden = nn.Linear(channels[-1] * 9, shape.width)
        self.output = nn.Linear(shape.width, outputs)
        self.register_buffer("input_mean", torch.zeros(1, 2, 3, 3))
        self.register_buffer("input_scale", torch.ones(1, 2, 3, 3))
        self.register_buffer("output_mean", torch.zeros(1, outputs))
        self.register_buffer("output_scale", torch.ones(1, outputs))

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


class RepeatedPaperNetwork(nn.Module):
    """Several of the paper's networks, each for its part of the 18 outputs: “the model repeats regression steps for
    each of the outputs being estimated”. The mean of their losses trains each as if it were alone.
    """

    def __init__(self, shape: PaperShape) -> None:
        super().__init__()
        self.outputs = OUTPUTS // shape.networks
        self.networks = nn.ModuleList(PaperNetwork(shape, self.outputs) for _ in range(shape.networks))

    @property
    def output_mean(self) -> Tensor:
        return torch.cat([network.output_mean for network in self.networks], dim=1)

    @property
    def output_scale(self) -> Tensor:
        return torch.cat([network.output_scale for network in self.networks], dim=1)

    def normalise(self, inputs: Tensor, targets: Tensor) -> None:
        """Takes mean and deviation from the training data."""
        for network, own in zip(self.networks, targets.split(self.outputs, dim=1), strict=True):
            network.normalise(inputs, own)

    def standardised(self, inputs: Tensor) -> Tensor:
        """The output in standard deviations, which the loss compares."""
        return torch.cat([network.standardised(inputs) for network in self.networks], dim=1)

    def forward(self, inputs: Tensor) -> Tensor:
        return torch.cat([network(inputs) for network in self.networks], dim=1)


class CorrectionNetwork(nn.Module):
    """[N, T·46 + 38] features -> [N, 18]: the residual to add to IK's six joints, chest frame, in eye heights.

    In the chest frame an arm looks the same however its body turns and leans. A trunk network corrects shoulders, chest
    joint and hips; an arm network, the same for both sides, then corrects an elbow, given nothing but its own hand and
    shoulder. A body and its mirror image get mirrored corrections.

    In a browser a node of the graph costs more than its arithmetic, so linear steps are merged into one matrix.
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
        corrections = torch.stack([corrections, corrections[:, mirror.JOINTS] * FLIP], dim=1).flatten(0, 1)
        self._take("trunk", bodies, corrections[:, 2:].flatten(1))
        self._take("arm", self._right_arm(bodies, corrections[:, 3]), corrections[:, 1] - corrections[:, 3])

    def _take(self, name: str, inputs: Tensor, outputs: Tensor) -> None:
        getattr(self, f"{name}_input_mean").copy_(inputs.mean(0, keepdim=True))
        getattr(self, f"{name}_input_scale").copy_(inputs.std(0, keepdim=True).clamp_min(2e-2))
        getattr(self, f"{name}_output_mean").copy_(outputs.mean(0))
        getattr(self, f"{name}_output_scale").copy_(outputs.std(0).clamp_min(1e-4))

    def shrink_trunk(self, share: float) -> None:
        """Multiplies the trunk's correction by this share in [0, 1]."""
        self.trunk_output_mean.mul_(share)
        self.trunk_output_scale.mul_(share)

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
        x = torch.clamp((inputs - mean) * (1 / scale), -MOST_DEVIATIONS, MOST_DEVIATIONS)
        *hidden, last = getattr(self, name)
        for layer in hidden:
            x = layer(x)
        # Its scale is the last layer's own: a layer, not two more nodes.
        return functional.linear(x, last.weight * output_scale[:, None], last.bias * output_scale + output_mean)

    def _with_mirror_images(self, inputs: Tensor) -> Tensor:
        """Each body, then its mirror image [2 N, T·46 + 38]."""
        return (inputs[:, self.mirror_column] * self.mirror_sign).view(-1, self.inputs)

    def _right_arm(self, bodies: Tensor, shift: Tensor) -> Tensor:
        """The inputs of the arm network [N, ARM_FEATURES] for the right arm, whose shoulder was corrected by `shift`
        [N, 3].
        """
        reach, others, arm = bodies[:, self.arm_columns].split([3, 13, 1], dim=1)
        # Inputs of zeros, with which a page tries the network out, must not divide by zero.
        reach = reach - shift / arm.clamp_min(1e-3)
        return torch.cat([reach, reach.norm(dim=-1, keepdim=True), others], dim=1)


class ByteDropout(nn.Module):
    """Dropout whose share is a multiple of 1/256: a random byte for each number, where PyTorch's draws a double on one
    thread.

    Masks follow PyTorch's seed. A layer of 2048 × 192 numbers takes 2 ms there and back instead of 16.
    """

    def __init__(self, share: float) -> None:
        super().__init__()
        self.kept = 256 - round(256 * share)
        self.random: np.random.Generator | None = None

    def forward(self, x: Tensor) -> Tensor:
        if not self.training or self.kept == 256:
            return x
        if self.random is None:
            self.random = np.random.default_rng(torch.randint(2**31, ()).item())
        drawn = np.frombuffer(self.random.bytes(x.numel()), np.uint8)
        mask = torch.from_numpy(drawn < self.kept).view(x.shape)
        return x * (mask * (256 / self.kept))


# Reach, its length, axes of the hand, IK's elbow, the room's up, whether the hand is seen.
ARM_FEATURES = 17

# What a mirror multiplies the components of a position by.
FLIP = torch.tensor(mirror.POSITION, dtype=torch.float32)
# Mirrors the chest-frame features of an arm (reach, two axes of the hand, IK's elbow); a mirrored rotation's x axis
# changes its sign too.
ARM_FLIP = torch.cat([FLIP, -FLIP, FLIP, FLIP])


def _perceptron(inputs: int, width: int, hidden_layers: int, dropout: float, outputs: int) -> nn.Sequential:
    layers: list[nn.Module] = []
    for layer in range(hidden_layers):
        layers += [nn.Linear(inputs if layer == 0 else width, width), nn.ELU(), ByteDropout(dropout)]
    return nn.Sequential(*layers, nn.Linear(width, outputs))


def _from_trunk() -> Tensor:
    """[24, 18 + 6]: from the trunk's outputs for a body and its image to corrections of the six joints (elbows with
    their shoulders) and of both right shoulders.
    """
    body, image = torch.eye(24).view(2, 4, 3, 24)
    left, right, chest, hips = (
        (body[joint] + FLIP[:, None] * image[twin]) / 2 for joint, twin in enumerate([1, 0, 2, 3])
    )
    return torch.cat([left, right, left, right, chest, hips, right, FLIP[:, None] * left]).T


def _from_arms() -> Tensor:
    """[6, 18]: from the right elbow's correction in a body and in its image to those of the six joints."""
    right, image = torch.eye(6).view(2, 3, 6)
    return torch.cat([FLIP[:, None] * image, right, torch.zeros(12, 6)]).T


def _arm_columns(taps: int) -> Tensor:
    """Columns of a body's inputs: reach, hand and elbow of the right arm, up, whether the right hand is seen, the arm's
    length.
    """
    chest = taps * FEATURES
    right_arm = range(chest + ARMS.start + ARM_COLUMNS, chest + ARMS.stop)
    return torch.tensor([*right_arm, *range(chest + UP.start, chest + UP.stop), SEEN.stop - 1, ARM_LENGTH])


def _mirror_image(taps: int) -> tuple[Tensor, Tensor]:
    """Column and sign of each feature of a body [2 · (T·46 + 38)] and of its mirror image, over all frames of the
    window.
    """
    frame, frame_sign = torch.arange(FEATURES), torch.ones(FEATURES)
    left, right = HANDS
    frame[left], frame[right] = frame[right].clone(), frame[left].clone()
    frame[SEEN] = frame[SEEN].flip(0)
    frame[IK_JOINTS] = frame[IK_JOINTS].view(6, 3)[mirror.JOINTS].flatten()
    # A mirrored rotation's x axis is mirrored and turned round.
    frame_sign[HEAD_AXES] = torch.cat([-FLIP, FLIP])
    for hand in HANDS:
        frame_sign[hand] = torch.cat([FLIP, -FLIP, FLIP])
    frame_sign[IK_JOINTS] = FLIP.repeat(6)
    chest, chest_sign = torch.arange(CHEST_FEATURES), torch.ones(CHEST_FEATURES)
    chest[ARMS] = chest[ARMS].view(2, ARM_COLUMNS).flip(0).flatten()
    chest[REACH_LENGTHS] = chest[REACH_LENGTHS].flip(0)
    chest_sign[ARMS] = ARM_FLIP.repeat(2)
    chest_sign[CHEST_HEAD_AXES] = torch.cat([-FLIP, FLIP])
    chest_sign[CHEST_JOINT], chest_sign[UP] = FLIP, FLIP
    inputs = taps * FEATURES + CHEST_FEATURES
    column = torch.cat([*(frame + tap * FEATURES for tap in range(taps)), chest + taps * FEATURES])
    sign = torch.cat([*[frame_sign] * taps, chest_sign])
    return torch.cat([torch.arange(inputs), column]), torch.cat([torch.ones(inputs), sign])
