"""Traces of Python functions: symbols in place of numbers, and the formula that they give."""
