"""Faces: what a person or a program sees: the command line, plots, and the validation run."""
