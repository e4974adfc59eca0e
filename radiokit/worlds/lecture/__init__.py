"""Lecture: what the lecture on light as energy prints, slide by slide, and what decides each line."""
