"""True drawings and pages made of them: for training, benchmarks and tests; not shipped."""
