"""Why was it lost? The drive around each loss again, with one thing changed at a time."""
