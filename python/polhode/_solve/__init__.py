"""Plans, the motions they lead to, and what methods cost."""
