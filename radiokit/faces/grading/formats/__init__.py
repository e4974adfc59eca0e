"""Formats: a grade as what others read, one module each, by pure functions: a grade in, text or data out."""
