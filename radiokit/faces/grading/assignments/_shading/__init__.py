"""The questions of assignment 3, by how they are judged: numbers, samplers, estimates."""
