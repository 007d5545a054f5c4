"""Tests that need PyTorch are collected where it is installed: npm run test:training."""

from importlib.util import find_spec

_NEED_TORCH = (
    "command_line",
    "lockbox",
    "model",
    "online_calibration",
    "differentiable_kinematics",
    "selection",
    "swivel_limiter",
)
collect_ignore = [] if find_spec("torch") else [f"test_{name}.py" for name in _NEED_TORCH]
