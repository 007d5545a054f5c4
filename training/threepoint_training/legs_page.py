"""Renews the table of legs in docs/accuracy.md. `npm run tool -- report --legs` measures and calls this."""

import argparse
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .accuracy_tables import renew, table
from .shared_constants import REPOSITORY
from .splits import evaluation_only, trainable

Json = dict[str, Any]

DRIVERS = {"truth": "the true pelvis", "ik": "IK", "learned": "learned"}
_FIGURES = ("pelvisCm", "kneeCm", "footCm", "skateCmS", "floatCm", "agreed")
_HEAD = ("pelvis [cm]", "knee [cm]", "foot [cm]", "skate [cm/s]", "floating [cm]", "contact agreed")


def _mean(people: Iterable[Json], driver: str, figure: str) -> float:
    values = [person[driver][figure] for person in people]
    return sum(values) / len(values)


def _cells(people: list[Json], driver: str) -> list[str]:
    digits = {
        "agreed": "{:.0%}",
        "pelvisCm": "{:.1f}",
        "kneeCm": "{:.1f}",
        "footCm": "{:.1f}",
        "skateCmS": "{:.0f}",
    }
    return [
        digits.get(figure, "{:.2f}").format(_mean(people, driver, figure)).replace("%", " %") for figure in _FIGURES
    ]


def drivers(legs: Json) -> str:
    """Returns the table by source of the pelvis: means over people, equally weighted; evaluation-only subjects have
    separate rows.
    """
    people = legs["people"]
    groups = {"": trainable(list(people)), ", another laboratory": evaluation_only(list(people))}
    rows = [
        [f"{label}{group}", *_cells([people[name] for name in names], driver)]
        for group, names in groups.items()
        if names
        for driver, label in DRIVERS.items()
    ]
    return table(["legs under", *_HEAD], rows)


def main(legs: Path, page: Path) -> None:
    """Writes the page."""
    measured = json.loads(legs.read_text())
    page.write_text(renew(page.read_text(), {"legs": drivers(measured)}))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="The table of legs in docs/accuracy.md.")
    parser.add_argument("--legs", type=Path, required=True)
    parser.add_argument("--page", type=Path, default=REPOSITORY / "docs/accuracy.md")
    given = parser.parse_args()
    main(given.legs, given.page)
