"""The classroom: a folder of submissions graded by many workers, each once, the same bytes in every run."""
