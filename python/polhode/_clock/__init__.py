"""Controllers: programs that sample a motion, compute and hold."""
