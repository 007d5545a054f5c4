"""Golden vectors as they are committed, held against those that the code makes now."""

import json

import numpy as np
from threepoint_training import golden


def committed(name):
    return json.loads((golden.GOLDEN / name).read_text())


def flat(value):
    """All numbers of nested lists and dicts, in order; words are left out."""
    if isinstance(value, dict):
        return [number for key in sorted(value) for number in flat(value[key])]
    if isinstance(value, list):
        return [number for part in value for number in flat(part)]
    return [] if isinstance(value, str) else [float(value)]


def assert_as_committed(name, vectors, atol):
    now, before = json.loads(json.dumps(golden.plain(vectors))), committed(name)
    assert [sorted(case) for case in before] == [sorted(case) for case in now]
    np.testing.assert_allclose(flat(now), flat(before), atol=atol)
