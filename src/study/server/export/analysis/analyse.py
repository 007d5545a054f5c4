"""Recomputes the tables in results/ from the tidy tables of this export, and reports differences.

    python -m pip install -r analysis/requirements.txt
    python analysis/analyse.py

The script is independent of the program that made the export: the tests are SciPy's, sums of squares are those of
linear models. The computed tables are written to analysis/python/. Change the script as you like: it is a start for
your own analysis, and is one file for that reason.
"""

import csv
import math
import sys
from collections import Counter
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import optimize, stats

ROOT = Path(__file__).resolve().parent.parent
RELATIVE = 1e-6
# The difference of two figures up to which it is rounding.
ABSOLUTE = 1e-9
CONFIDENCE = 0.95
# The share of all squares up to which an error is rounding.
CONSTANT_SQUARES = 1e-20
# The share of the largest input up to which two values are equal but for rounding.
EQUAL_WITHIN = 1e-9
# The confidence for a share of the variance, which is one-sided.
ETA_CONFIDENCE = 0.9
# The export has no interval if F times its degrees of freedom, or the noncentrality of an end, is larger.
LARGEST_F = 700
LARGEST_LAMBDA = 1400
# The limits of t and its noncentrality.
LARGEST_T = 18.5
LARGEST_DELTA = 37
# Wilcoxon's tests are exact below this number of pairs (values in a cohort), without ties and zeros.
EXACT_BELOW = 50


def read(name):
    """Returns the rows of a table as dictionaries of text; an empty text is a missing value."""
    with open(ROOT / name, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def mean_interval(values):
    """Returns the mean and the ends of its confidence interval, which are None for one value."""
    values = np.asarray(values, float)
    mean = values.mean()
    if len(values) < 2:
        return mean, None, None
    half = stats.t.ppf((1 + CONFIDENCE) / 2, len(values) - 1) * values.std(ddof=1) / math.sqrt(len(values))
    return mean, mean - half, mean + half


def noncentrality_of_t(t, df, share):
    """Returns the noncentrality at which the noncentral t is below t with this probability; None: out of reach."""

    def above(noncentrality):
        return stats.nct.cdf(t, df, noncentrality) - share

    # The search widens in small steps, because SciPy has no value far out.
    least = most = t
    while above(least) < 0:
        least -= 1
    while above(most) > 0:
        if most >= LARGEST_DELTA:
            return None
        most = min(LARGEST_DELTA, most + 1)
    return optimize.brentq(above, least, most, xtol=1e-13, rtol=1e-14)


def effect_interval(t, df, unit, name):
    """Returns the confidence interval of the noncentrality of t, times unit; empty if it is out of reach."""
    if abs(t) > LARGEST_T:
        return {}
    ends = [noncentrality_of_t(abs(t), df, (1 + side * CONFIDENCE) / 2) for side in (1, -1)]
    if None in ends:
        return {}
    low, high = ends if t >= 0 else (-ends[1], -ends[0])
    return {f"low_{name}": low * unit, f"high_{name}": high * unit}


def biserial(r, error):
    """Returns the correlation and its interval by Fisher's z, which is missing if all ranks are on one side.

    `error` is the standard error of ranks without a difference.
    """
    if abs(r) == 1:
        return {"rank_biserial": r}
    half = stats.norm.ppf((1 + CONFIDENCE) / 2) * error
    z = math.atanh(r)
    return {"rank_biserial": r, "low_rank_biserial": math.tanh(z - half), "high_rank_biserial": math.tanh(z + half)}


def rounding_of(values):
    """Returns the rounding error of a figure that is computed from these values."""
    return EQUAL_WITHIN * np.max(np.abs(values))


def levels_of(values, rounding=None):
    """Returns the level of each value, 1 the smallest; values that are equal but for rounding share a level."""
    values = np.asarray(values, float)
    if rounding is None:
        rounding = rounding_of(values)
    order = np.argsort(values)
    levels = np.ones(len(values), int)
    levels[order[1:]] += np.cumsum(np.diff(values[order]) > rounding)
    return levels


def paired_t(first, second):
    """Returns the two-sided paired t-test of first − second; only the difference if nothing varies."""
    differences = np.subtract(first, second)
    count = len(differences)
    result = {"difference": differences.mean(), "df": count - 1}
    if count < 2 or stats.sem(differences) <= rounding_of([first, second]):
        return result
    test = stats.ttest_rel(first, second)
    _, low, high = mean_interval(differences)
    dz = differences.mean() / differences.std(ddof=1)
    result |= {"low_difference": low, "high_difference": high, "t": test.statistic, "p": test.pvalue, "dz": dz}
    return result | effect_interval(test.statistic, count - 1, 1 / math.sqrt(count), "dz")


def signed_rank(first, second):
    """Returns Wilcoxon's signed-rank test as R's wilcox.test: without zeros, exact for few pairs without ties."""
    differences = np.subtract(first, second)
    rounding = rounding_of([first, second])
    nonzero = differences[np.abs(differences) > rounding]
    if len(nonzero) == 0:
        return {"v": 0, "method_wilcoxon": "exact"}
    amounts = levels_of(np.abs(nonzero), rounding)
    ranks = stats.rankdata(amounts)
    v = ranks[nonzero > 0].sum()
    n = len(nonzero)
    total = n * (n + 1) / 2
    exact = n == len(differences) and len(set(ranks)) == n and n < EXACT_BELOW
    test = stats.wilcoxon(np.sign(nonzero) * amounts, zero_method="wilcox", correction=True, method="exact" if exact else "asymptotic")
    return {
        "v": v,
        "p_wilcoxon": test.pvalue,
        "method_wilcoxon": "exact" if exact else "normal",
        **biserial((2 * v - total) / total, math.sqrt(n * (n + 1) * (2 * n + 1) / 6) / total),
    }


def welch_t(first, second):
    """Returns Welch's two-sided t-test of first − second; only the difference if nothing varies."""
    m, n = len(first), len(second)
    difference = np.mean(first) - np.mean(second)
    result = {"difference": difference}
    if m < 2 or n < 2:
        return result
    variances = np.var(first, ddof=1), np.var(second, ddof=1)
    error = math.sqrt(variances[0] / m + variances[1] / n)
    if error <= rounding_of([*first, *second]):
        return result
    test = stats.ttest_ind(first, second, equal_var=False)
    low, high = test.confidence_interval(CONFIDENCE)
    ds = difference / math.sqrt(((m - 1) * variances[0] + (n - 1) * variances[1]) / (m + n - 2))
    unit = math.sqrt(1 / m + 1 / n)
    result |= {"low_difference": low, "high_difference": high}
    result |= {"t": test.statistic, "df": test.df, "p": test.pvalue, "ds": ds}
    return result | effect_interval(ds / unit, m + n - 2, unit, "ds")


def rank_sum(first, second):
    """Returns Wilcoxon's rank-sum test (Mann and Whitney's) as R's wilcox.test; without p if all values are tied."""
    m, n = len(first), len(second)
    levels = levels_of([*first, *second])
    different = len(set(levels))
    exact = different == len(levels) and m < EXACT_BELOW and n < EXACT_BELOW
    test = stats.mannwhitneyu(levels[:m], levels[m:], use_continuity=True, method="exact" if exact else "asymptotic")
    w = test.statistic
    return {
        "w": w,
        "p_rank_sum": test.pvalue if different > 1 else None,
        "method_rank_sum": "exact" if exact else "normal",
        **biserial(2 * w / (m * n) - 1, math.sqrt((m + n + 1) / (3 * m * n))),
    }


def holm(p_values):
    """Returns Holm's adjusted p; a test without a p has none, but counts in the family."""
    order = sorted((p, index) for index, p in enumerate(p_values) if p is not None)
    adjusted = [None] * len(p_values)
    largest = 0.0
    for rank, (p, index) in enumerate(order):
        largest = max(largest, min(1.0, (len(p_values) - rank) * p))
        adjusted[index] = largest
    return adjusted


class Measure(NamedTuple):
    """The values of a question, scale or score."""

    begun: dict
    # The mean of the counted values by participant and condition.
    means: dict
    # The cohort of everyone with a record, counted or not.
    cohorts: dict


def measure(rows, value, cohort_of, begun):
    values = {}
    for row in rows:
        if row["excluded"] == "" and row[value] != "":
            values.setdefault(row["who"], {}).setdefault(row["condition"], []).append(float(row[value]))
    means = {who: {condition: np.mean(own) for condition, own in by.items()} for who, by in values.items()}
    cohorts = {}
    for row in rows:
        cohorts.setdefault(row["who"], cohort_of.get(row["participant"], ""))
    return Measure(begun, means, dict(sorted(cohorts.items())))


def places_of(rows, value):
    """Returns place and name of every numeric question or scale, in order; the name is the id if it is unique."""
    places = list(dict.fromkeys((r["task"], r["questionnaire"], r["id"]) for r in rows if r[value] != ""))
    times = Counter(place[2] for place in places)
    return [(place, place[2] if times[place[2]] == 1 else "/".join(place)) for place in places]


def as_boolean(value):
    return "TRUE" if value else "FALSE"


def answer_measures(file, name, value, words, study):
    """Returns the answers, or the scales that are computed from them, as measures."""
    rows = [{**r, "id": r[name], "who": r["participant"]} for r in read(file)]
    found = []
    for place, of in places_of(rows, value):
        planned = as_boolean("/".join(place) in study.planned)
        begun = {"of": of, "about": words.get(place[1:], ""), "unit": "answer", "planned": planned}
        own = [r for r in rows if (r["task"], r["questionnaire"], r["id"]) == place]
        found.append(measure(own, value, study.cohort_of, begun))
    return found


def score_measures(trials, unit, study):
    """Returns the scores of every task. The members of a group report the same score."""
    # Practice has no condition.
    played = [{**r, "who": int(r["group"])} for r in trials if r["condition"] != ""]
    found = []
    for task in dict.fromkeys(r["task"] for r in played):
        own = [r for r in played if r["task"] == task]
        once = {(r["who"], r["condition"], r["repetition"]): r for r in own if r["excluded"] == ""}
        rows = [r for r in own if r["excluded"] != ""] + list(once.values())
        planned = as_boolean(unit == "points" and f"{task}/score" in study.planned)
        begun = {"of": task, "about": "", "unit": unit, "planned": planned}
        found.append(measure(rows, "score" if unit == "points" else "percent", study.cohort_of, begun))
    return found


def family(rows, ranks):
    """Adds Holm's correction over rows that are tested together, for p and for the p by ranks."""
    for p, adjusted in (("p", "p_holm"), (ranks, f"{ranks}_holm")):
        for row, value in zip(rows, holm([row.get(p) for row in rows])):
            row[adjusted] = value
    return rows


def sides(**values):
    """Returns the mean and interval of each side that has values."""
    row = {}
    for side, own in values.items():
        if own:
            row[f"mean_{side}"], row[f"low_{side}"], row[f"high_{side}"] = mean_interval(own)
    return row


def compared(measures, first, second):
    """Compares the measures under two conditions, first − second, as one family."""
    rows = []
    for begun, means, _ in measures:
        pairs = [(own[first], own[second]) for _, own in sorted(means.items()) if first in own and second in own]
        row = {**begun, "first": first, "second": second, "n": len(pairs)}
        if pairs:
            a, b = map(list, zip(*pairs))
            row |= sides(first=a, second=b) | paired_t(a, b) | signed_rank(a, b)
        rows.append(row)
    return family(rows, "p_wilcoxon")


def complete_values(found, conditions):
    """Returns the values of everyone who has one under each of these conditions."""
    _, means, cohorts = found
    return {w: [means[w][c] for c in conditions] for w in cohorts if all(c in means.get(w, {}) for c in conditions)}


def between(measures, first, second, conditions):
    """Compares the measures in two cohorts, first − second, as one family, by the means of these conditions."""
    rows = []
    for found in measures:
        values = complete_values(found, conditions)
        a, b = ([np.mean(own) for w, own in values.items() if found.cohorts[w] == cohort] for cohort in (first, second))
        condition = conditions[0] if len(conditions) == 1 else ""
        row = {**found.begun, "first": first, "second": second, "condition": condition, "n_first": len(a), "n_second": len(b)}
        row |= sides(first=a, second=b)
        if a and b:
            row |= welch_t(a, b) | rank_sum(a, b)
        rows.append(row)
    return family(rows, "p_rank_sum")


def residual_squares(y, columns):
    if not columns:
        return float(y @ y)
    design = np.column_stack(columns)
    return float(np.sum((y - design @ np.linalg.lstsq(design, y, rcond=None)[0]) ** 2))


def noncentrality_at(f, df, share):
    """Returns the noncentrality, at least 0, at which F is below f with this probability; None: out of reach."""
    if stats.f.cdf(f, *df) <= share:
        return 0.0

    def above(noncentrality):
        return stats.ncf.cdf(f, *df, noncentrality) - share

    # The search widens in small steps, because SciPy has no value far out.
    most = f * df[0] + 1
    while above(most) > 0:
        if most >= LARGEST_LAMBDA:
            return None
        most = min(LARGEST_LAMBDA, most * 1.5)
    return optimize.brentq(above, 1e-12, most, xtol=1e-13, rtol=1e-14)


def effect(squares, error, df, epsilon, scale):
    """Returns F with p, effect size and interval; only its degrees of freedom if nothing varies."""
    row = {"df1": df[0], "df2": df[1]}
    if df[1] < 1 or error <= CONSTANT_SQUARES * scale:
        return row
    f = squares / df[0] / (error / df[1])
    row |= {"f": f, "p": stats.f.sf(f, *df), "partial_eta_squared": squares / (squares + error)}
    if epsilon is not None:
        row |= {"epsilon": epsilon, "p_corrected": stats.f.sf(f, epsilon * df[0], epsilon * df[1])}
    ends = [noncentrality_at(f, df, (1 + side * ETA_CONFIDENCE) / 2) for side in (1, -1)] if f * df[0] <= LARGEST_F else [None]
    if None not in ends:
        row["low_eta"], row["high_eta"] = (end / (end + df[0] + df[1] + 1) for end in ends)
    return row


def variance_analysis(cohorts):
    """Returns the effects of conditions, cohorts and their interaction (type III).

    Each contrast is tested by differences of linear models with sum-coded cohorts.
    """
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
    """Returns Friedman's test of the conditions, or Kruskal and Wallis's of the cohorts with one condition."""
    values = np.array([row for members in cohorts for row in members], float)
    count, conditions = values.shape
    values = levels_of(values.ravel()).reshape(values.shape)
    df = (conditions if conditions > 1 else len(cohorts)) - 1
    # Without a difference, the test has no value.
    spread = any(len(set(row)) > 1 for row in values) if conditions > 1 else len(set(values.flat)) > 1
    if not spread:
        return {"df_ranks": df}
    if conditions == 1:
        ends = np.cumsum([len(members) for members in cohorts])
        chi = stats.kruskal(*np.split(values.ravel(), ends[:-1])).statistic
        size = chi / (count - 1)
    else:
        # The formula is used, because SciPy's function needs three conditions.
        ranks = np.array([stats.rankdata(row) for row in values])
        ties = sum(float(np.sum(n**3 - n)) for row in values for n in [np.unique(row, return_counts=True)[1]])
        squares = float(np.sum((ranks.sum(axis=0) - count * (conditions + 1) / 2) ** 2))
        chi = 12 * squares / (count * conditions * (conditions + 1) - ties / (conditions - 1))
        size = chi / (count * df)
    return {"chi_squared": chi, "df_ranks": df, "p_ranks": stats.chi2.sf(chi, df), "effect_ranks": size}


def overall(measures, conditions):
    """Compares all conditions and cohorts at once, as one family, with a row per effect."""
    found = []
    for one in measures:
        complete = complete_values(one, conditions)
        names = sorted(set(one.cohorts.values()))
        cohorts = [[own for w, own in complete.items() if one.cohorts[w] == name] for name in names]
        if not cohorts or any(not members for members in cohorts):
            found.append((one.begun, len(complete), {}, {}))
        else:
            ranks = rank_test(cohorts) if len(conditions) > 1 or len(cohorts) > 1 else {}
            found.append((one.begun, len(complete), variance_analysis(cohorts), ranks))

    def tested(effects):
        main = effects.get("conditions") or effects.get("cohorts") or {}
        return main.get("p_corrected", main.get("p"))

    adjusted = holm([tested(effects) for _, _, effects, _ in found])
    ranks_adjusted = holm([ranks.get("p_ranks") for _, _, _, ranks in found])
    table = []
    for (begun, n, effects, ranks), p_holm, p_ranks_holm in zip(found, adjusted, ranks_adjusted):
        for index, (label, row) in enumerate(effects.items()):
            first = {**ranks, "p_holm": p_holm, "p_ranks_holm": p_ranks_holm} if index == 0 else {}
            table.append({**begun, "effect": label, "n": n, **row, **first})
    return table


def frame_times(rows, trials, cohort_of):
    """Returns the work per frame over all trials of a task under a condition in a cohort."""
    key = ("participant", "task", "block", "run", "attempt", "repetition", "condition")
    missed = {tuple(r[k] for k in key): int(r["missed_frames"]) for r in trials}
    counted = [r for r in rows if r["excluded"] == ""]
    groups = {}
    for row in counted:
        cohort = cohort_of.get(row["participant"], "")
        groups.setdefault((row["task"], row["condition"], cohort, row["stage"]), []).append(row)
    table = []
    for (task, condition, cohort, stage), own in sorted(groups.items(), key=lambda item: item[0][3] != "frame"):
        counts = np.array([float(r["count"]) for r in own])
        column = {name: np.array([float(r[name]) for r in own]) for name in ("min", "max", "mean", "p95")}
        table.append(
            {
                "task": task,
                "condition": condition,
                "cohort": cohort,
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


class Study(NamedTuple):
    """The planned measures and the cohorts of a study."""

    planned: set
    cohort_of: dict


def pairs_of(ids):
    """Returns every pair, the later one of the plan first, because the earlier one is the reference."""
    return [(second, first) for first, second in combinations(ids, 2)]


def all_tables():
    said = read("conditions.csv")
    conditions, cohorts = ([r["id"] for r in said if r["compared"] == of] for of in ("condition", "cohort"))
    cohort_of = {r["participant"]: r["cohort"] for r in read("participants.csv")}
    study = Study({r["measure"] for r in read("planned.csv")}, cohort_of)
    abouts = {(r["questionnaire"], r["question"]): r["about"] for r in read("questions.csv")}
    labels = {(r["questionnaire"], r["scale"]): r["label"] for r in read("scale-definitions.csv")}
    trials = read("trials.csv")
    answers = answer_measures("answers.csv", "question", "answer", abouts, study)
    scales = answer_measures("scales.csv", "scale", "value", labels, study)
    points = score_measures(trials, "points", study)
    percent = score_measures(trials, "percent", study)
    planned = [one for one in answers + scales + points if one.begun["planned"] == "TRUE"]
    # Cohorts are compared by the mean of all conditions, and by each of several alone.
    views = [conditions, *([c] for c in conditions)] if len(conditions) > 1 else [conditions]
    kinds = {"planned": [planned], "answers": [answers], "scales": [scales], "scores": [points, percent]}
    tables = {}
    for name, families in kinds.items():
        tables[f"{name}-compared"] = [
            row for pair in pairs_of(conditions) for measures in families for row in compared(measures, *pair)
        ]
        whole = len(conditions) > 2 or cohorts
        tables[f"{name}-overall"] = overall(families[0], conditions) if whole else []
        tables[f"{name}-cohorts"] = [
            row
            for pair in pairs_of(cohorts)
            for view in views
            for measures in families
            for row in between(measures, *pair, view)
        ]
    tables["frame-times"] = frame_times(read("frame-times.csv"), trials, cohort_of)
    return tables


def difference(ours, theirs):
    """Returns how a cell of the export differs from the computed one; None: it does not."""
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
                # The export puts an apostrophe in front of text that looks like a formula.
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
