"""Worlds: scenes with an answer: shading a point, enclosures, closed-form cases."""
