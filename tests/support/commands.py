"""Calls of the command line."""

import pytest
from typer.testing import CliRunner

from polhode.cli import main
from polhode.cli.app import app

RUNNER = CliRunner()


def call(*arguments):
    return RUNNER.invoke(app, [str(a) for a in arguments])


def left(*arguments, capsys):
    """Status, stdout and stderr of `main`, which also sees wrong options."""
    with pytest.raises(SystemExit) as leaving:
        main([str(a) for a in arguments])
    out = capsys.readouterr()
    return leaving.value.code or 0, out.out, out.err
