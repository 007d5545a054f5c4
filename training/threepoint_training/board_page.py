"""Renews the tables of docs/board.md between its marks from what was trained and measured. `npm run tool -- train
--board` calls this, first to ask who and what is measured.
"""

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from . import prepare, train_board
from .accuracy_tables import renew, table
from .motion_files import MocapError
from .prepared_corpus import PreparedCorpus
from .shared_constants import REPOSITORY
from .splits import FOLDS, evaluation_only
from .stage_files import read_stage
from .train_board import BoardConfig

Json = dict[str, Any]

PAGE = REPOSITORY / "docs/board.md"
# The method without a body, of which only the time is measured.
NO_BODY = "hands-only"
LABELS = {
    NO_BODY: "hands only",
    "ccd": "CCD-IK (three.js)",
    "ik": "our IK",
    "paper": "`paper`",
    "learned": "`learned`",
    "transformer": "Transformer",
    "memory": "MLP with memory",
}


def to_measure(corpus: PreparedCorpus, config: BoardConfig) -> Json:
    """The people and methods that are measured, and the networks with their folder."""
    return {
        "folder": str(train_board.folder_of(corpus, config)),
        "networks": ["paper", "learned", *config.networks],
        "methods": [method for method in LABELS if method != NO_BODY],
        "heldOut": FOLDS["board"],
        "elsewhere": evaluation_only(tuple(corpus.people)),
    }


def corpus_in_words(errors: dict[str, Json]) -> str:
    """Returns what was measured: people, clips and frames."""
    anyone = next(iter(errors.values()))
    words = (
        f"{label}: {', '.join(group['people'])}, {group['clips']} clips, {group['frames']:,} frames"
        for label, group in (("Held out", anyone["heldOut"]), ("another laboratory", anyone["elsewhere"]))
        if group
    )
    return f"{'; '.join(words)}."


def methods(errors: dict[str, Json], sizes: dict[str, Json], times: dict[str, Json]) -> str:
    """Returns the board, from errors, sizes and times by method."""

    def row(method: str) -> list[str]:
        measured, size = errors.get(method, {"heldOut": None, "elsewhere": None}), sizes.get(method)
        cost = [f"{size['parameters']:,}", f"{size['multiplyAdds'] / 1e6:.1f}"] if size else ["–", "–"]
        figures = [*_figures(measured["heldOut"]), _cm(measured["elsewhere"])]
        return [LABELS[method], *figures, *cost, _milliseconds(times[method])]

    head = ["", "all joints [cm]", "network alone", "elbows", "jerk", "lost hand: all", "its elbow"]
    costs = ["parameters", "multiply-adds [M]", "ms a frame: p10 / p50"]
    return table([*head, "another laboratory", *costs], map(row, LABELS))


def _milliseconds(time: Json) -> str:
    return " / ".join(f"{time[key]:.2f}" for key in ("p10Ms", "p50Ms"))


def _cm(measured: Json | None) -> str:
    return f"{measured['mpjpeCm']['mean']:.2f}" if measured else "–"


def _figures(measured: Json | None) -> list[str]:
    if measured is None:
        return ["–"] * 6
    elbows = sum(measured["joints"][joint]["mean"] for joint in ("leftElbow", "rightElbow")) / 2
    lost = (measured["loss"] or {}).get("during")
    raw = f"{measured['rawMpjpeCm']:.2f}" if "rawMpjpeCm" in measured else "–"
    in_loss = [f"{lost[key]:.2f}" for key in ("allCm", "elbowCm")] if lost else ["–", "–"]
    return [_cm(measured), raw, f"{elbows:.2f}", f"{measured['jerkRatio']:.2f}", *in_loss]


def trainings(found: dict[str, Json]) -> str:
    """Returns how each network of the field was trained."""
    rows = (
        [
            LABELS[name],
            f"{figures['steps']:,}",
            f"{figures['windows']:,}",
            f"{figures['seconds'] / 60:.0f}",
            f"{figures['validationCm']:.2f} at {figures['bestStep']:,}",
            "no" if figures["stoppedFalling"] else "yes",
        ]
        for name, figures in found.items()
    )
    head = ["", "steps", "windows", "minutes of one core", "validation people [cm], least at step"]
    return table([*head, "ended while it fell"], rows)


def main(folder: Path, config: BoardConfig, name: str, page: Path = PAGE) -> None:
    """Writes the page's tables from the measurements of this name; one that is missing raises MocapError."""

    def measured(part: str) -> Json:
        try:
            return json.loads((folder / f"{part}-{name}.json").read_text())
        except (OSError, ValueError) as error:
            raise MocapError(f"{folder} has no finished measurement of {part}: {error}") from error

    found = {}
    for network in config.networks:
        figures = read_stage(folder / f"{network}.json", None)
        if figures is None:
            raise MocapError(f"{folder} has no finished training of {network}")
        found[network] = figures
    errors = {method: measured(method) for method in LABELS if method != NO_BODY}
    sections = {
        "corpus": corpus_in_words(errors),
        "methods": methods(errors, train_board.sizes(), measured("times")),
        "trainings": trainings(found),
    }
    page.write_text(renew(page.read_text(), sections))


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="What docs/board.md needs measured, or its tables from that.")
    parser.add_argument("--mocap", type=Path, required=True)
    parser.add_argument("--skeleton", type=Path)
    parser.add_argument("--seed", type=int, default=BoardConfig.seed)
    parser.add_argument("--measured", help="the name of the measurements; without it, prints what to measure")
    return parser.parse_args()


if __name__ == "__main__":
    given = _arguments()
    config = replace(BoardConfig(), seed=given.seed)
    try:
        corpus = prepare.main(prepare.PrepareConfig(given.mocap, given.skeleton, cache=REPOSITORY / ".cache/mocap"))
        if given.measured:
            main(train_board.folder_of(corpus, config), config, given.measured)
        else:
            print(json.dumps(to_measure(corpus, config)))
    except MocapError as error:
        sys.exit(f"train: {error}")
