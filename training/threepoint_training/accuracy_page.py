"""Renews the tables of docs/accuracy.md between its marks, and its figures. `npm run tool -- report` calls this."""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import accuracy_tables as tables
from .shared_constants import REPOSITORY


@dataclass(frozen=True)
class AccuracyPageConfig:
    """Files of the evaluation, of its figures, of the models evaluated and of the page.

    home, elsewhere: evaluations of the held-out people and of evaluation-only subjects, each without hand tilts and
    with measured ones.
    """

    evaluation: Path
    figures: Path
    models: Path
    home: tuple[Path, Path]
    elsewhere: tuple[Path, Path]
    page: Path = REPOSITORY / "docs/accuracy.md"
    images: Path = REPOSITORY / "docs/images/accuracy"


def sections(
    evaluation: dict[str, Any], contract: dict[str, Any], measured: tuple[tables.ByHands, tables.ByHands] | None
) -> dict[str, str | None]:
    """Returns the page's tables by their marks; measured: the result of `laboratories`, None keeps that table."""
    corpus, robustness = evaluation["corpus"], evaluation["robustness"]
    motions = f"{corpus['clips']} clips of {corpus['people']} people, {corpus['seconds'] / 60:.0f} minutes"
    disturbed = (
        f"{', '.join(robustness['people'])}: {robustness['clips']} clips, {robustness['frames'] / 3600:.1f} minutes."
    )
    return {
        "corpus": f"Evaluated: {motions}; held out: {', '.join(tables.people_held_out(evaluation))}.",
        "aims": tables.aims(evaluation, contract),
        "summary": tables.summary(evaluation),
        "people": tables.people(evaluation),
        "disturbed": f"Clips, a seeded choice of the people held out, {disturbed}",
        "loss": tables.loss(evaluation),
        "faults": tables.faults(evaluation),
        "laboratories": tables.laboratories(*measured) if measured else None,
    }


def laboratories(config: AccuracyPageConfig) -> tuple[tables.ByHands, tables.ByHands] | None:
    """Returns the evaluations for the table of both laboratories, or prints a message and returns None if one is
    missing.
    """
    missing = [path for path in (*config.home, *config.elsewhere) if not path.exists()]
    if missing:
        print(f"{', '.join(map(str, missing))}: not measured, so the table of both laboratories stays as it is")
        return None

    def read(files: tuple[Path, Path]) -> tables.ByHands:
        return json.loads(files[0].read_text()), json.loads(files[1].read_text())

    return read(config.home), read(config.elsewhere)


def main(config: AccuracyPageConfig) -> None:
    """Writes the page and its figures."""
    # Only drawing needs matplotlib; the tables and their tests do without.
    from . import accuracy_plots as plots

    evaluation, figures = json.loads(config.evaluation.read_text()), json.loads(config.figures.read_text())
    contract = json.loads((config.models / "learned.json").read_text())
    config.page.write_text(tables.renew(config.page.read_text(), sections(evaluation, contract, laboratories(config))))
    config.images.mkdir(parents=True, exist_ok=True)
    with plots.plt.rc_context(plots.STYLE):
        plots.by_joint(evaluation, config.images)
        plots.losses(evaluation, config.images)
        plots.offsets(evaluation, config.images)
        plots.wrong_measures(evaluation, config.images)
        if figures["poses"]:
            plots.poses(figures["poses"], config.images)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Tables and figures of docs/accuracy.md from an evaluation.")
    parser.add_argument("--evaluation", type=Path, required=True)
    parser.add_argument("--figures", type=Path, required=True)
    parser.add_argument("--models", type=Path, required=True)
    for people in ("--home", "--elsewhere"):
        parser.add_argument(people, type=Path, nargs=2, metavar=("RECORDED", "MEASURED"), required=True)
    given = parser.parse_args()
    main(AccuracyPageConfig(given.evaluation, given.figures, given.models, tuple(given.home), tuple(given.elsewhere)))
