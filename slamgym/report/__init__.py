"""Reports: what the runs of a study say together, as one page that needs no network."""
