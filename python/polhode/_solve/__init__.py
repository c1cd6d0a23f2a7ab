"""Plans, motions, and the costs of methods."""
