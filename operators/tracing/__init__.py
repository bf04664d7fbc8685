"""From pictures to Grease Pencil: choosing, tracing in the background, placing."""
