"""Pictures: matplotlib figures, svg and png, that colour-blind people and grey printers can read."""

from slamgym.eval.plots.boxes import plot_boxes
from slamgym.eval.plots.cumulative import plot_cumulative
from slamgym.eval.plots.drive_map import plot_map
from slamgym.eval.plots.evaluation import evaluation_plots
from slamgym.eval.plots.failure_curve import plot_failure_curve
from slamgym.eval.plots.failure_curves import FailureCounts, plot_failure_curves
from slamgym.eval.plots.floor_plan import plot_floor_plan
from slamgym.eval.plots.heat_map import plot_heat_map
from slamgym.eval.plots.level_pairs import plot_level_pairs
from slamgym.eval.plots.names import printable
from slamgym.eval.plots.scatter import RankCorrelation, plot_scatter
from slamgym.eval.plots.sorted_bars import plot_sorted_bars
from slamgym.eval.plots.stacked_bars import plot_stacked_bars
from slamgym.eval.plots.style import save_figure
from slamgym.eval.plots.trajectory_time import plot_trajectory_time
from slamgym.eval.plots.trajectory_top import plot_trajectory_top

__all__ = [
    "FailureCounts",
    "RankCorrelation",
    "evaluation_plots",
    "plot_boxes",
    "plot_cumulative",
    "plot_failure_curve",
    "plot_failure_curves",
    "plot_floor_plan",
    "plot_heat_map",
    "plot_level_pairs",
    "plot_map",
    "plot_scatter",
    "plot_sorted_bars",
    "plot_stacked_bars",
    "plot_trajectory_time",
    "plot_trajectory_top",
    "printable",
    "save_figure",
]
