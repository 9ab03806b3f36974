"""Statistics over many runs."""
