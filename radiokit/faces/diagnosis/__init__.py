"""Diagnosis: what misconception a wrong answer betrays; the catalogue has one entry for each."""
