"""Renews the tables of docs/paper.md between its marks, and its figures, from what was measured. `npm run tool --
paper` calls this.
"""

import argparse
import json
import sys
from dataclasses import dataclass
from math import log
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
    "page": "the page's",
    "iterations": "150 batches an epoch",
    "joints": "recorded joints as inputs",
    "heading": "axes that turn with the head",
    "parent": "hands' angles from the true forearm",
    "filtered": "similar poses left out",
    "wide": "width 2304",
    "literal": "150 batches, width 2304, recorded joints, similar poses left out",
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
_TIMES = {"ik": ((3.81, 19.65, 10.23), (4.28, 22.41, 16.78)), "paper": ((3.19, 14.75, 6.73), (3.36, 17.01, 9.21))}
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


def table_1(page: Json, held_out: Json | None) -> str:
    """Returns MSE by joint: the paper's, ours of standardised coordinates and in cm², and of people held out."""
    sides = ("train", "test")

    def row(label: str, published: tuple[float, float], joint: str | None) -> list[str]:
        def figure(side: Json, unit: str) -> float:
            return _mean(side[unit]) if joint is None else side[unit][joint]

        ours = [f"{figure(page[side], 'mseStandardised'):.4f}" for side in sides]
        ours += [f"{figure(page[side], 'mseCm2'):.2f}" for side in sides]
        new = [f"{figure(held_out['test'], 'mseCm2'):.1f}"] if held_out else []
        return [label, *(f"{value:.4f}" for value in published), *ours, *new]

    head = ["MSE", "paper: train", "test", "ours, standardised: train", "test", "ours [cm²]: train", "test"]
    rows = [row(label, _MSE[joint], joint) for joint, label in _JOINTS.items()]
    rows.append(row("mean", (0.0277, 0.0448), None))
    return table([*head, *(["people held out [cm²]"] if held_out else [])], rows)


def tables_2_and_3(page: Json, ik: Json, path: Json) -> str:
    """Returns MSE and the right shoulder's MAE of both methods on test frames, and the MSE on the page's code path."""
    rows = []
    for method, figures in (("ik", ik), ("paper", page)):
        rows.append(
            [
                "Final IK; ours: our own IK" if method == "ik" else "the network",
                f"{_MSE_OF_METHODS[method]:.4f}",
                f"{_mean(figures['test']['mseCm2']):.2f}",
                f"{_RIGHT_SHOULDER_MAE[method]:.4f}",
                f"{figures['test']['rightShoulderMaeCm']:.2f}",
                f"{path['methods'][method]['mseCm2']:.1f}",
                f"{path['methods'][method]['mpjpeCm']['mean']:.2f}",
            ]
        )
    published = path["methods"]["paper-published"]
    rows.append(
        ["with section 3.5", *[""] * 4, f"{published['mseCm2']:.1f}", f"{published['mpjpeCm']['mean']:.2f}"]
    )
    head = ["test frames", "MSE: paper", "ours [cm²]", "MAE of j7: paper", "ours [cm]"]
    return table([*head, "new people: MSE [cm²]", "MPJPE [cm]"], rows)


def table_4(readings: dict[str, Json]) -> str:
    """Returns the MPJPE of every reading that was trained, nearest to the paper's first."""
    rows = [["**the paper**", "22", "150", *(f"**{value:.2f}**" for value in _MPJPE_CM.values()), "0.0277", "0.0448"]]
    for name in sorted(readings, key=lambda name: _distance_from_the_paper(readings[name])):
        reading = readings[name]
        cells = [f"{reading['megabytes']:.0f}", f"{reading['iterations']}"]
        cells += [f"{reading[side]['mpjpeCm']:.2f}" for side in _MPJPE_CM]
        cells += [f"{_mean(reading[side]['mseStandardised']):.4f}" for side in _MPJPE_CM]
        rows.append([LABELS[name], *cells])
    head = ["reading", "MB", "batches an epoch", "MPJPE [cm]: train", "test", "MSE: train", "test"]
    return table(head, rows)


def tables_5_and_6(path: Json) -> str:
    """Returns the times of a frame: the paper's, which include rendering, and those of our methods alone."""
    rows = []
    for method, label in _METHODS.items():
        measured = path["methods"][method]["times"]
        for number, times in enumerate(measured):
            ours = (times[key] for key in ("minimum", "maximum", "average"))
            cells = [f"{value:.2f}" for value in (*_TIMES[method][number], *ours)]
            rows.append([f"{label}, table {5 + number}", *cells])
    return table(["[ms]", "paper: least", "most", "mean", "ours: least", "most", "mean"], rows)


def sections(readings: dict[str, Json], ik: Json | None, held_out: Json | None, path: Json) -> dict[str, str | None]:
    """Returns the page's tables by their marks; None keeps a table whose stage was not run."""
    page = readings.get("page")
    frames = f"{page['frames']:,} frames of {len(page['people'])} people" if page else ""
    return {
        "corpus": f"{frames}; {path['frames']:,} frames of {len(path['people'])} new people." if page else None,
        "table-1": table_1(page, held_out) if page else None,
        "tables-2-3": tables_2_and_3(page, ik, path) if page and ik else None,
        "table-4": table_4(readings) if readings else None,
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
