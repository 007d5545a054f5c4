"""Computes the tables in results/ anew from the tidy tables of this export, and says what differs.

    python -m pip install -r analysis/requirements.txt
    python analysis/analyse.py

Nothing of the program that made the export is used: the tests are SciPy's, sums of squares are those of linear models. The tables
computed are written to analysis/python/. Change what you like: this file is a beginning for an analysis of your own.
"""

import csv
import math
import sys
from collections import Counter
from itertools import combinations
from pathlib import Path

import numpy as np
from scipy import optimize, stats

ROOT = Path(__file__).resolve().parent.parent
RELATIVE = 1e-6
# Figures this small differ by rounding.
ABSOLUTE = 1e-9
CONFIDENCE = 0.95
# Differences this small against the values are rounding, as R has it.
CONSTANT = 10 * np.finfo(float).eps
# Of values about 0: squares this small are rounding.
CONSTANT_SQUARES = 1e-20
# Of a share of the variance, which has but one side.
ETA_CONFIDENCE = 0.9
# F times its degrees of freedom beyond which the export has no interval.
LARGEST_F = 700
# From as many pairs on, or with ties or zeros, Wilcoxon's test is approximated.
EXACT_BELOW = 50


def read(name):
    """Rows of a table as dictionaries of text; an empty text is no value."""
    with open(ROOT / name, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def mean_interval(values):
    """Mean and the ends of its confidence interval; None where one value has none."""
    values = np.asarray(values, float)
    mean = values.mean()
    if len(values) < 2:
        return mean, None, None
    half = stats.t.ppf((1 + CONFIDENCE) / 2, len(values) - 1) * values.std(ddof=1) / math.sqrt(len(values))
    return mean, mean - half, mean + half


def paired_t(first, second):
    """The two-sided paired t-test of first − second; what does not vary has a difference alone."""
    differences = np.subtract(first, second)
    count = len(differences)
    result = {"difference": differences.mean(), "df": count - 1}
    if count < 2 or stats.sem(differences) <= CONSTANT * abs(differences.mean()):
        return result
    test = stats.ttest_rel(first, second)
    _, low, high = mean_interval(differences)
    dz = differences.mean() / differences.std(ddof=1)
    return {**result, "low_difference": low, "high_difference": high, "t": test.statistic, "p": test.pvalue, "dz": dz}


def signed_rank(first, second):
    """Wilcoxon's signed-rank test as R's wilcox.test: zeros dropped, exact where nothing is tied and pairs are few."""
    differences = np.subtract(first, second)
    nonzero = differences[differences != 0]
    if len(nonzero) == 0:
        return {"v": 0, "method_wilcoxon": "exact"}
    ranks = stats.rankdata(np.abs(nonzero))
    v = ranks[nonzero > 0].sum()
    exact = len(nonzero) == len(differences) and len(set(ranks)) == len(ranks) and len(ranks) < EXACT_BELOW
    method = "exact" if exact else "asymptotic"
    test = stats.wilcoxon(nonzero, zero_method="wilcox", correction=True, method=method)
    return {
        "v": v,
        "p_wilcoxon": test.pvalue,
        "method_wilcoxon": "exact" if exact else "normal",
        "rank_biserial": (2 * v - ranks.sum()) / ranks.sum(),
    }


def holm(p_values):
    """Holm's adjusted p; a test without a p has none, and counts in the family."""
    order = sorted((p, index) for index, p in enumerate(p_values) if p is not None)
    adjusted = [None] * len(p_values)
    largest = 0.0
    for rank, (p, index) in enumerate(order):
        largest = max(largest, min(1.0, (len(p_values) - rank) * p))
        adjusted[index] = largest
    return adjusted


def measures(rows, value):
    """What was asked with a number, in the order first met: its place, and its name (the id where that is of one place alone)."""
    places = list(dict.fromkeys((r["task"], r["questionnaire"], r["id"]) for r in rows if r[value] != ""))
    times = Counter(place[2] for place in places)
    return [(place, place[2] if times[place[2]] == 1 else "/".join(place)) for place in places]


def of_place(rows, place):
    return [r for r in rows if (r["task"], r["questionnaire"], r["id"]) == place]


def means_of(rows, value):
    """The mean of what counts, by whom and condition."""
    values = {}
    for row in rows:
        if row["excluded"] == "" and row[value] != "":
            values.setdefault(row["who"], {}).setdefault(row["condition"], []).append(float(row[value]))
    return {who: {condition: np.mean(own) for condition, own in by.items()} for who, by in values.items()}


def compared(series, first, second):
    """One family: each of the series (name, unit, means) under two conditions, first − second."""
    rows = []
    for name, unit, about, means in series:
        pairs = [(own[first], own[second]) for _, own in sorted(means.items()) if first in own and second in own]
        row = {"of": name, "about": about, "unit": unit, "first": first, "second": second, "n": len(pairs)}
        if pairs:
            a, b = map(list, zip(*pairs))
            for side, values in (("first", a), ("second", b)):
                row[f"mean_{side}"], row[f"low_{side}"], row[f"high_{side}"] = mean_interval(values)
            row |= paired_t(a, b) | signed_rank(a, b)
        rows.append(row)
    for adjusted, p in (("p_holm", "p"), ("p_wilcoxon_holm", "p_wilcoxon")):
        for row, value in zip(rows, holm([row.get(p) for row in rows])):
            row[adjusted] = value
    return rows


def residual_squares(y, columns):
    if not columns:
        return float(y @ y)
    design = np.column_stack(columns)
    return float(np.sum((y - design @ np.linalg.lstsq(design, y, rcond=None)[0]) ** 2))


def noncentrality_at(f, df, share):
    """Where the noncentral F is below f with this probability, at least 0."""
    if stats.f.cdf(f, *df) <= share:
        return 0.0

    def above(noncentrality):
        return stats.ncf.cdf(f, *df, noncentrality) - share

    # SciPy has no value far out: no further than is needed.
    most = f * df[0] + 1
    while above(most) > 0:
        most *= 1.5
    return optimize.brentq(above, 1e-12, most, xtol=1e-13, rtol=1e-14)


def effect(squares, error, df, epsilon, scale):
    """F and what follows from it; only its degrees of freedom where nothing spreads."""
    row = {"df1": df[0], "df2": df[1]}
    if df[1] < 1 or error <= CONSTANT_SQUARES * scale:
        return row
    f = squares / df[0] / (error / df[1])
    row |= {"f": f, "p": stats.f.sf(f, *df), "partial_eta_squared": squares / (squares + error)}
    if epsilon is not None:
        row |= {"epsilon": epsilon, "p_corrected": stats.f.sf(f, epsilon * df[0], epsilon * df[1])}
    if f * df[0] <= LARGEST_F:
        for end, share in (("low_eta", (1 + ETA_CONFIDENCE) / 2), ("high_eta", (1 - ETA_CONFIDENCE) / 2)):
            noncentrality = noncentrality_at(f, df, share)
            row[end] = noncentrality / (noncentrality + df[0] + df[1] + 1)
    return row


def variance_analysis(cohorts):
    """Effects of conditions, cohorts and both, type III: differences of linear models with sum-coded cohorts, contrast by contrast."""
    values = np.array([row for members in cohorts for row in members], float)
    sizes = [len(members) for members in cohorts]
    count, conditions = values.shape
    groups = len(sizes)
    scale = float(np.sum(values**2))
    membership = np.repeat(np.arange(groups), sizes)
    one = np.ones(count)
    coded = [(membership == g).astype(float) - (membership == groups - 1) for g in range(groups - 1)]

    def parts(y):
        full = residual_squares(y, [one, *coded])
        return residual_squares(y, coded) - full, residual_squares(y, [one]) - full, full

    effects = {}
    if conditions > 1:
        helmert = np.array([[1.0] * (i + 1) + [-(i + 1.0)] + [0.0] * (conditions - i - 2) for i in range(conditions - 1)])
        helmert /= np.linalg.norm(helmert, axis=1, keepdims=True)
        contrasts = values @ helmert.T
        by_contrast = np.array([parts(y) for y in contrasts.T])
        mean, between, error = by_contrast.sum(axis=0)
        epsilon = None
        if error > CONSTANT_SQUARES * scale:
            residuals = contrasts - np.array([contrasts[membership == g].mean(axis=0) for g in range(groups)])[membership]
            covariance = residuals.T @ residuals
            epsilon = np.trace(covariance) ** 2 / ((conditions - 1) * np.sum(covariance**2))
        df = (conditions - 1, (count - groups) * (conditions - 1))
        effects["conditions"] = effect(mean, error, df, epsilon, scale)
    if groups > 1:
        _, between_sums, error_sums = parts(values.sum(axis=1) / math.sqrt(conditions))
        effects["cohorts"] = effect(between_sums, error_sums, (groups - 1, count - groups), None, scale)
        if conditions > 1:
            df = ((groups - 1) * (conditions - 1), (count - groups) * (conditions - 1))
            effects["conditions and cohorts"] = effect(between, error, df, epsilon, scale)
    return effects


def rank_test(cohorts):
    """Friedman's test of the conditions; with one condition, Kruskal and Wallis's of the cohorts."""
    values = np.array([row for members in cohorts for row in members], float)
    count, conditions = values.shape
    df = (conditions if conditions > 1 else len(cohorts)) - 1
    # With nothing but ties there is nothing to rank.
    spread = any(len(set(row)) > 1 for row in values) if conditions > 1 else len(set(values.flat)) > 1
    if not spread:
        return {"df_ranks": df}
    if conditions == 1:
        chi = stats.kruskal(*[np.ravel(members) for members in cohorts]).statistic
        size = chi / (count - 1)
    else:
        # By its formula: SciPy's function wants three conditions.
        ranks = np.array([stats.rankdata(row) for row in values])
        ties = sum(float(np.sum(n**3 - n)) for row in values for n in [np.unique(row, return_counts=True)[1]])
        squares = float(np.sum((ranks.sum(axis=0) - count * (conditions + 1) / 2) ** 2))
        chi = 12 * squares / (count * conditions * (conditions + 1) - ties / (conditions - 1))
        size = chi / (count * df)
    return {"chi_squared": chi, "df_ranks": df, "p_ranks": stats.chi2.sf(chi, df), "effect_ranks": size}


def overall(rows, value, conditions, cohort_of):
    """All conditions and cohorts at once, an effect a row; one family."""
    found = []
    for place, name in measures(rows, value):
        own = of_place(rows, place)
        means = means_of(own, value)
        everyone = sorted({row["who"] for row in own})
        complete = [who for who in everyone if all(c in means.get(who, {}) for c in conditions)]
        names = sorted({cohort_of.get(who, "") for who in everyone})
        cohorts = [[[means[w][c] for c in conditions] for w in complete if cohort_of.get(w, "") == n] for n in names]
        if not cohorts or any(not members for members in cohorts):
            found.append((name, len(complete), {}, {}))
        else:
            ranks = rank_test(cohorts) if len(conditions) > 1 or len(cohorts) > 1 else {}
            found.append((name, len(complete), variance_analysis(cohorts), ranks))

    def tested(effects):
        main = effects.get("conditions") or effects.get("cohorts") or {}
        return main.get("p_corrected", main.get("p"))

    adjusted = holm([tested(effects) for _, _, effects, _ in found])
    ranks_adjusted = holm([ranks.get("p_ranks") for _, _, _, ranks in found])
    table = []
    for (name, n, effects, ranks), p_holm, p_ranks_holm in zip(found, adjusted, ranks_adjusted):
        for index, (label, row) in enumerate(effects.items()):
            first = {**ranks, "p_holm": p_holm, "p_ranks_holm": p_ranks_holm} if index == 0 else {}
            table.append({"of": name, "effect": label, "n": n, **row, **first})
    return table


def frame_times(rows, trials):
    """Work of the page per frame, over all trials of a task under a condition."""
    key = ("participant", "task", "block", "run", "attempt", "repetition", "condition")
    missed = {tuple(r[k] for k in key): int(r["missed_frames"]) for r in trials}
    counted = [r for r in rows if r["excluded"] == ""]
    groups = {}
    for row in counted:
        groups.setdefault((row["task"], row["condition"], row["stage"]), []).append(row)
    table = []
    for (task, condition, stage), own in sorted(groups.items(), key=lambda item: item[0][2] != "frame"):
        counts = np.array([float(r["count"]) for r in own])
        column = {name: np.array([float(r[name]) for r in own]) for name in ("min", "max", "mean", "p95")}
        table.append(
            {
                "task": task,
                "condition": condition,
                "stage": stage,
                "trials": len(own),
                "frames": counts.sum(),
                "min": column["min"].min(),
                "max": column["max"].max(),
                "mean": float(counts @ column["mean"]) / counts.sum(),
                "worst_p95": column["p95"].max(),
                "missed": sum(missed[tuple(r[k] for k in key)] for r in own),
            }
        )
    return table


def prepared(rows, name):
    """Rows with one name for who and what was asked."""
    return [{**r, "id": r[name], "who": r["participant"]} for r in rows]


def all_tables():
    conditions = [r["id"] for r in read("conditions.csv") if r["compared"] == "condition"]
    has_cohorts = any(r["compared"] == "cohort" for r in read("conditions.csv"))
    cohort_of = {r["participant"]: r["cohort"] for r in read("participants.csv")}
    # What comes first in the plan is what others are compared with.
    pairs = [(second, first) for first, second in combinations(conditions, 2)]
    abouts = {(r["questionnaire"], r["question"]): r["about"] for r in read("questions.csv")}
    labels = {(r["questionnaire"], r["scale"]): r["label"] for r in read("scale-definitions.csv")}
    tables = {}
    for kind, file, name, value, words in (
        ("answers", "answers.csv", "question", "answer", abouts),
        ("scales", "scales.csv", "scale", "value", labels),
    ):
        rows = prepared(read(file), name)
        series = [
            (of, "answer", words.get(place[1:], ""), means_of(of_place(rows, place), value))
            for place, of in measures(rows, value)
        ]
        tables[f"{kind}-compared"] = [row for a, b in pairs for row in compared(series, a, b)]
        shown = len(conditions) > 2 or has_cohorts
        tables[f"{kind}-overall"] = overall(rows, value, conditions, cohort_of) if shown else []
    trials = read("trials.csv")
    scores = []
    for a, b in pairs:
        for unit, value in (("points", "score"), ("percent", "percent")):
            series = []
            for task in dict.fromkeys(r["task"] for r in trials):
                # The members of a group report one and the same score.
                once = {(r["group"], r["condition"], r["repetition"]): r for r in trials if r["task"] == task and r["excluded"] == ""}
                rows = [{**r, "who": int(r["group"])} for r in once.values()]
                series.append((task, unit, "", means_of(rows, value)))
            scores.append((unit, compared(series, a, b)))
    tables["scores-compared"] = [row for _, rows in scores for row in rows]
    tables["frame-times"] = frame_times(read("frame-times.csv"), trials)
    return tables


def difference(ours, theirs):
    """Why a cell of the export is not what was computed; None: it is."""
    if ours is None or isinstance(ours, str):
        return None if (ours or "") == theirs else f"{theirs!r} in the export, {ours!r} here"
    if theirs == "":
        return f"nothing in the export, {ours!r} here"
    if abs(float(ours) - float(theirs)) <= RELATIVE * abs(float(theirs)) + ABSOLUTE:
        return None
    return f"{theirs} in the export, {float(ours)!r} here"


def main():
    out = ROOT / "analysis" / "python"
    out.mkdir(exist_ok=True)
    wrong = 0
    for name, table in all_tables().items():
        theirs = read(f"results/{name}.csv")
        with open(ROOT / f"results/{name}.csv", encoding="utf-8", newline="") as file:
            columns = [c for c in next(csv.reader(file)) if c != "simulated"]
        with open(out / f"{name}.csv", "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(columns)
            writer.writerows([["" if row.get(c) is None else row[c] for c in columns] for row in table])
        complaints = [] if len(table) == len(theirs) else [f"{len(theirs)} rows in the export, {len(table)} here"]
        for number, (ours, row) in enumerate(zip(table, theirs), start=2):
            for column in columns:
                # Text of a formula's look has an apostrophe of the export's before it.
                said = difference(ours.get(column), row[column].removeprefix("'"))
                if said:
                    complaints.append(f"line {number}, {column}: {said}")
        wrong += len(complaints)
        verdict = "as computed here" if not complaints else f"{len(complaints)} differences"
        print(f"results/{name}.csv: {len(theirs)} rows, {verdict}")
        for complaint in complaints[:20]:
            print(f"  {complaint}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
