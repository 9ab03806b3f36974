"""Studies: one file that describes thousands of runs, and what runs them on a laptop or a cluster."""
