"""Derivations: one file for each family of formulas; each lists its own in DERIVATIONS."""
