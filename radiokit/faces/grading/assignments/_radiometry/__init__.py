"""Radiometry: the questions of assignment 1 with their texts, inputs, references and known mistakes."""
