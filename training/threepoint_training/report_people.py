"""Which people of a folder `npm run tool -- report` and `npm run tool -- paper` evaluate; they run this and pass the
names on.
"""

import argparse
import json
import sys
from pathlib import Path

from .motion_files import MocapError, motion_files
from .splits import LOCKBOX, VARIED, evaluation_only, trainable


def main(mocap: Path) -> dict[str, list[str]]:
    """tables: the people of the tables of docs/accuracy.md: the VARIED subjects outside the lockbox; all people outside
    the lockbox where one of those is missing.

    elsewhere: the evaluation-only subjects (never trained on) in the folder. paper: people outside the
    lockbox that the page's paper network was not trained on; all people outside the lockbox where there are none.
    """
    people = {source.person for source in motion_files(mocap, None)}
    varied = trainable(VARIED)
    others = trainable(sorted(people - set(VARIED)))
    return {
        "tables": sorted(varied if people >= set(varied) else people - set(LOCKBOX)),
        "elsewhere": list(evaluation_only(list(people))),
        "paper": list(others or trainable(sorted(people))),
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Which people the tools report and paper evaluate, as JSON.")
    parser.add_argument("--mocap", type=Path, required=True)
    try:
        print(json.dumps(main(parser.parse_args().mocap)))
    except MocapError as error:
        sys.exit(str(error))
