"""Experiments: small numeric ones that show a statement of the lecture, or by how much it fails."""
