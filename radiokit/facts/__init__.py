"""Facts: what is true before anything is measured. This floor imports nothing above it."""
