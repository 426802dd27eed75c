import os
import subprocess
import threading
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def root():
    return ROOT


@pytest.fixture(scope="session")
def command():
    """Runs the command `gelbench`, which the variable GELBENCH names."""
    program = os.environ.get("GELBENCH")
    if program is None:
        pytest.skip("GELBENCH does not name the command, so nothing is compared with it")

    def run(*arguments, cwd):
        done = subprocess.run(
            [str(Path(program).resolve()), "--quiet", *map(str, arguments)], cwd=cwd, capture_output=True, text=True
        )
        return done.returncode, done.stdout, done.stderr

    return run


@pytest.fixture
def counted_meanwhile():
    """How far a thread counts, a step each millisecond, while another one works."""

    def count(work):
        counted, ended = 0, threading.Event()

        def other():
            work()
            ended.set()

        worker = threading.Thread(target=other)
        worker.start()
        while not ended.is_set():
            counted += 1
            time.sleep(0.001)
        worker.join()
        return counted

    return count
