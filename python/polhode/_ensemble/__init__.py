"""Ensembles: many bodies drawn from distributions, summarised at each time, on one machine or a cluster."""
