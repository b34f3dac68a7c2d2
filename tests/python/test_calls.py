# test_calls.py - a long call and others: progress, signals, threads, memory. SPDX-License-Identifier: MIT
import os
import signal
import sys
import threading
import time

import numpy as np
import pytest
from conftest import same

import fibrad

ENDLESS = {"directions": 65536}  # minutes for 2,000 spheres


def at_first_progress(action):
    """A progress function that acts once, when rows are being computed."""
    seen = []

    def progress(stage, done, total):
        if done and not seen:
            seen.append((stage, total))
            action()

    return progress, seen


def test_progress(small):
    calls = []
    fibrad.view_factors(small.x, small.r, directions=50, progress=lambda *call: calls.append(call))
    assert calls[0][:2] == ("rows", 0) and calls[-1] == ("rows", small.n, small.n)
    calls.clear()
    heat = fibrad.Bed(small.x, small.r, progress=lambda *call: calls.append(call))
    heat.beams()
    assert {stage for stage, _, _ in calls} == {"beams"}
    heat.solve(np.linspace(300, 400, small.n), 0.5, surroundings=300)
    assert {stage for stage, _, _ in calls} == {"beams", "sweeps"}


def test_progress_stops_a_call(mono):
    with pytest.raises(fibrad.Cancelled, match="stopped on request") as caught:
        fibrad.view_factors(mono.x, mono.r, **ENDLESS, progress=lambda stage, done, total: done > 0)
    assert isinstance(caught.value, RuntimeError) and caught.value.status == -12


def test_what_progress_raises_comes_through(mono):
    with pytest.raises(ZeroDivisionError):
        fibrad.view_factors(mono.x, mono.r, **ENDLESS, progress=lambda stage, done, total: 1 / 0)


def test_a_stopped_call_can_be_made_again(small):
    stop = []
    heat = fibrad.Bed(small.x, small.r, progress=lambda *call: bool(stop))
    stop.append(1)
    with pytest.raises(fibrad.Cancelled):
        heat.solve(300, 1, surroundings=300)
    stop.clear()
    heat.solve(300, 1, surroundings=300)


def test_control_c(mono):
    """As a person presses it, while C computes."""
    handler = signal.getsignal(signal.SIGINT)
    progress, seen = at_first_progress(lambda: os.kill(os.getpid(), signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        fibrad.view_factors(mono.x, mono.r, **ENDLESS, progress=progress)
    assert seen and signal.getsignal(signal.SIGINT) is handler


def test_control_c_without_progress(mono, capfd):
    """The signal comes from a timer, wherever Python is then; nothing of it is lost or printed."""
    for delay in np.linspace(0.05, 0.4, 12):
        timer = threading.Timer(delay, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            fibrad.view_factors(mono.x, mono.r, **ENDLESS)
        timer.join()
    assert capfd.readouterr().err == ""


def test_other_signals(mono):
    """A handler that raises stops the call with its exception; one that does not, does not."""
    class Alarm(Exception):
        pass

    def ring(number, frame):
        raise Alarm

    kept = signal.signal(signal.SIGALRM, ring)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Alarm):
            fibrad.view_factors(mono.x, mono.r, **ENDLESS)
        heard = []
        signal.signal(signal.SIGALRM, lambda number, frame: heard.append(number))
        progress, seen = at_first_progress(lambda: os.kill(os.getpid(), signal.SIGALRM))
        assert len(fibrad.view_factors(mono.x, mono.r, directions=30, progress=progress).data)
        assert heard == [signal.SIGALRM] and seen
    finally:
        signal.signal(signal.SIGALRM, kept)


def test_heat_is_stopped_too(mono):
    with pytest.raises(KeyboardInterrupt):
        progress, _ = at_first_progress(lambda: os.kill(os.getpid(), signal.SIGINT))
        fibrad.Bed(mono.x, mono.r, progress=progress).beams(directions=2000)


def test_other_threads_run_meanwhile(mono):
    """Between two progress calls only C runs in the calling thread. A thread that has counted on in that time had the
    GIL, which was not taken by force: the interval of that is long."""
    counted, last, advanced, stop = [0], [0], [], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(1e-4)

    def progress(stage, done, total):
        advanced.append(counted[0] > last[0])
        last[0] = counted[0]
        return len(advanced) == 20

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)
    counter = threading.Thread(target=count)
    counter.start()
    try:
        with pytest.raises(fibrad.Cancelled):
            fibrad.view_factors(mono.x, mono.r, **ENDLESS, raw=True, progress=progress)
    finally:
        stop.set()
        counter.join()
        sys.setswitchinterval(interval)
    assert sum(advanced) > 10


def test_calls_from_many_threads(small):
    expected = fibrad.view_factors(small.x, small.r, directions=50)
    found = []
    threads = [threading.Thread(target=lambda: found.append(fibrad.view_factors(small.x, small.r, directions=50, threads=2)))
               for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4 and all(same(expected, factors) for factors in found)


def resident():
    with open("/proc/self/statm", encoding="ascii") as line:
        return int(line.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="no /proc")
@pytest.mark.parametrize("what", ["factors", "exchange", "heat", "errors"])
def test_memory_is_given_back(what, mono):
    """Of twenty times, each of half a megabyte or more."""
    near = mono.x[:, 2] < 4
    x, r = mono.x[near], mono.r[near]
    broken = np.concatenate([x, x[:1]])

    def once():
        if what == "factors":
            fibrad.view_factors(x, r, directions=8).matrix.sum()
        elif what == "exchange":
            fibrad.exchange_factors(x, r, 0.9, directions=8, paths=10)
        elif what == "heat":
            with fibrad.Bed(x, r, threads=1) as heat:
                heat.beams(directions=8, patches=24)
                heat.solve(300, lambda kelvins: 1, surroundings=400)
                heat.move(x)
            fibrad.Bed(x, r, threads=1).beams(directions=8, patches=24)
        else:
            with pytest.raises(fibrad.Error):
                fibrad.view_factors(broken, 0.5)
            with pytest.raises(fibrad.Cancelled):
                fibrad.Bed(x, r, progress=lambda stage, done, total: done > 0).beams(directions=8)

    for _ in range(5):
        once()
    before = resident()
    for _ in range(20):
        once()
    assert resident() - before < 5e6


@pytest.mark.parametrize("radii, centre, wrong", [
    ([1, -1], 2.9, "radius -1"), ([1, float("nan")], 2.9, "radius nan"), (-1, 2.9, "radius -1"), (1e-300, 2.9, "1e-300"),
    (1, float("nan"), "coordinate"), (1, 1e300, "coordinate"), (1, 1, "the same centre")])
def test_contacts_of_no_bed(radii, centre, wrong):
    with pytest.raises(fibrad.InputError, match=wrong):
        fibrad.Bed([[0, 0, 1], [0, 0, centre]], radii).contacts(conductivity=30.0)
    with pytest.raises(fibrad.InputError, match="along a periodic axis"):
        fibrad.Bed([[0, 0, 1], [0, 0, 3]], 1, box=[1e-3, 0, 0]).contacts(conductivity=30.0)


def test_refusals_say_which_argument(small):
    """A value of another type is refused in words of fibrad, with the name of the argument."""
    light = fibrad.Light((0, 0, -1), 1000.0)
    factors = fibrad.view_factors(small.x, small.r, directions=8, walls="zmin:at=-1")
    with fibrad.Bed(small.x, small.r) as heat:
        calls = [
            ("zmax.*there are zmin", lambda: factors.wall("zmax")),
            ("light must be what shine of this bed returns", lambda: heat.solve(300, 1, surroundings=300, light=light)),
            ("lights must be Light", lambda: heat.shine(5, 0.5)),
            ("direction must be 3 finite numbers", lambda: heat.shine(fibrad.Light((0, 0, "a"), 1.0), 0.5)),
            ("disc must be 4 finite numbers", lambda: heat.shine(fibrad.Light((0, 0, -1), 1.0, disc=3), 0.5)),
            ("surroundings must be a number, not 'a'", lambda: heat.solve(300, 1, surroundings="a")),
            ("walls must be words", lambda: heat.solve(300, 1, surroundings=300, walls=5)),
            ("scale must be a number", lambda: fibrad.Mesh.from_stl("none.stl", small.x, small.r, scale="a"))]
        for text, call in calls:
            with pytest.raises(fibrad.InputError, match=text):
                call()
