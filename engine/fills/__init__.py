"""What is filled rather than drawn: solid blacks, closed regions, and their colours."""
