"""Events: found on the continuous extension, each once, in the order of the integration."""

import numpy as np
import pytest
from bodies import BLOCK, scene

import polhode as ph


def flips(t, omega, attitude):
    return omega[1]


def test_the_rackets_flips_are_found_each_once():
    """First zero of omega2 after each of the flips of the closed form, S1's body at (1e-2, 5, 1e-2)."""
    body = scene("S2", omega=(1e-2, 5, 1e-2), times=[0.0, 30.0])
    motion = ph.solve(body, rtol=1e-12, events=[flips])
    free = ph.FreeMotion(BLOCK, (1e-2, 5, 1e-2))
    found = np.array([hit.t for hit in motion.events])
    assert found.size >= 4 and np.all(np.diff(found) > 1)
    np.testing.assert_allclose(free.at(found)[0][:, 1], 0, atol=1e-6)
    crossings = np.linspace(0, 30, 20001)
    assert found.size == np.count_nonzero(np.diff(np.sign(free.at(crossings)[0][:, 1])))
    assert abs(found[0] - 3.6834) < 1e-3 * 3.6834


def test_event_direction_terminal_and_order():
    body = scene("S3", times=np.linspace(0, 10, 11))
    both = ph.solve(body, rtol=1e-10, events=[lambda t, w, q: w[0]])
    up = ph.solve(body, rtol=1e-10, events=[ph.Event(lambda t, w, q: w[0], direction=1)])
    down = ph.solve(body, rtol=1e-10, events=[ph.Event(lambda t, w, q: w[0], direction=-1)])
    assert sorted([h.t for h in up.events] + [h.t for h in down.events]) == pytest.approx([h.t for h in both.events])
    # omega1 = 0.5 cos(a t), a = (0.2 - 0.4)/0.4 * 4 = -2: zeros at odd multiples of pi/4, falling first.
    np.testing.assert_allclose([h.t for h in both.events], np.pi / 4 * np.arange(1, 2 * len(both.events), 2), rtol=1e-9)
    assert down.events[0].t < up.events[0].t
    stop = ph.solve(body, rtol=1e-10, events=[ph.Event(lambda t, w, q: w[0], terminal=True), lambda t, w, q: t - 0.5])
    assert stop.status == "event" and stop.success
    assert [h.event for h in stop.events] == [1, 0] and stop.t[-1] <= stop.events[-1].t == pytest.approx(np.pi / 4)
    assert stop.t.size == 1


def test_two_zeros_within_one_step_and_a_zero_at_a_sample():
    """Events are looked for on the continuous extension, not at the ends of the steps alone."""
    calm = ph.Scene(inertia=(1, 1, 1), omega=(0, 0, 0.1), times=[0.0, 10.0])
    motion = ph.solve(calm, rtol=1e-3, events=[lambda t, w, q: (t - 4.0) * (t - 6.5), lambda t, w, q: t - 10.0])
    assert [(h.event, round(h.t, 9)) for h in motion.events] == [(0, 4.0), (0, 6.5), (1, 10.0)]
    assert motion.stats["steps"] < 10


def test_events_backwards():
    motion = ph.solve(scene("S3", times=[-2.0]), rtol=1e-10, events=[lambda t, w, q: w[0]])
    np.testing.assert_allclose([h.t for h in motion.events], [-np.pi / 4], rtol=1e-9)


def test_an_event_that_starts_at_zero_is_not_reported_there():
    motion = ph.solve(scene("S3", times=[0, 2.0]), rtol=1e-10, events=[lambda t, w, q: t])
    assert not motion.events
