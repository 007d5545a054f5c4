"""The two networks. Normalisation lives inside both: SI units or ratios go in and come out."""

import torch
from torch import Tensor, nn

from .features import FEATURES, IK_JOINTS, OUTPUTS


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
    """[N, T·46] features -> [N, 18] joints: the IK solution in the newest frame plus a learned correction."""

    def __init__(self, taps: int, width: int, dropout: float, hidden_layers: int = 2) -> None:
        super().__init__()
        inputs = taps * FEATURES
        layers: list[nn.Module] = []
        for layer in range(hidden_layers):
            layers += [nn.Linear(inputs if layer == 0 else width, width), nn.ELU(), nn.Dropout(dropout)]
        self.body = nn.Sequential(*layers, nn.Linear(width, OUTPUTS))
        self.register_buffer("input_mean", torch.zeros(1, inputs))
        self.register_buffer("input_scale", torch.ones(1, inputs))
        self.register_buffer("output_mean", torch.zeros(1, OUTPUTS))
        self.register_buffer("output_scale", torch.ones(1, OUTPUTS))

    def normalise(self, inputs: Tensor, residuals: Tensor) -> None:
        """Takes mean and deviation from the training data; constant features keep their size."""
        self.input_mean.copy_(inputs.mean(0, keepdim=True))
        self.input_scale.copy_(inputs.std(0, keepdim=True).clamp_min(2e-2))
        self.output_mean.copy_(residuals.mean(0, keepdim=True))
        self.output_scale.copy_(residuals.std(0, keepdim=True).clamp_min(1e-4))

    def forward(self, inputs: Tensor) -> Tensor:
        # Trackers never leave four deviations on anybody the network knows: beyond, it is held there.
        x = torch.clamp((inputs - self.input_mean) / self.input_scale, -4.0, 4.0)
        correction = self.body(x) * self.output_scale + self.output_mean
        return inputs[:, IK_JOINTS] + correction
