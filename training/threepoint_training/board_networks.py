"""Two networks of the field that the board compares with ours, written from their papers: windows of 40 frames in, the
rotations of the body's joints out.

A Transformer encoder after AvatarPoser (Jiang et al., ECCV 2022), and a perceptron with a memory after AGRoL (Du et
al., CVPR 2023) and Mem-MLP. Both estimate rotations in six numbers, of which forward kinematics makes joints.
"""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor, nn

from .prepared_corpus import ESTIMATED_JOINTS
from .skeleton import body_from_calibration, load_proportions, rest_offsets
from .window_features import FRAME_FEATURES, FRAMES, HEAD_PLACE, HEAD_TURN, INPUTS, ROTATION

# The joints that get a rotation, parents first; those below the hips, relative to their parents.
_PARENTS = {
    "spine": "hips",
    "chest": "spine",
    "upperChest": "chest",
    "neck": "upperChest",
    "leftShoulder": "upperChest",
    "leftUpperArm": "leftShoulder",
    "leftLowerArm": "leftUpperArm",
    "rightShoulder": "upperChest",
    "rightUpperArm": "rightShoulder",
    "rightLowerArm": "rightUpperArm",
}
_ENDS = {"head": "neck", "leftHand": "leftLowerArm", "rightHand": "rightLowerArm"}
_PLACED = (*ESTIMATED_JOINTS, "leftHand", "rightHand")


def _matrices(numbers: Tensor) -> Tensor:
    """Rotations [..., 3, 3] of six numbers [..., 6], made orthogonal (Gram and Schmidt)."""
    x = nn.functional.normalize(numbers[..., :3], dim=-1)
    y = numbers[..., 3:]
    y = nn.functional.normalize(y - (x * y).sum(-1, keepdim=True) * x, dim=-1)
    return torch.stack([x, y, torch.linalg.cross(x, y)], dim=-1)


class WindowNetwork(nn.Module):
    """[N, INPUTS] -> [N, 18]: the six joints in the heading frame of the newest frame, from the headset's floor point,
    in eye heights. A subclass makes rotations of frames.
    """

    def __init__(self) -> None:
        super().__init__()
        unit = body_from_calibration(np.array(1.0), np.array(1.0))
        self.rest = {joint: torch.tensor(offset, dtype=torch.float32) for joint, offset in rest_offsets(unit).items()}
        self.upper_arm_share: float = load_proportions()["upperArmShare"]
        self.register_buffer("mean", torch.zeros(INPUTS - 1))
        self.register_buffer("scale", torch.ones(INPUTS - 1))

    def normalise(self, inputs: Tensor) -> None:
        """Takes mean and deviation from inputs of the training data."""
        self.mean.copy_(inputs[:, :-1].mean(0))
        self.scale.copy_(inputs[:, :-1].std(0).clamp_min(1e-3))

    def rotations(self, frames: Tensor) -> Tensor:
        """Six numbers for each rotation [N, 1 + 10, 6] from standardised frames [N, FRAMES, FRAME_FEATURES]."""
        raise NotImplementedError

    def forward(self, inputs: Tensor) -> Tensor:
        return self.joints(inputs)[:, : len(ESTIMATED_JOINTS)].flatten(1)

    def joints(self, inputs: Tensor) -> Tensor:
        """The six joints and both wrists [N, 8, 3], with the head joint where the headset has it. Training computes the
        rotations with 16 bits.
        """
        frames = ((inputs[:, :-1] - self.mean) / self.scale).view(-1, FRAMES, FRAME_FEATURES)
        upright = inputs.new_tensor([1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
        # Kinematics in 16 bits would be off by millimetres.
        with torch.autocast("cpu", torch.bfloat16, enabled=self.training):
            numbers = self.rotations(frames)
        local = _matrices(numbers.float() + upright)
        turns, places = {"hips": local[:, 0]}, {"hips": torch.zeros_like(inputs[:, :3])}
        for number, (joint, parent) in enumerate((_PARENTS | _ENDS).items()):
            offset = (turns[parent] @ self._offset(joint, inputs).unsqueeze(-1)).squeeze(-1)
            places[joint] = places[parent] + offset
            if joint in _PARENTS:
                turns[joint] = turns[parent] @ local[:, 1 + number]
        newest = inputs[:, -1 - FRAME_FEATURES : -1]
        head = _matrices(newest[:, HEAD_TURN])
        head_joint = newest[:, HEAD_PLACE] - head @ self.rest["eyesInHead"]
        moved = head_joint - places["head"]
        return torch.stack([places[joint] + moved for joint in _PLACED], dim=1)

    def _offset(self, joint: str, inputs: Tensor) -> Tensor:
        """A joint's offset from its parent [N, 3]; those along the arm have its calibrated length."""
        shares = {"LowerArm": self.upper_arm_share, "Hand": 1 - self.upper_arm_share}
        share = next((share for end, share in shares.items() if joint.endswith(end)), None)
        if share is None:
            return self.rest[joint].expand(inputs.shape[0], 3)
        along = torch.sign(self.rest[joint])
        return inputs[:, -1:] * share * along


@dataclass(frozen=True)
class TransformerShape:
    """AvatarPoser's sizes, with PyTorch's width of the feed-forward layers: 4.1 million parameters."""

    layers: int = 3
    heads: int = 8
    width: int = 256
    hidden: int = 2048
    dropout: float = 0.1


class _EncoderLayer(nn.Module):
    """A layer of the encoder, for some of its tokens."""

    def __init__(self, shape: TransformerShape) -> None:
        super().__init__()
        self.attention = nn.MultiheadAttention(shape.width, shape.heads, shape.dropout, batch_first=True)
        self.hidden = nn.Sequential(
            nn.Linear(shape.width, shape.hidden),
            nn.ReLU(),
            nn.Dropout(shape.dropout),
            nn.Linear(shape.hidden, shape.width),
        )
        self.dropout = nn.Dropout(shape.dropout)
        self.norms = nn.ModuleList(nn.LayerNorm(shape.width) for _ in range(2))

    def forward(self, tokens: Tensor, wanted: Tensor) -> Tensor:
        attended = self.attention(wanted, tokens, tokens, need_weights=False)[0]
        wanted = self.norms[0](wanted + self.dropout(attended))
        return self.norms[1](wanted + self.dropout(self.hidden(wanted)))


class TransformerNetwork(WindowNetwork):
    """After AvatarPoser: an encoder whose newest token gives the hips' rotation and, by a head of its own, the others.

    The last layer computes the newest token alone, which changes no output. Frames have a trained position each.
    """

    def __init__(self, shape: TransformerShape = TransformerShape()) -> None:
        super().__init__()
        self.embedding = nn.Linear(FRAME_FEATURES, shape.width)
        self.place = nn.Parameter(torch.zeros(FRAMES, shape.width))
        self.layers = nn.ModuleList(_EncoderLayer(shape) for _ in range(shape.layers))
        self.heads = nn.ModuleList(
            nn.Sequential(nn.Linear(shape.width, shape.width), nn.ReLU(), nn.Linear(shape.width, ROTATION * count))
            for count in (1, len(_PARENTS))
        )

    def rotations(self, frames: Tensor) -> Tensor:
        tokens = self.embedding(frames) + self.place
        for layer in self.layers[:-1]:
            tokens = layer(tokens, tokens)
        newest = self.layers[-1](tokens, tokens[:, -1:])[:, 0]
        return torch.cat([head(newest) for head in self.heads], dim=1).view(-1, 1 + len(_PARENTS), ROTATION)


@dataclass(frozen=True)
class MemoryShape:
    """Half the blocks of AGRoL's perceptron, at its width."""

    blocks: int = 6
    width: int = 512
    codes: int = 64


class _MixingBlock(nn.Module):
    """Mixes the frames, then the channels, of [N, FRAMES, width]."""

    def __init__(self, width: int) -> None:
        super().__init__()
        self.frames, self.channels = nn.Linear(FRAMES, FRAMES), nn.Linear(width, width)
        self.norms = nn.ModuleList(nn.LayerNorm(width) for _ in range(2))

    def forward(self, x: Tensor) -> Tensor:
        mixed = self.frames(self.norms[0](x).transpose(1, 2)).transpose(1, 2)
        x = x + nn.functional.silu(mixed)
        return x + nn.functional.silu(self.channels(self.norms[1](x)))


class MemoryNetwork(WindowNetwork):
    """After Mem-MLP: blocks of perceptrons over frames and channels, and a memory of trained codes for what no tracker
    sees, which every frame reads by attention after the first block.
    """

    def __init__(self, shape: MemoryShape = MemoryShape()) -> None:
        super().__init__()
        self.embedding = nn.Linear(FRAME_FEATURES, shape.width)
        self.blocks = nn.ModuleList(_MixingBlock(shape.width) for _ in range(shape.blocks))
        self.keys = nn.Parameter(torch.randn(shape.width, shape.codes) / shape.width**0.5)
        self.codes = nn.Parameter(torch.zeros(shape.codes, shape.width))
        self.output = nn.Linear(shape.width, ROTATION * (1 + len(_PARENTS)))

    def rotations(self, frames: Tensor) -> Tensor:
        x = self.blocks[0](self.embedding(frames))
        x = x + torch.softmax(x @ self.keys, dim=-1) @ self.codes
        for block in self.blocks[1:]:
            x = block(x)
        return self.output(x[:, -1]).view(-1, 1 + len(_PARENTS), ROTATION)


NETWORKS: dict[str, type[WindowNetwork]] = {"transformer": TransformerNetwork, "memory": MemoryNetwork}
