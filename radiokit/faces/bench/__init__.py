"""Bench: accuracy and speed of the integrators, beside each other and beside their peers. Only measures."""
