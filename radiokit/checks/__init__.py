"""Checks: one file for each law. The judges know no model."""
