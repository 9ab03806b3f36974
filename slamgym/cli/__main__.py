"""`python -m slamgym.cli` is `slamgym`."""

from slamgym.cli import main

main()
