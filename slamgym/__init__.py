"""slamgym measures how robust visual SLAM is."""
