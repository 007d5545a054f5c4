"""What the page and the evaluation hold true of motion capture alike: known skeletons, units, cuts, and how trackers
err.

The CMU database measures in units of 1/0.45 inch (the ASF header's `length 0.45`).
"""

import json
from pathlib import Path
from typing import Any

RULES: dict[str, Any] = json.loads(
    (Path(__file__).parents[2] / "src/threepoint/core/mocap/mocap-rules.json").read_text()
)
