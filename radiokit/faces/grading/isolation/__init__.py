"""Isolation: running code that is not trusted, apart from what it must not reach; it knows no grades."""
