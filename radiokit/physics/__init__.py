"""Physics: what holds for any material."""
