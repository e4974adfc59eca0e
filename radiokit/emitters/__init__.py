"""Emitters: one file for each light source; no emitter imports another."""
