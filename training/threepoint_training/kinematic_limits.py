"""Limits and shares that Python and TypeScript both read; names, units and reasons stand in the files."""

import json
from pathlib import Path
from typing import Any

_CORE = Path(__file__).parents[2] / "src/threepoint/core"
_LIMITS: dict[str, Any] = json.loads((_CORE / "estimation/kinematic-limits.json").read_text())

IK: dict[str, Any] = _LIMITS["ik"]
TORSO: dict[str, float] = _LIMITS["torso"]
TORSO_EXTREME: dict[str, float] = _LIMITS["torsoExtreme"]
REACH: dict[str, Any] = _LIMITS["reach"]
LIMB: dict[str, Any] = json.loads((_CORE / "body/limb-limits.json").read_text())
TRAPEZOIDAL_RAMP: float = json.loads((_CORE / "math/easing.json").read_text())["trapezoidalRamp"]
TRUNK_CAPSULE: dict[str, float] = _LIMITS["trunkCapsule"]
HAND_TILTS: dict[str, Any] = json.loads((_CORE / "estimation/online-calibration/hand-tilts.json").read_text())
HEADSET_RISE: dict[str, Any] = json.loads((_CORE / "estimation/online-calibration/headset-rise.json").read_text())
LOST_HAND: dict[str, Any] = json.loads((_CORE / "estimation/lost-hand.json").read_text())
