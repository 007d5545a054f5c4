"""Tests that need PyTorch are collected where it is installed: npm run test:training."""

from importlib.util import find_spec

_NEED_TORCH = ("ablation", "bent_wrists", "command_line", "leave_one_out", "model", "neutral_pose", "noticed_wear", "subject_effects", "differentiable_kinematics", "swivel_limiter")
collect_ignore = [] if find_spec("torch") else [f"test_{name}.py" for name in _NEED_TORCH]
