"""The wing `judge`: what is wrong with a rotational motion, by how much, and why."""
