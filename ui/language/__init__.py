"""The interface in other languages than English: a table of texts each."""
