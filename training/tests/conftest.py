"""Tests that need PyTorch are collected where it is installed: npm run test:training."""

from importlib.util import find_spec

collect_ignore = [] if find_spec("torch") else ["test_ablation.py", "test_leave_one_out.py", "test_model.py", "test_neutral_pose.py", "test_person_effects.py"]
