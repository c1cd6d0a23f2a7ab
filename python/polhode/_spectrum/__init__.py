"""Sparse measurements over many turns: the two frequencies of a free body from spectra, then the body from these."""
