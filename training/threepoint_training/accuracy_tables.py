"""Formats the results of `npm run tool -- evaluate` as the Markdown tables of docs/accuracy.md, each between two marks."""

import re
from collections.abc import Callable, Iterable
from typing import Any

METHODS = {"ik": "IK", "learned": "learned"}
JOINTS = {
    "leftElbow": "left elbow",
    "rightElbow": "right elbow",
    "leftShoulder": "left shoulder",
    "rightShoulder": "right shoulder",
    "spine": "spine",
    "pelvis": "pelvis",
}
Json = dict[str, Any]
# Evaluations of the same people without calibrated hands, and with hands as the guided calibration measures them.
ByHands = tuple[Json, Json]


def held_out(evaluation: Json) -> Json:
    """Returns the figures of unseen people, or those of all people if every person was trained on."""
    return evaluation.get("unseen", evaluation["estimators"])


def people_held_out(evaluation: Json) -> list[str]:
    """Returns the names of unseen people, or all names if every person was trained on."""
    names = [name for name, person in evaluation["people"].items() if not person["seen"]]
    return sorted(names or evaluation["people"])


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Returns a Markdown table with its first column aligned left and the others aligned right."""
    head = list(head)
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *(list(row) for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def signed(value: float, digits: int = 2) -> str:
    """Formats a number with its sign: +0.12, −0.05."""
    return f"{'−' if round(value, digits) < 0 else '+'}{abs(value):.{digits}f}"


def summary(evaluation: Json) -> str:
    figures = held_out(evaluation)

    def row(label: str, cell: Callable[[Json], str]) -> list[str]:
        return [label, *(cell(figures[method]) for method in METHODS)]

    return table(
        [", ".join(people_held_out(evaluation)), *METHODS.values()],
        [
            row("MPJPE, six joints: mean [cm]", lambda f: f"{f['mpjpeCm']['mean']:.2f}"),
            row("median / p95 [cm]", lambda f: f"{f['mpjpeCm']['median']:.2f} / {f['mpjpeCm']['p95']:.2f}"),
            row(
                "network alone, before kinematics [cm]",
                lambda f: f"{f['rawMpjpeCm']:.2f}" if "rawMpjpeCm" in f else "–",
            ),
            row("elbow swivel error", lambda f: f"{f['swivelDeg']:.1f}°"),
            row("jerk relative to the true motion", lambda f: f"{f['jerkRatio']:.2f}"),
        ],
    )


def people(evaluation: Json) -> str:
    """Returns the table of errors by person held out."""

    def row(name: str) -> list[str]:
        errors = {method: _mpjpe_cm(evaluation["people"][name][method]) for method in METHODS}
        return [name, *(f"{error:.2f}" for error in errors.values()), f"{errors['learned'] / errors['ik']:.2f}"]

    return table(["MPJPE [cm]", *METHODS.values(), "learned / IK"], map(row, people_held_out(evaluation)))


def _losses(evaluation: Json) -> list[tuple[str, dict[str, Json]]]:
    """Returns a label and each method's figures for every length of loss; hand tracking's lengths come last."""
    estimators = evaluation["robustness"]["estimators"]
    fixed = [
        (f"{loss['milliseconds']} ms", {method: estimators[method]["losses"][i] for method in METHODS})
        for i, loss in enumerate(estimators["ik"]["losses"])
    ]
    tracked = {method: estimators[method]["handTracking"] for method in METHODS}
    return [*fixed, (f"as in hand tracking, {tracked['ik']['milliseconds']} ms on average", tracked)]


def loss(evaluation: Json) -> str:
    """Returns the table of errors while a hand is lost, with the ratios to the same frames with the hand seen."""

    def ratio(figures: Json, joints: str) -> str:
        cm = figures["during"][f"{joints}Cm"]
        return f"{cm:.2f} ({cm / figures['during'][f'{joints}SeenCm']:.2f} ×)"

    def step(figures: Json) -> str:
        return f"{max(figures['atLoss']['excessCm'], figures['atReturn']['excessCm']):.1f}"

    cells = (lambda f: ratio(f, "all"), lambda f: ratio(f, "elbow"), step)
    rows = [
        [f"{length}, {by_method['ik']['losses']} losses", *(cell(by_method[m]) for cell in cells for m in METHODS)]
        for length, by_method in _losses(evaluation)
    ]
    head = [f"{what}: {METHODS[method]}" for what in ("all joints", "its elbow", "step") for method in METHODS]
    return table(["hand lost for [cm]", *head], rows)


def faults(evaluation: Json) -> str:
    """Returns the table of errors added by a misplaced tracker or a wrong calibration: the worst direction of each."""
    estimators = evaluation["robustness"]["estimators"]
    kinds: list[tuple[str, str, Callable[[Json], bool]]] = [
        (f"{tracker} ±{size} cm", "offsets", lambda o, t=tracker, s=size: o["tracker"] == t and abs(o["offsetCm"]) == s)
        for tracker in ("headset", "grips")
        for size in (1, 3)
    ]
    kinds += [
        (f"{label} ±{size} %", key, lambda o, s=size: abs(o["percent"]) == s)
        for key, label, sizes in (("heights", "eye height", (2, 5)), ("spans", "arm span", (5,)))
        for size in sizes
    ]

    def cell(method: str, key: str, chosen: Callable[[Json], bool]) -> str:
        worst = max(entry["mpjpeCm"] for entry in estimators[method][key] if chosen(entry))
        return signed(worst - estimators[method]["mpjpeCm"])

    rows = [[label, *(cell(method, key, chosen) for method in METHODS)] for label, key, chosen in kinds]
    return table(["added to the MPJPE [cm], worst direction", *METHODS.values()], rows)


def laboratories(home: ByHands, elsewhere: ByHands) -> str:
    """Returns the table of people held out and of another laboratory, with and without calibrated hands."""
    names, others = (", ".join(people_held_out(measured[0])) for measured in (home, elsewhere))
    labelled = {
        f"{names}, hands not calibrated": home[0],
        f"{names}, hands calibrated": home[1],
        f"another laboratory ({others}), hands not calibrated": elsewhere[0],
        "another laboratory, hands calibrated": elsewhere[1],
    }
    rows = []
    for label, evaluation in labelled.items():
        ik, ours = (held_out(evaluation)[method] for method in ("ik", "learned"))
        errors = [figures["mpjpeCm"]["mean"] for figures in (ik, ours)]
        cells = (*errors, errors[1] / errors[0], _elbows_cm(ours) / _elbows_cm(ik), ik["jerkRatio"], ours["jerkRatio"])
        rows.append([label, *(f"{value:.2f}" for value in cells)])
    return table(["cm", "IK", "learned", "learned / IK", "elbows", "jerk: IK", "learned"], rows)


def _mpjpe_cm(report: Json) -> float:
    return report["mpjpeCm"]["mean"]


def _elbows_cm(figures: Json) -> float:
    """Returns the mean error of both elbows [cm]."""
    return (figures["joints"]["leftElbow"]["mean"] + figures["joints"]["rightElbow"]["mean"]) / 2


def _row(what: str, aim: str, measured: str, met: bool) -> list[str]:
    """Returns a row of `aims`; callers round first, so that the verdict agrees with the printed value."""
    return [what, aim, measured, "met" if met else "missed"]


def _mean_over_people(people: list[Json], method: str, error: Callable[[Json], float]) -> float:
    """Returns the mean of an error [cm] with equal weight for each person."""
    return sum(error(person[method]) for person in people) / len(people)


def aims(evaluation: Json, contract: Json) -> str:
    """Returns the table of aims, measured values and verdicts."""
    figures, robust = held_out(evaluation), evaluation["robustness"]["estimators"]["learned"]
    ours = figures["learned"]
    judged = [person for person in evaluation["people"].values() if not person["seen"]] or list(
        evaluation["people"].values()
    )
    ratio, elbow = (
        round(_mean_over_people(judged, "learned", error) / _mean_over_people(judged, "ik", error), 3)
        for error in (_mpjpe_cm, _elbows_cm)
    )
    worst = round(max(_mpjpe_cm(person["learned"]) / _mpjpe_cm(person["ik"]) for person in judged), 3)
    offset = round(max(o["mpjpeCm"] for o in robust["offsets"]) - robust["mpjpeCm"], 2)
    height = round(max(h["mpjpeCm"] for h in robust["heights"]) - robust["mpjpeCm"], 2)
    long = robust["losses"][-1]["during"]
    jump = max(
        loss[when]["excessCm"]
        for loss in (*robust["losses"], robust["handTracking"])
        for when in ("atLoss", "atReturn")
    )
    lost_all, lost_elbow = round(long["allCm"] / long["allSeenCm"], 2), round(long["elbowCm"] / long["elbowSeenCm"], 2)
    held = ", ".join(people_held_out(evaluation))
    rows = [
        _row(f"MPJPE relative to IK, {held}", "≤ 0.86", f"{ratio:.3f}", ratio <= 0.86),
        _row(f"elbows relative to IK, {held}", "≤ 0.88", f"{elbow:.3f}", elbow <= 0.88),
        _row("the person with the largest MPJPE relative to IK", "≤ 1.0", f"{worst:.3f}", worst <= 1.0),
        _row("jerk relative to the true motion", "≤ 1.1", f"{ours['jerkRatio']:.2f}", ours["jerkRatio"] <= 1.1),
    ]
    if exact := evaluation.get("fp32", {}).get("learned"):
        more, rougher = ours["mpjpeCm"]["mean"] - exact["mpjpeCm"]["mean"], ours["jerkRatio"] / exact["jerkRatio"]
        rows.append(_row("int8 against fp32: MPJPE", "≤ +0.05 cm", f"{signed(more, 3)} cm", more <= 0.05))
        rows.append(_row("int8 against fp32: jerk", "≤ 1.05 ×", f"{rougher:.3f} ×", rougher <= 1.05))
    size = contract["bytes"] / 1000
    hands, bones = ours["handErrorMaxMm"], ours["boneVariationMm"]
    rows += [
        _row("tracker mounted ±3 cm elsewhere, worst axis", "≤ +0.3 cm", f"{signed(offset)} cm", offset <= 0.3),
        _row("eye height wrong by ±5 %", "≤ +0.2 cm", f"{signed(height)} cm", height <= 0.2),
        _row("a hand lost for 2 s: all joints", "≤ 1.3 ×", f"{lost_all:.2f} ×", lost_all <= 1.3),
        _row("a hand lost for 2 s: its elbow", "≤ 1.8 ×", f"{lost_elbow:.2f} ×", lost_elbow <= 1.8),
        _row("jump of any joint at loss or return, in a frame", "≤ 5 cm", f"{jump:.1f} cm", jump <= 5),
        _row("hands on the controllers: largest distance", "0 mm", f"{hands:.1f} mm", hands < 0.05),
        _row("bone-length variation", "0 mm", f"{bones:.3f} mm", bones < 0.05),
        _row("size of the network", "≤ 300 kB", f"{size:.0f} kB", size <= 300),
    ]
    return table(["", "aim", "measured", "verdict"], rows)


def renew(page: str, sections: dict[str, str | None]) -> str:
    """Replaces the text between `<!-- NAME -->` and `<!-- /NAME -->` in the page; None keeps a section."""
    for name, content in sections.items():
        pattern = re.compile(rf"(<!-- {re.escape(name)} -->\n).*?(<!-- /{re.escape(name)} -->)", re.DOTALL)
        if len(pattern.findall(page)) != 1:
            raise ValueError(f"the page has no place for {name}: expected <!-- {name} --> … <!-- /{name} --> once")
        if content is not None:
            page = pattern.sub(lambda found, text=content: f"{found[1]}\n{text}\n\n{found[2]}", page)
    return page
