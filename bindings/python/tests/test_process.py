"""Threads, signals and forks of Python."""

import os
import signal
import subprocess
import sys
import threading

import airlight
import numpy as np
import pytest

LAMP, FOG = airlight.Emitter((0, 1, 3), (0, -1, 0)), airlight.Medium(0.01, 0.1, 0.6)
SCENE = (0, 0, 0), (0, 0, 1), 0, 4, LAMP, FOG
U = np.linspace(0, 1, 1 << 20, dtype=np.float32)


@pytest.fixture
def patient():
    """No thread takes the interpreter from another one that does not give it."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(60)
    yield
    sys.setswitchinterval(interval)


@pytest.mark.usefixtures("patient")
def test_other_threads_run_during_a_call():
    started, seen, called = threading.Event(), threading.Event(), []

    def call():
        started.set()
        airlight.sample(*SCENE, U)
        called.append(seen.is_set())

    thread = threading.Thread(target=call)
    thread.start()
    started.wait()
    seen.set()
    thread.join()
    assert called == [True]


@pytest.fixture
def interruptible():
    """A process that was started in the background may ignore interrupts."""
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, handler)


@pytest.mark.usefixtures("patient", "interruptible")
def test_an_interrupt_during_a_call_is_raised():
    started = threading.Event()

    def interrupt():
        started.wait()
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        started.set()
        airlight.sample(*SCENE, U)
        while True:
            thread.join()
    thread.join()


def test_two_threads_call_at_once():
    expected = airlight.sample(*SCENE, U)
    results = []
    threads = [threading.Thread(target=lambda: results.append(airlight.sample(*SCENE, U))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4
    assert all(np.array_equal(result.t, expected.t) for result in results)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_a_forked_process_can_call():
    program = """
import airlight, numpy, os
u = numpy.linspace(0, 1, 1 << 16, dtype=numpy.float32)
lamp, fog = airlight.Emitter((0, 1, 3)), airlight.Medium(0.01, 0.1, 0.6)
call = lambda: airlight.sample((0, 0, 0), (0, 0, 1), 0, 4, lamp, fog, u)
before = call()
child = os.fork()
same = numpy.array_equal(call().t, before.t)
if child == 0:
    os._exit(0 if same else 1)
assert same and os.waitpid(child, 0)[1] == 0
"""
    subprocess.run([sys.executable, "-c", program], check=True, timeout=60)
