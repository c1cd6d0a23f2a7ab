"""`python -m polhode` runs the command `polhode`."""

from .cli import main

if __name__ == "__main__":
    main()
