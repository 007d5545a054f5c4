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
LABELS = {
    "hands-only": "hands only",
    "ccd": "CCD-IK (three.js)",
    "ik": "our IK",
    "paper": "`paper`",
    "learned": "`learned`",
    "transformer": "Transformer",
    "memory": "MLP with memory",
}


def stages(corpus: PreparedCorpus, config: BoardConfig) -> Json:
    """What is measured: the people held out and of another laboratory, and the folder with the files of networks."""
    return {
        "folder": str(train_board.folder_of(corpus, config)),
        "seed": str(config.seed),
        "files": ["paper.onnx", "learned.onnx", *(f"{name}-{config.seed}.onnx" for name in config.networks)],
        "heldOut": FOLDS["board"],
        "elsewhere": evaluation_only(tuple(corpus.people)),
    }


def corpus_in_words(errors: Json) -> str:
    """Returns what was measured: people, clips and frames."""
    groups = {"Held out": errors["heldOut"], "another laboratory": errors["elsewhere"]}
    words = (
        f"{label}: {', '.join(group['people'])}, {group['clips']} clips, {group['frames']:,} frames"
        for label, group in groups.items()
        if group
    )
    return f"{'; '.join(words)}."


def methods(errors: Json, sizes: Json, times: Json) -> str:
    """Returns the board."""

    def row(method: str) -> list[str]:
        own, elsewhere = (((errors[group] or {}).get("methods") or {}).get(method) for group in ("heldOut", "elsewhere"))
        size, time = sizes.get(method), times["times"][method]
        cost = [f"{size['parameters']:,}", f"{size['multiplyAdds'] / 1e6:.1f}"] if size else ["–", "–"]
        return [LABELS[method], *_figures(own), _cm(elsewhere), *cost, f"{time['p50Ms']:.2f}"]

    head = ["", "all joints [cm]", "network alone", "elbows", "jerk", "lost hand: all", "its elbow"]
    return table(
        [*head, "another laboratory", "parameters", "multiply-adds [M]", "ms a frame"],
        map(row, LABELS),
    )


def _cm(measured: Json | None) -> str:
    return f"{measured['mpjpeCm']['mean']:.2f}" if measured else "–"


def _figures(measured: Json | None) -> list[str]:
    if measured is None:
        return ["–"] * 6
    elbows = sum(measured["joints"][joint]["mean"] for joint in ("leftElbow", "rightElbow")) / 2
    lost = measured["loss"]["during"]
    raw = f"{measured['rawMpjpeCm']:.2f}" if "rawMpjpeCm" in measured else "–"
    figures = (f"{value:.2f}" for value in (elbows, measured["jerkRatio"], lost["allCm"], lost["elbowCm"]))
    return [_cm(measured), raw, *figures]


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


def main(folder: Path, config: BoardConfig, errors: Path, times: Path, page: Path = PAGE) -> None:
    """Writes the page's tables."""
    found = {}
    for name in config.networks:
        figures = read_stage(folder / f"{name}-{config.seed}.json", None)
        if figures is None:
            raise MocapError(f"{folder} has no finished training of {name} with the seed {config.seed}.")
        found[name] = figures
    measured, sizes = json.loads(errors.read_text()), train_board.sizes()
    sections = {
        "corpus": corpus_in_words(measured),
        "methods": methods(measured, sizes, json.loads(times.read_text())),
        "trainings": trainings(found),
    }
    page.write_text(renew(page.read_text(), sections))


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Tables of docs/board.md from what was measured.")
    parser.add_argument("--mocap", type=Path, required=True)
    parser.add_argument("--skeleton", type=Path)
    parser.add_argument("--seed", type=int, default=BoardConfig.seed)
    parser.add_argument("--stages", action="store_true", help="print as JSON what is measured")
    parser.add_argument("--errors", type=Path)
    parser.add_argument("--times", type=Path)
    return parser.parse_args()


if __name__ == "__main__":
    given = _arguments()
    config = replace(BoardConfig(), seed=given.seed)
    try:
        corpus = prepare.main(prepare.PrepareConfig(given.mocap, given.skeleton, cache=REPOSITORY / ".cache/mocap"))
        if given.stages:
            print(json.dumps(stages(corpus, config)))
        else:
            main(train_board.folder_of(corpus, config), config, given.errors, given.times)
    except MocapError as error:
        sys.exit(f"train: {error}")
