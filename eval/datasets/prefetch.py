"""Frames read ahead of their use, so that whoever uses them does not wait for files."""

from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor

from slamgym.eval.datasets.sequence import Sequence
from slamgym.types import Frame


def read_ahead(sequence: Sequence, frames: Iterable[int], depth: int = 4) -> Iterator[Frame]:
    """The frames of these numbers, in this order, while a thread already reads the `depth` (1 or more) after them.

    Raises SequenceError where the frame that cannot be read would come. The thread ends with the iterator: when it is
    at its end, closed, or collected.
    """
    coming: deque[Future[Frame]] = deque()
    with ThreadPoolExecutor(1, thread_name_prefix="read-ahead") as reader:
        try:
            for k in frames:
                coming.append(reader.submit(sequence.frame, k))
                if len(coming) > depth:
                    yield coming.popleft().result()
            while coming:
                yield coming.popleft().result()
        finally:
            reader.shutdown(wait=False, cancel_futures=True)
