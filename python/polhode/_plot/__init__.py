"""Pictures: their style, numbers as text, and pictures of motions."""
