"""Judges: what says how right a student's function is; each is given a callee, and sees no file."""
