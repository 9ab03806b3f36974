"""Study files that come with slamgym; `slamgym study NAME` runs one of them."""
