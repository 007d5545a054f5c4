"""Constants that Python and TypeScript both read; names, units and reasons stand in the files."""

import json
from pathlib import Path
from typing import Any

REPOSITORY = Path(__file__).parents[2]
CORE = REPOSITORY / "src/threepoint/core"


def _read(file: str) -> dict[str, Any]:
    return json.loads((CORE / file).read_text())


_LIMITS = _read("estimation/kinematic-limits.json")
IK: dict[str, Any] = _LIMITS["ik"]
HIPS_DOUBT: dict[str, float] = _LIMITS["hipsDoubt"]
TORSO: dict[str, float] = _LIMITS["torso"]
TORSO_EXTREME: dict[str, float] = _LIMITS["torsoExtreme"]
REACH: dict[str, Any] = _LIMITS["reach"]
TRUNK_CAPSULE: dict[str, float] = _LIMITS["trunkCapsule"]
LIMB = _read("body/limb-limits.json")
TRAPEZOIDAL_RAMP: float = _read("math/easing.json")["trapezoidalRamp"]
HAND_TILTS = _read("estimation/online-calibration/hand-tilts.json")
HEADSET_RISE = _read("estimation/online-calibration/headset-rise.json")
LOST_HAND = _read("estimation/lost-hand.json")

# What the page and the evaluation assume of motion capture: known skeletons, units, cuts, and how trackers err. The CMU
# database measures in units of 1/0.45 inch (the ASF header's `length 0.45`).
MOCAP_RULES = _read("mocap/mocap-rules.json")
