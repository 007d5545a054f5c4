"""Cross-validation: trains networks without the people of each fold, and reports errors on these."""

import json
from contextlib import nullcontext

import torch

from . import fit_networks, fitted_kinematics, train_learned, train_paper
from .fit_networks import Destination, TrainingRun
from .motion_files import MocapError
from .splits import FOLDS, evaluation_only, training_people


def usable_folds(run: TrainingRun) -> list[str]:
    """The folds for which the corpus has both held-out and training people; prints which are left out."""
    subjects = tuple(run.corpus.people)
    usable = []
    for fold in run.config.folds:
        if set(FOLDS[fold]) & set(subjects) and training_people(fold, subjects):
            usable.append(fold)
        else:
            run.report.console.print(f"Fold {fold} left out: it needs {', '.join(FOLDS[fold])} and others besides them")
    return usable


def main(run: TrainingRun, folds: list[str]) -> None:
    """Trains and evaluates the networks of these folds; writes the first fold's."""
    shipped = folds[0]
    networks: dict[str, torch.nn.Module] = {}
    for fold in folds:
        trained = _cross_validate(run, fold, is_shipped=fold == shipped)
        if fold == shipped:
            networks = trained
    for name, network in networks.items():
        errors = {row: values for row, values in run.report.rows.items() if row.startswith((name, "IK"))}
        training = training_people(shipped, tuple(run.corpus.people))
        provenance = fit_networks.provenance(run, name, training, errors)
        fit_networks.write(
            run, name, network, provenance, Destination(run.config.cross_validation, run.config.fp32_out)
        )


def _cross_validate(run: TrainingRun, fold: str, is_shipped: bool) -> dict[str, torch.nn.Module]:
    """Trains one fold's networks and returns them.

    They are evaluated on the fold's held-out people and, in rows of their own, on evaluation-only subjects (never
    trained on).
    """
    config, corpus, found = run.config, run.corpus, run.report.found
    subjects = tuple(corpus.people)
    training = training_people(fold, subjects)
    label = f"fold {fold}"
    judged = {label: tuple(person for person in FOLDS[fold] if person in subjects)}
    if measured := evaluation_only(subjects):
        judged[f"another laboratory, {label}'s network"] = measured
    rows = {f"{given} ({', '.join(people)})": people for given, people in judged.items()}
    trained: dict[str, torch.nn.Module] = {}
    # The shipped fold's networks add to the page's own IK.
    with nullcontext() if is_shipped else fitted_kinematics.used(fit_networks.kinematics(run, training, fold)):
        tests = {
            row: train_learned.held_out(corpus, people, config.learned.window_seconds) for row, people in rows.items()
        }
        for row, test in tests.items():
            found(f"IK, {row}", train_learned.ik_errors_cm(test))
        if "paper" in config.networks:
            trained["paper"] = fit_networks.paper(run, fit_networks.paper_frames(run, training, label), label)
            for row, people in rows.items():
                frames = train_paper.frames_of(corpus, people, config.seed)
                found(f"paper, {row}", train_paper.errors_cm(trained["paper"], frames))
        if "learned" in config.networks:
            trained["learned"] = fit_networks.learned(run, training, label)
            for row, test in tests.items():
                found(f"learned, {row}", train_learned.errors_cm(trained["learned"], test))
    return trained


def earlier_errors(run: TrainingRun, name: str) -> dict[str, dict[str, float]]:
    """Errors [cm] from the contract that cross-validation wrote; empty without one. One of another corpus raises
    MocapError.
    """
    file = run.config.cross_validation / f"{name}.json"
    if not file.exists():
        return {}
    contract = json.loads(file.read_text())
    if contract["trainedOn"]["corpusHash"] != run.corpus.corpus_hash:
        raise MocapError(f"{file} was made from other motion: run both stages, or give another --cross-validation")
    return contract["errors"]
