"""The motion files of a folder: which person each is of, and the frame rates that a table beside them states."""

import csv
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_SUFFIXES = (".amc", ".bvh", ".vrma")


class MocapError(ValueError):
    """A sentence that says what is wrong and in which file and line."""


@dataclass(frozen=True)
class Source:
    """A motion file, its person, and the .asf skeleton of an .amc."""

    person: str
    path: Path
    asf: Path | None


def _folders(top: Path) -> Iterator[tuple[Path, list[str]]]:
    """
    Folders with the names of their files, links to folders followed; a folder that two ways lead to is read once, so
    that no one is two people and no circle is endless. What is no link comes first: a person is named by the folder
    itself where it lies in here.
    """
    seen: set[Path] = set()
    links: list[Path] = []
    pending = [top]
    while pending or links:
        if not pending:
            pending.append(links.pop(0))
        for folder, below, files in os.walk(pending.pop(0)):
            path = Path(folder)
            if path.resolve() in seen:
                below.clear()
                continue
            seen.add(path.resolve())
            links += sorted(path / name for name in below if (path / name).is_symlink())
            yield path, files


def motion_files(mocap: Path, people: tuple[str, ...] | None) -> list[Source]:
    """Every motion file with its person: the folder it lies in, or the start of its name when all lie in one folder."""
    if not mocap.is_dir():
        raise MocapError(f"{mocap}: no such folder")
    files = sorted(
        folder / name for folder, names in _folders(mocap) for name in names if Path(name).suffix.lower() in _SUFFIXES
    )
    if not files:
        raise MocapError(f"{mocap}: no .amc, .bvh or .vrma files in this folder or below it")
    sources = []
    for path in files:
        person = path.parent.name if path.parent != mocap else path.stem.split("_")[0]
        number = re.fullmatch(r"0*(\d+)", person)
        if number:
            person = f"{int(number[1]):03d}"
        asf = None
        if path.suffix.lower() == ".amc":
            skeletons = sorted(path.parent.glob("*.asf"))
            own = [skeleton for skeleton in skeletons if path.stem.startswith(skeleton.stem)]
            asf = (
                max(own, key=lambda skeleton: len(skeleton.stem))
                if own
                else (skeletons[0] if len(skeletons) == 1 else None)
            )
        if people is None or person in people:
            sources.append(Source(person, path, asf))
    if not sources:
        raise MocapError(f"{mocap}: nothing of {', '.join(people or ())} here")
    return sources


def index_rates(folder: Path) -> dict[str, float]:
    """Frame rates from an index.csv (columns Subject, Trial #, framerate) in the folder, above or below it."""
    rates: dict[str, float] = {}
    candidates = [folder / "index.csv", folder.parent / "index.csv", *sorted(folder.glob("*/index.csv"))]
    for path in candidates:
        if path.is_file():
            with path.open(newline="", errors="replace") as lines:
                for row in csv.DictReader(lines):
                    try:
                        rates[f"{int(row['Subject'])}_{int(row['Trial #'])}"] = float(row["framerate"])
                    except (KeyError, TypeError, ValueError):
                        continue  # A row of another table or an empty line: the clip is then looked up elsewhere.
    return rates
