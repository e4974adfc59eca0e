"""Handout: what students and instructors hold, made from an assignment and so never out of step with it."""
