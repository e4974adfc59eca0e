"""Stability: each numeric kernel beside the textbook's formula, where that loses its digits; no models here."""
