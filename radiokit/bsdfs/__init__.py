"""BSDFs: one file for each model; no model imports another."""
