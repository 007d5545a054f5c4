"""Which subjects train, which are held out and which are evaluation-only (never trained on): the splits that reported
figures name.
"""

import numpy as np

# Evaluation-only subjects (never trained on): another laboratory's people (HDM05, Universität Bonn), by the names of
# that database or as the numbers that a CMU-like copy gives three of them. Its licence, CC BY-SA 3.0, asks more than
# the page's weights can give.
EVALUATION_ONLY = ("901", "902", "903", "bd", "bk", "dg", "mm", "tr")

# Fold A is the shipped models' own hold-out; fold B exists because one fold is noisy. The board's fold holds out
# people of many kinds of motion who are a small part of the corpus.
FOLDS: dict[str, tuple[str, ...]] = {
    "A": ("005",),
    "B": ("014", "127", "002"),
    "board": ("002", "005", "069", "115", "118", "127"),
}

# The first eleven: people who were asked for many things; the others mostly walk and run.
VARIED = ("001", "002", "003", "005", "009", "014", "016", "017", "049", "127", "135")

# The lockbox: four of VARIED, drawn once by `draw_lockbox`. They are never trained on, and no recipe, constant or
# filter is chosen by them; a release is evaluated on them, and each evaluation is recorded in lockbox-log.json.
LOCKBOX = ("001", "009", "049", "135")
_LOCKBOX_SEED = 2460

# People who were recorded together; they are held out together.
_PARTNERS = {"019": "018", "061": "060"}


def draw_lockbox() -> tuple[str, ...]:
    """Draws LOCKBOX again."""
    return tuple(
        sorted(str(person) for person in np.random.default_rng(_LOCKBOX_SEED).choice(sorted(VARIED), 4, replace=False))
    )


def groups_in_turn(people: tuple[str, ...], count: int | None = None) -> list[tuple[str, ...]]:
    """`count` groups of nearly equal size that are held out in turn; neighbours in the list are in different ones,
    partners in the same.

    None, or more than there are people: each person alone, but for partners.
    """
    alone = [person for person in people if _PARTNERS.get(person) not in people]
    count = len(alone) if count is None else min(count, len(alone))
    first = [set(alone[number::count]) for number in range(count)]
    return [tuple(person for person in people if person in group or _PARTNERS.get(person) in group) for group in first]


def trainable(subjects: tuple[str, ...] | list[str]) -> tuple[str, ...]:
    """The subjects of the corpus that may be trained on: neither evaluation-only nor in the lockbox."""
    return tuple(sorted(set(subjects) - set(EVALUATION_ONLY) - set(LOCKBOX)))


def evaluation_only(subjects: tuple[str, ...] | list[str]) -> tuple[str, ...]:
    """The evaluation-only subjects (never trained on) of the corpus."""
    return tuple(sorted(set(subjects) & set(EVALUATION_ONLY)))


def in_lockbox(subjects: tuple[str, ...] | list[str]) -> tuple[str, ...]:
    """The subjects of the corpus that are in the lockbox."""
    return tuple(sorted(set(subjects) & set(LOCKBOX)))


def training_people(fold: str, subjects: tuple[str, ...] | list[str]) -> tuple[str, ...]:
    """The trainable subjects of the corpus without the fold's held-out people."""
    return tuple(sorted(set(trainable(subjects)) - set(FOLDS[fold])))


def trained_on(network: str, people: tuple[str, ...]) -> tuple[str, ...]:
    """Which of `people` a network trains on: `learned` on all; `paper` on the VARIED subjects only, which lowers its
    error with axes of the room.

    Without any VARIED subject among them, as in other corpora, `paper` trains on all too.
    """
    varied = tuple(person for person in people if person in VARIED)
    return varied if network == "paper" and varied else people


def counted(people: tuple[str, ...], subjects: tuple[str, ...]) -> str:
    """How many of the trainable `subjects` these people are, in words; with their names where they are not all."""
    everyone = trainable(subjects)
    if set(people) == set(everyone):
        return f"all {len(everyone)} people"
    return f"{len(people)} of {len(everyone)} people: {', '.join(people)}"
