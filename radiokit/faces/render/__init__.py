"""Render: small pictures, shaded pixel by pixel with the point shader, each pixel with its error."""
