"""Cross-validation: trains networks without the people of each fold, reports errors on these, and runs the paper's
protocol.
"""

import json
from contextlib import nullcontext
from typing import Any

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
    curve: train_paper.LearningCurve | None = None
    for fold in folds:
        trained, followed = _cross_validate(run, fold, is_shipped=fold == shipped)
        if fold == shipped:
            networks, curve = trained, followed
    if run.config.frame_random and "paper" in run.config.networks:
        run.report.found("paper, frame-random 80/20", fit_networks.paper_frame_random_errors_cm(run))
    if run.config.frame_random and "learned" in run.config.networks:
        run.report.found("learned, frame-random 80/20", fit_networks.learned_frame_random_errors_cm(run))
    for name, network in networks.items():
        errors = {row: values for row, values in run.report.rows.items() if row.startswith((name, "IK"))}
        errors |= _found_by_other_runs(run, name)
        training = training_people(shipped, tuple(run.corpus.people))
        provenance = fit_networks.provenance(run, name, training, errors, curve if name == "paper" else None)
        fit_networks.write(
            run, name, network, provenance, Destination(run.config.cross_validation, run.config.fp32_out)
        )


def _cross_validate(
    run: TrainingRun, fold: str, is_shipped: bool
) -> tuple[dict[str, torch.nn.Module], train_paper.LearningCurve | None]:
    """Trains one fold's networks; returns them and the learning curve of the paper's.

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
    curve: train_paper.LearningCurve | None = None
    # The shipped fold's networks add to the page's own IK.
    with nullcontext() if is_shipped else fitted_kinematics.used(fit_networks.kinematics(run, training, fold)):
        tests = {
            row: train_learned.held_out(corpus, people, config.learned.window_seconds) for row, people in rows.items()
        }
        for row, test in tests.items():
            found(f"IK, {row}", train_learned.ik_errors_cm(test))
        if "paper" in config.networks:
            frames = {row: train_paper.frames_of(corpus, people, config.seed) for row, people in rows.items()}
            trained["paper"], curve = fit_networks.followed_paper(run, training, next(iter(frames.values())), label)
            for row, test in frames.items():
                found(f"paper, {row}", train_paper.errors_cm(trained["paper"], test))
        if "learned" in config.networks:
            trained["learned"] = fit_networks.learned(run, training, label)
            for row, test in tests.items():
                found(f"learned, {row}", train_learned.errors_cm(trained["learned"], test))
    return trained, curve


def _found_by_other_runs(run: TrainingRun, name: str) -> dict[str, dict[str, float]]:
    """Errors in the paper's protocol that an earlier contract states, for a run without frame_random; else nothing."""
    contract = None if run.config.frame_random else _contract(run, name)
    if contract is None or contract["trainedOn"]["corpusHash"] != run.corpus.corpus_hash:
        return {}
    return {row: values for row, values in contract["errors"].items() if "frame-random" in row}


def _contract(run: TrainingRun, name: str) -> dict[str, Any] | None:
    """The contract of the first fold's network, as an earlier run wrote it; None: there is none."""
    file = run.config.cross_validation / f"{name}.json"
    return json.loads(file.read_text()) if file.exists() else None


def earlier_errors(run: TrainingRun, name: str) -> tuple[dict[str, dict[str, float]], dict[str, list[float]] | None]:
    """Errors [cm] and learning curve from the contract that cross-validation wrote; empty without one. One of another
    corpus raises MocapError.
    """
    file, contract = run.config.cross_validation / f"{name}.json", _contract(run, name)
    if contract is None:
        return {}, None
    if contract["trainedOn"]["corpusHash"] != run.corpus.corpus_hash:
        raise MocapError(f"{file} was made from other motion: run both stages, or give another --cross-validation")
    curve = contract.get("learningCurve")
    return contract["errors"], {key: value for key, value in curve.items() if key != "unit"} if curve else None
