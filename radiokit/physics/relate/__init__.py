"""Relate: which relation leads from what is known to what is wanted, its value, and when it holds."""
