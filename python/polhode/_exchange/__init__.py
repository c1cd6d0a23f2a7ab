"""Attitudes as files that other programs read and interpolate, with knots that keep a stated error."""
