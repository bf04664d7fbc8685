"""What rough drawings need to learn: bundles, what is meant of them, and what goes on in what."""
