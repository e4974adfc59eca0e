"""Stability: each numeric kernel beside the textbook's formula where digits are lost; one file a family."""
