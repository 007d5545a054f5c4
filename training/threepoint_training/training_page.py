"""Renews the table of results in docs/training.md from the contracts of the page's networks."""

import json
from pathlib import Path
from typing import Any

from .accuracy_tables import renew, table
from .training_report import LABELS

PAGE = Path(__file__).parents[2] / "docs/training.md"
METHODS = {"IK": "IK", "paper": "the paper's network", "learned": "ours"}


def results(contracts: list[dict[str, Any]]) -> str:
    """The table of errors [cm] on held-out people that contracts state, by protocol; where two contracts state a row, the first one's."""
    found: dict[str, dict[str, dict[str, float]]] = {}
    for contract in contracts:
        for row, errors in contract["errors"].items():
            method, protocol = row.split(", ", 1)
            if "trained on" not in protocol:
                found.setdefault(protocol, {}).setdefault(method, errors)
    rows = [
        [f"{protocol}: {name}", *(f"{by_method[method][label]:.2f}" for label in ("mean", *LABELS))]
        for protocol, by_method in found.items()
        for method, name in METHODS.items()
        if method in by_method
    ]
    return table(["cm", "mean", *LABELS], rows)


def write(models: Path, page: Path = PAGE) -> None:
    """Renews the page's table by the contracts in that folder."""
    contracts = [json.loads((models / f"{name}.json").read_text()) for name in ("learned", "paper")]
    page.write_text(renew(page.read_text(), {"results": results(contracts)}))
