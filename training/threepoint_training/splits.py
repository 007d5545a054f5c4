"""Who trains, who is held out, who only measures: the splits that reported figures name."""

# Another laboratory's people (HDM05, Universität Bonn), by the names of that database or as the numbers a CMU-like copy gives three of them. Its
# licence, CC BY-SA 3.0, asks more than the page's weights can give: they are measured with, and in no weight.
MEASURED_ONLY = ("901", "902", "903", "bd", "bk", "dg", "mm", "tr")

# Fold A is the shipped models' own hold-out; fold B exists because one fold is noisy.
FOLDS: dict[str, tuple[str, ...]] = {"A": ("005", "135"), "B": ("014", "127", "002")}

# The first eleven: people who were asked for many things; the others mostly walk and run.
VARIED = ("001", "002", "003", "005", "009", "014", "016", "017", "049", "127", "135")


def trainable(subjects: tuple[str, ...] | list[str]) -> tuple[str, ...]:
    """The subjects of the corpus that may be trained on."""
    return tuple(sorted(set(subjects) - set(MEASURED_ONLY)))


def measured_only(subjects: tuple[str, ...] | list[str]) -> tuple[str, ...]:
    """The subjects of the corpus that are in no weight."""
    return tuple(sorted(set(subjects) & set(MEASURED_ONLY)))


def training_people(fold: str, subjects: tuple[str, ...] | list[str]) -> tuple[str, ...]:
    """The subjects of the corpus but the fold's held-out people and those that only measure. A corpus without them trains on all it has."""
    return tuple(sorted(set(trainable(subjects)) - set(FOLDS[fold])))


def trained_on(network: str, people: tuple[str, ...]) -> tuple[str, ...]:
    """Whom a network is made of where these people are at hand: ours of all, the paper's of the varied ones alone, of whom it is better.

    Where none of them is at hand, as in other people's corpora, the paper's is made of all too.
    """
    varied = tuple(person for person in people if person in VARIED)
    return varied if network == "paper" and varied else people


def counted(people: tuple[str, ...], subjects: tuple[str, ...]) -> str:
    """How many these are of the subjects that may be trained on; who they are, where not all."""
    everyone = trainable(subjects)
    if set(people) == set(everyone):
        return f"all {len(everyone)} people"
    return f"{len(people)} of {len(everyone)} people: {', '.join(people)}"
