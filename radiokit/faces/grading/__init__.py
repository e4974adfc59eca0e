"""Grading: running code that is not trusted, apart from everything that it must not reach."""
