"""Pictures: how they look, numbers in words, and motions drawn."""
