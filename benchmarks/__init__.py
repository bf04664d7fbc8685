"""Quality and speed of the vectorizer beside its rivals; not shipped with the extension.

`python -m benchmarks.quality` and `python -m benchmarks.speed`, from the root of the project.
"""
