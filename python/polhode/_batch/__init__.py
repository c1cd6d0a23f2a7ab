"""Many bodies, or many times, in one call."""
