"""What assignment 2 is made of: inputs and references, and what wrong solutions give."""
