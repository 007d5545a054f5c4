"""Whom `npm run report` measures, of the people in a folder: it asks this and gives the names to the evaluation."""

import argparse
import json
import sys
from pathlib import Path

from .motion import MocapError
from .motion_files import motion_files
from .splits import FOLDS, VARIED, evaluation_only


def main(mocap: Path) -> dict[str, list[str] | None]:
    """tables: the first eleven, of whom the tables of docs/accuracy.md are, or None (everyone) where one of them is missing.

    home: the first fold's held-out people, elsewhere: evaluation-only subjects (never trained on); of both, those who are in the folder.
    """
    people = {source.person for source in motion_files(mocap, None)}
    return {
        "tables": list(VARIED) if people >= set(VARIED) else None,
        "home": sorted(people & set(FOLDS["A"])),
        "elsewhere": list(evaluation_only(list(people))),
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Whom npm run report measures, as JSON.")
    parser.add_argument("--mocap", type=Path, required=True)
    try:
        print(json.dumps(main(parser.parse_args().mocap)))
    except MocapError as error:
        sys.exit(str(error))
