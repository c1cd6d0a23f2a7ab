"""`python -m polhode` is the command `polhode`."""

from .cli import main

if __name__ == "__main__":
    main()
