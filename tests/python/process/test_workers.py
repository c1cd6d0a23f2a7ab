"""Processes that work for another: what they say, how they end, and that they end with the one that started them."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from polhode._workers import Worker

ANSWERS = """
import os, time
from polhode._workers import serve

def answer(message):
    print("not an answer")
    for k in range(message):
        yield k, "x" * 300_000
    if message == 3: raise ValueError("three, of all\\nnumbers")
    if message == 4: time.sleep(60)

serve(answer)
"""


@pytest.fixture
def worker():
    made = Worker(sys.executable, "-c", ANSWERS)
    yield made
    if made.returncode is None:
        made.end()


def everything(worker, patience=300.0):   # it ends early; a busy machine takes long to start a process
    messages, end = [], time.monotonic() + patience
    while not (messages and messages[-1][0] == "end") and time.monotonic() < end:
        messages += worker.receive(1.0)
    return messages


def test_answers_come_whole_and_in_order(worker):
    for count in (2, 0, 1):
        worker.tell(count)
        assert everything(worker) == [*(("answer", (k, "x" * 300_000)) for k in range(count)), ("end", "")]


def test_what_is_raised_costs_the_rest_of_one_answer(worker):
    worker.tell(3)
    messages = everything(worker)
    assert len(messages) == 4 and messages[-1] == ("end", "ValueError: three, of all")
    worker.tell(1)
    assert len(everything(worker)) == 2


def test_it_says_how_it_ended(worker):
    worker.tell(0)
    everything(worker)
    os.kill(worker.pid, signal.SIGSEGV)
    assert worker.receive(10.0) is None
    assert worker.end(kill=False) == "ended its process by signal 11 (SIGSEGV)"


def test_a_sleep_without_end_is_no_progress(worker):
    worker.tell(4)
    messages = []
    while len(messages) < 4:
        messages += worker.receive(5.0)
    then, end = worker.alive, time.monotonic() + 2.5
    while time.monotonic() < end:   # a beat or two, the first of which tells what the start took
        worker.receive(0.5)
    assert time.monotonic() - worker.alive > 0.9 and worker.alive - then < 1.6


def test_ctrl_c_is_not_for_it_and_it_ends_with_its_giver():
    giver = f"""
import os, sys, time
from polhode._workers import Worker
worker = Worker(sys.executable, "-c", {ANSWERS!r})
worker.tell(4)
while not worker.receive(1.0): pass
print(worker.pid, os.getsid(worker.pid), flush=True)
os._exit(0)   # as one that is killed: nothing is tidied up
"""
    out = subprocess.run([sys.executable, "-c", giver], stdout=subprocess.PIPE, text=True, check=True).stdout
    pid, session = map(int, out.split())
    assert session == pid   # its own: no signal of the terminal reaches it
    state, end = Path(f"/proc/{pid}/stat"), time.monotonic() + 20
    with contextlib.suppress(OSError):   # it has gone between the look and the reading
        while state.exists() and state.read_text().split()[2] != "Z":
            assert time.monotonic() < end, "it works on for no reader"
            time.sleep(0.1)
