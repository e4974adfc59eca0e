"""Lecture: what the lecture on light as energy prints, slide by slide, and the check that decides each line."""
