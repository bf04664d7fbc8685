"""Training of the network that tells drawn branches from others."""
