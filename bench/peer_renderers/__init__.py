"""What bench/peers is made of: scenes, renderers, and what is measured of their pictures."""
