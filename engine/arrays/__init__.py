"""Small tools for arrays that several stages use."""
