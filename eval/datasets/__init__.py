"""Recorded RGB-D sequences: reading and writing them, and what was published about some."""

from slamgym.eval.datasets.prefetch import read_ahead
from slamgym.eval.datasets.published import Published, published
from slamgym.eval.datasets.registry import FORMATS, read_sequence
from slamgym.eval.datasets.sequence import Sequence
from slamgym.eval.datasets.writer import SequenceWriter

__all__ = [
    "FORMATS",
    "Published",
    "Sequence",
    "SequenceWriter",
    "published",
    "read_ahead",
    "read_sequence",
]
