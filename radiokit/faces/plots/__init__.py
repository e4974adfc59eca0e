"""Plots: one file for each kind of picture."""
