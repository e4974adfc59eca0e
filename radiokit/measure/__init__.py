"""Measure: integration, sampling and statistics. It knows no optics."""
