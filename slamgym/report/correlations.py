"""Which attributes of the paths and of the motion go with errors and failures?"""

from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd
from scipy import stats

from slamgym.eval.plots import RankCorrelation, plot_scatter
from slamgym.eval.statistics import correlations
from slamgym.eval.statistics.multiple import corrected
from slamgym.report.columns import numbers
from slamgym.report.content import DataTable, Picture, Section
from slamgym.report.judged import JudgedRuns, left_out_text, of_complete_paths
from slamgym.report.shares import FEWEST_PATHS
from slamgym.report.wording import sentence
from slamgym.types import FloatArray

ATTRIBUTES = {
    "velocity_m_per_s": "velocity (m/s)",
    "velocity_m_per_frame": "velocity (m/frame)",
    "angular_velocity_deg_per_s": "turn rate (deg/s)",
    "angular_velocity_deg_per_frame": "turn rate (deg/frame)",
    "acceleration_m_per_s2": "acceleration (m/s²)",
    "angular_acceleration_deg_per_s2": "angular acceleration (deg/s²)",
    "turning_on_spot_share": "share of turning on the spot",
    "turning_deg": "turning in all (deg)",
    "distance_m": "distance (m)",
    "speed_median_mps": "median speed (m/s)",
    "tracked_points_median": "tracked points (median)",
}
"""Column -> heading. What is measured of the frames that were fed: a stride raises what is counted a frame."""

METRICS = {
    "failed share": "failed",
    "ATE (m), failed last": "error_m",
    "RPE (m)": "rpe_trans_rmse_m",
    "completion": "completion",
}
"""Heading -> column."""

FEWEST_CONDITIONS = 4
MOST_PANELS = 6
MOST_POINTS = 20_000


def correlations_section(judged: JudgedRuns) -> Section | None:
    """Rank correlations between the paths, and within them where conditions were varied; None without enough paths."""
    complete = of_complete_paths(judged)
    if complete.paths < FEWEST_PATHS:
        return None
    attributes, metrics = _by(complete, ["place"])
    between = correlations(attributes, metrics)
    tables = [_between_table(between)]
    pictures = [_scatter(attributes, metrics, between)] if between["spearman"].notna().any() else []
    within = _within_paths(complete)
    if len(within):
        tables.append(_within_table(within))
    left_out = [text] if (text := left_out_text(judged)) else []
    sentences = tuple(map(sentence, [*_told_between(between), *_told_within(within), *left_out]))
    return Section("correlations", "What goes with errors and failures?", sentences, tuple(tables), tuple(pictures))


def _by(judged: JudgedRuns, keys: Sequence[str]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Means of the attributes and the metrics by group; the ATE and the RPE as medians, failed runs' ATE last."""
    table = judged.table
    columns = {name: numbers(table, name) for name in ATTRIBUTES}
    known = {name: values for name, values in columns.items() if np.isfinite(values).any()}
    by = [table[key] for key in keys]
    attributes = pd.DataFrame(known, index=table.index).groupby(by, observed=True).mean()
    outcomes = table[list(METRICS.values())].astype(np.float64)
    aggregates = {"failed": "mean", "error_m": "median", "rpe_trans_rmse_m": "median", "completion": "mean"}
    metrics = outcomes.groupby(by, observed=True).agg(aggregates)
    return attributes.rename(columns=ATTRIBUTES), metrics.rename(columns={v: k for k, v in METRICS.items()})


def _within_paths(judged: JudgedRuns) -> pd.DataFrame:
    """For each attribute and metric the mean over the paths of Spearman's rho over the conditions of one path.

    Paths are independent, so the p-value is that of Wilcoxon's signed rank test on their coefficients, by Holm's
    correction for all pairs of the table.
    """
    if not judged.factors or len(judged.cells) < FEWEST_CONDITIONS * judged.paths:
        return pd.DataFrame()
    attributes, metrics = _by(judged, ["place", *judged.columns])
    rows = [
        {"attribute": a, "metric": m, **_within(attributes[a], metrics[m])}
        for a in attributes.columns
        for m in metrics.columns
    ]
    table = pd.DataFrame(rows)
    return table.assign(p=corrected(table["p"]))


def _within(attribute: "pd.Series[float]", metric: "pd.Series[float]") -> dict[str, float]:
    both = pd.DataFrame({"x": attribute, "y": metric}).dropna()
    by_path = both.groupby(level="place")
    # Spearman's rho is Pearson's of the ranks, computed for all paths at once.
    ranks = by_path.rank()
    means = ranks.groupby(level="place").transform("mean")
    x, y = ((ranks[name] - means[name]) for name in ("x", "y"))
    sums = pd.DataFrame({"xy": x * y, "xx": x * x, "yy": y * y}).groupby(level="place").sum()
    enough = (by_path.size() >= FEWEST_CONDITIONS) & (sums["xx"] > 0) & (sums["yy"] > 0)
    rho: FloatArray = (sums["xy"] / np.sqrt(sums["xx"] * sums["yy"]))[enough].to_numpy(np.float64)
    if len(rho) < FEWEST_PATHS or not rho.any():
        return {"paths": len(rho), "rho": np.nan, "p": np.nan}
    return {"paths": len(rho), "rho": float(rho.mean()), "p": float(stats.wilcoxon(rho).pvalue)}


def _told_between(between: pd.DataFrame) -> list[str]:
    found = between[between["spearman_p_corrected"] < 0.05]
    if not len(found):
        return ["between the paths no attribute goes with errors or failures so that it could not be chance"]
    best = found.iloc[int(found["spearman"].abs().argmax())]
    return [
        f"between the paths, {best['metric']} goes with {best['attribute']} most clearly (Spearman "
        f"{best['spearman']:+.2f} over {best['n']} paths, corrected {p_text(best['spearman_p_corrected'])})"
    ]


def _told_within(within: pd.DataFrame) -> list[str]:
    found = within[within["p"] < 0.05] if len(within) else within
    if not len(found):
        return []
    best = found.iloc[int(found["rho"].abs().argmax())]
    return [
        f"on one and the same path, {best['metric']} goes with {best['attribute']} most clearly (Spearman "
        f"{best['rho']:+.2f} on average over {best['paths']} paths, corrected {p_text(best['p'])})"
    ]


def p_text(p: float) -> str:
    return "p < 0.001" if p < 0.001 else f"p = {p:.3f}" if p < 0.1 else f"p = {p:.2f}"


def _between_table(between: pd.DataFrame) -> DataTable:
    headings = {
        "n": "paths", "spearman": "Spearman", "spearman_p_corrected": "corrected p", "kendall": "Kendall",
        "kendall_p_corrected": "corrected p of Kendall",
    }  # fmt: skip
    frame = between[["attribute", "metric", *headings]].rename(columns=headings)
    return DataTable(
        name="correlations_between_paths",
        title="Between paths: which are hard?",
        caption="Rank correlations over the paths, one value each: means over all its runs, of errors medians. "
        "Coefficients go from -1 to 1, 0 is none; the p-values are corrected for all pairs of the table (Holm).",
        frame=frame.sort_values("corrected p", kind="stable"),
        formats={name: "{:+.2f}" if name in ("Spearman", "Kendall") else "{:.3g}" for name in headings.values()}
        | {"paths": "{:.0f}"},
    )


def _within_table(within: pd.DataFrame) -> DataTable:
    frame = within.rename(columns={"rho": "mean Spearman", "p": "corrected p"})
    return DataTable(
        name="correlations_within_paths",
        title="Within paths: what do the conditions change?",
        caption="Spearman's coefficient over the conditions of one path, averaged over the paths: what makes the same "
        "path harder. Attributes that change together, as speed and turn rate do, cannot be told apart by it. The "
        "p-values (Wilcoxon, over paths) are corrected for all pairs of the table (Holm).",
        frame=frame.sort_values("corrected p", kind="stable"),
        formats={"mean Spearman": "{:+.2f}", "corrected p": "{:.3g}"},
    )


def _scatter(attributes: pd.DataFrame, metrics: pd.DataFrame, between: pd.DataFrame) -> Picture:
    """The metric of the strongest correlation over the attributes that go with it most."""
    strongest = str(between["metric"].iloc[int(between["spearman"].abs().argmax())])
    points = slice(None, MOST_POINTS)
    is_error = METRICS[strongest] in ("error_m", "rpe_trans_rmse_m")
    rows = between[(between["metric"] == strongest) & between["spearman"].notna()]
    rows = rows.loc[rows["spearman"].abs().sort_values(ascending=False, kind="stable").index[:MOST_PANELS]]
    figures = rows[["spearman", "n", "spearman_p_corrected"]].astype(np.float64).to_numpy()
    told = {
        str(name): RankCorrelation(rho, int(n), p)
        for name, (rho, n, p) in zip(rows["attribute"], figures.tolist(), strict=True)
    }
    return Picture(
        name="correlations",
        title=f"{strongest[:1].upper()}{strongest[1:]} over the attributes of the paths",
        caption="A point for each path, all its runs together."
        + (" In the band at the top lie those of which half of the runs failed, or more." if is_error else ""),
        draw=partial(
            plot_scatter, {name: attributes[name].to_numpy()[points] for name in told},
            metrics[strongest].to_numpy()[points], quantity=strongest, correlations=told, log_y=is_error,
            counted="paths", can_fail=is_error,
        ),
    )  # fmt: skip
