"""Renews the tables of docs/paper.md between its marks, and its figures, from what was measured. `npm run tool --
paper` calls this.
"""

import argparse
import json
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import log
from operator import itemgetter
from pathlib import Path
from typing import Any

from . import prepare
from .accuracy_tables import renew, table
from .motion_files import MocapError
from .shared_constants import REPOSITORY
from .stage_files import read_stage

Json = dict[str, Any]

# How each reading of reproduce_paper.READINGS is called.
LABELS = {
    "page": "the page's: axes that turn with the head",
    "room": "axes of the room",
    "iterations": "150 batches an epoch",
    "joints": "recorded joints as inputs",
    "parent": "hands' angles from the true forearm",
    "filtered": "similar poses left out",
    "wide": "width 2304",
    "literal": "150 batches, width 2304, recorded joints, filtered",
    "six": "six networks",
    "eighteen": "eighteen networks",
}
_JOINTS = {
    "j4": "j4, left elbow",
    "j5": "j5, right elbow",
    "j6": "j6, left shoulder",
    "j7": "j7, right shoulder",
    "j8": "j8, spine",
    "j9": "j9, pelvis",
}
# The paper's tables 1 to 6.
_MSE = {
    "j4": (0.0245, 0.0342),
    "j5": (0.0387, 0.0456),
    "j6": (0.0336, 0.0448),
    "j7": (0.0267, 0.3870),
    "j8": (0.0242, 0.3940),
    "j9": (0.0382, 0.4270),
}
_MSE_OF_METHODS = {"ik": 0.8066, "paper": 0.0448}
_RIGHT_SHOULDER_MAE = {"ik": 0.1587, "paper": 0.0610}
_MPJPE_CM = {"train": 2.4026, "test": 1.7301}
# Least, mean and most [ms].
_TIMES = {"ik": ((3.81, 10.23, 19.65), (4.28, 16.78, 22.41)), "paper": ((3.19, 6.73, 14.75), (3.36, 9.21, 17.01))}
_METHODS = {"ik": "IK", "paper": "the network"}


@dataclass(frozen=True)
class PaperPageConfig:
    """stages: the folder of the measured stages; path: the measurement of the page's code path."""

    stages: Path
    path: Path
    page: Path = REPOSITORY / "docs/paper.md"
    images: Path = REPOSITORY / "docs/images/paper"


def _mean(values: dict[str, float]) -> float:
    return sum(values.values()) / len(values)


def _distance_from_the_paper(reading: Json) -> float:
    """How far table 4 of a reading is from the paper's: the sum of the logarithms of both ratios."""
    return sum(abs(log(reading[side]["mpjpeCm"] / published)) for side, published in _MPJPE_CM.items())


def _together(values: Iterable[float], digits: int) -> str:
    """Returns several figures of one cell."""
    return "/".join(f"{value:.{digits}f}" for value in values)


def table_1(page: Json, held_out: Json) -> str:
    """Returns MSE by joint: the paper's, ours of standardised coordinates, and of people held out in cm²."""

    def row(label: str, published: tuple[float, float], figure: Callable[[dict[str, float]], float]) -> list[str]:
        ours = (figure(page[side]["mseStandardised"]) for side in _MPJPE_CM)
        new = f"{figure(held_out['test']['mseCm2']):.1f}"
        return [label, _together(published, 4), _together(ours, 4), new]

    rows = [row(label, _MSE[joint], itemgetter(joint)) for joint, label in _JOINTS.items()]
    rows.append(row("mean", (0.0277, 0.0448), _mean))
    return table(["MSE, train/test", "paper", "ours", "people held out [cm²]"], rows)


def tables_2_and_3(page: Json, ik: Json, path: Json) -> str:
    """Returns MSE and the right shoulder's MAE of both methods on test frames, and errors on the page's code path."""

    def new_people(method: str) -> list[str]:
        measured = path["methods"][method]
        return [f"{measured['mseCm2']:.1f}", f"{measured['mpjpeCm']['mean']:.2f}"]

    rows = [
        [
            _METHODS[method],
            f"{_MSE_OF_METHODS[method]:.4f}",
            f"{_mean(figures['test']['mseCm2']):.2f}",
            f"{_RIGHT_SHOULDER_MAE[method]:.4f}",
            f"{figures['test']['rightShoulderMaeCm']:.2f}",
            *new_people(method),
        ]
        for method, figures in (("ik", ik), ("paper", page))
    ]
    rows.append(["with section 3.5", *[""] * 4, *new_people("paper-published")])
    head = ["test frames", "MSE: paper", "ours [cm²]", "MAE of j7: paper", "ours [cm]"]
    return table([*head, "new people: MSE [cm²]", "MPJPE [cm]"], rows)


def table_4(readings: dict[str, Json]) -> str:
    """Returns the MPJPE of every reading, nearest to the paper's first."""
    rows = [["**the paper**", "22", f"**{_together(_MPJPE_CM.values(), 2)}**", "0.0448"]]
    for name in sorted(readings, key=lambda name: _distance_from_the_paper(readings[name])):
        reading = readings[name]
        errors = _together((reading[side]["mpjpeCm"] for side in _MPJPE_CM), 2)
        mse = f"{_mean(reading['test']['mseStandardised']):.4f}"
        rows.append([LABELS[name], f"{reading['megabytes']:.0f}", errors, mse])
    return table(["reading", "MB", "MPJPE [cm], train/test", "MSE, test"], rows)


def tables_5_and_6(path: Json) -> str:
    """Returns the times of a frame: the paper's, which include rendering, and those of our methods alone."""
    rows = [
        [
            f"{label}, table {5 + number}",
            _together(published, 2),
            _together((measured[key] for key in ("minimum", "average", "maximum")), 2),
        ]
        for method, label in _METHODS.items()
        for number, (published, measured) in enumerate(
            zip(_TIMES[method], path["methods"][method]["times"], strict=True)
        )
    ]
    return table(["least/mean/most [ms]", "paper", "ours"], rows)


def sections(readings: dict[str, Json], ik: Json | None, held_out: Json | None, path: Json) -> dict[str, str | None]:
    """Returns the page's tables by their marks; None keeps a table of which a stage was not run."""
    page = readings.get("page")
    frames = f"{page['frames']:,} frames of {len(page['people'])} people" if page else ""
    return {
        "corpus": f"{frames}; {path['frames']:,} frames of {len(path['people'])} new people." if page else None,
        "table-1": table_1(page, held_out) if page and held_out else None,
        "tables-2-3": tables_2_and_3(page, ik, path) if page and ik else None,
        "table-4": table_4(readings) if readings.keys() == LABELS.keys() else None,
        "tables-5-6": tables_5_and_6(path),
    }


def main(config: PaperPageConfig) -> None:
    """Writes the page and its figures."""
    # Only drawing needs matplotlib; the tables and their tests do without.
    from . import accuracy_plots as plots

    found = {name: read_stage(config.stages / f"{name}.json", None) for name in (*LABELS, "ik", "held-out")}
    readings = {name: figures for name in LABELS if (figures := found[name]) is not None}
    path = json.loads(config.path.read_text())
    written = sections(readings, found["ik"], found["held-out"], path)
    config.page.write_text(renew(config.page.read_text(), written))
    config.images.mkdir(parents=True, exist_ok=True)
    with plots.plt.rc_context(plots.STYLE):
        if "page" in readings:
            plots.last_epoch(readings["page"]["lastEpoch"], config.images)
        if path["poses"]:
            plots.poses(path["poses"], config.images, plots.PAPER_COLOURS)


def _arguments() -> PaperPageConfig:
    parser = argparse.ArgumentParser(description="Tables and figures of docs/paper.md from what was measured.")
    parser.add_argument("--mocap", type=Path, required=True)
    parser.add_argument("--skeleton", type=Path)
    parser.add_argument("--path", type=Path, required=True)
    given = parser.parse_args()
    corpus = prepare.main(prepare.PrepareConfig(given.mocap, given.skeleton, cache=REPOSITORY / ".cache/mocap"))
    return PaperPageConfig(REPOSITORY / ".cache/paper" / corpus.corpus_hash[:16], given.path)


if __name__ == "__main__":
    try:
        main(_arguments())
    except MocapError as error:
        sys.exit(f"paper: {error}")
