"""Contracts: what a model must provide, and where models are found."""
