"""Causes proved: a lost drive repeated with one thing changed at a time."""
