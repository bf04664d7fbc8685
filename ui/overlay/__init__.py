"""What is drawn over the viewport: rings, routes, cards."""
