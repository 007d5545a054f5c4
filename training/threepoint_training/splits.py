"""Who trains, who is held out: the splits that reported figures name."""

TRAINING = ("001", "002", "003", "009", "014", "016", "017", "049", "127")

# Fold A is the shipped models' own hold-out; fold B exists because one fold is noisy.
FOLDS: dict[str, tuple[str, ...]] = {"A": ("005", "135"), "B": ("014", "127", "002")}


def training_people(fold: str, subjects: tuple[str, ...] | list[str]) -> tuple[str, ...]:
    """The subjects of the corpus but the fold's held-out people. A corpus without them trains on all it has."""
    return tuple(sorted(set(subjects) - set(FOLDS[fold])))
