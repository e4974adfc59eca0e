"""Cases: one file for each family of closed-form scenes."""
