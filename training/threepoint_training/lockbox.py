"""Evaluates the page's learned network for a release, on the lockbox people, who were not used in any choice.

`npm run tool -- train --mocap DIR --lockbox` calls this. Each evaluation is logged, so that nobody can choose by repeating
it.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import onnx

from . import selection, splits, train_learned
from .lockbox_log import append, stamp
from .motion_files import MocapError
from .prepared_corpus import PreparedCorpus
from .quantise import run


@dataclass(frozen=True)
class LockboxConfig:
    """models: the folder of the learned network; log: the JSON file to which the evaluation is appended."""

    models: Path
    log: Path


def main(corpus: PreparedCorpus, config: LockboxConfig) -> dict[str, Any]:
    """Evaluates the network frame by frame, hands not measured, on the lockbox people of the corpus; appends a row to
    the log and returns it.
    """
    contract = json.loads((config.models / "learned.json").read_text())
    people = splits.in_lockbox(tuple(corpus.people))
    if not people:
        raise MocapError(
            f"No person of the lockbox ({', '.join(splits.LOCKBOX)}) is in this motion: give a folder with their recordings"
        )
    if known := splits.in_lockbox(contract["trainedOn"]["people"]):
        raise MocapError(
            f"{config.models / 'learned.json'} was trained on {', '.join(known)}, who are in the lockbox: train it without them first"
        )
    held_out = train_learned.held_out(corpus, people, tuple(contract["windowSeconds"]), hands_measured=False)
    errors = selection.errors_by_person(run(onnx.load(config.models / contract["file"]), held_out.inputs), held_out)
    row = {
        **stamp(),
        "weightsSha256": contract["sha256"],
        "corpusHash": corpus.corpus_hash,
        "cm": {name: _of_person(person) for name, person in errors["all"].items()},
        "ratios": {
            frames: {name: round(value, 3) for name, value in selection.figures(errors[frames]).items()}
            for frames in errors
            if errors[frames]
        },
    }
    append(config.log, row)
    return row


def _of_person(person: selection.PersonErrors) -> dict[str, dict[str, float]]:
    """Mean errors in cm of IK and of the learned network, by the names of selection.JOINTS."""
    return {
        method: {joints: round(float(values[columns].mean()), 2) for joints, columns in selection.JOINTS.items()}
        for method, values in (("IK", person.of_ik), ("learned", person.ours))
    }
