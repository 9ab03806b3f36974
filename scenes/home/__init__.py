"""Parts of a procedural home: plan, shell, surfaces, furniture and where it stands."""
