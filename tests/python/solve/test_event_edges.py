"""Events at and next to the ends of windows: each is found once, at its time, with the rates of its side."""

import numpy as np
import pytest
from ball_edges import KINDS, SPANS, Ball, shift

import polhode as ph

METHODS = (None, "taylor", "dop853", "rk45")


def find(scene, events, method=None, **options):
    return ph.solve(scene, 1e-9, method=method, events=events, **options).events


@pytest.mark.parametrize("name", SPANS)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("want", [("omega",), ("attitude",), ("omega", "attitude")])
def test_times_next_to_edges_are_found_each_once(kind, name, want):
    ball = Ball(kind, name, windows="touching", want=want)
    times = [t for t in ball.times if t not in (ball.t0, ball.times[-1])]
    hits = find(ball.scene, [lambda t, omega, attitude, at=at: t - at for at in times])
    before, after = [t for t in times if t < ball.t0][::-1], [t for t in times if t > ball.t0]
    assert [hit.t for hit in hits] == before + after
    assert [times[hit.event] for hit in hits] == before + after
    if kind != "rotor":   # whose rates jump at the edges themselves
        rates = dict(zip(ball.times, map(float, ball.rates()), strict=True))
        near = 1e-14 * max(map(abs, rates.values()))
        assert all(abs(hit.omega[2] - rates[hit.t]) < near for hit in hits)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", [name for name in SPANS if name != "least"])
@pytest.mark.parametrize("last_at_edge", [False, True])
def test_a_jump_of_the_rates_through_a_level_is_an_event(method, name, last_at_edge):
    ball = Ball("rotor", name, last_at_edge)
    begin, end = ball.windows[0]
    inside = float(ball.start if begin <= ball.t0 < end else ball.start - ball.size)
    outside = inside + float(ball.size)

    def level(t, omega, attitude):
        return omega[2] - 0.5 * (inside + outside)

    hits = find(ball.scene, [level], method)
    edges = [begin, end] if ball.t0 < end else [end, begin]   # backward first
    assert [hit.t for hit in hits] == edges
    for hit in hits:   # it has the rates behind the jump, along the run
        behind = hit.t + (1e-3 if hit.t >= ball.t0 else -1e-3) * (end - begin)
        assert hit.omega[2] == pytest.approx(inside if begin <= behind < end else outside, rel=1e-14)
    for direction in (1, -1):
        part = find(ball.scene, [ph.Event(level, direction=direction)], method)
        assert [hit.t for hit in part] == [hit.t for hit in hits if direction * (level(0, hit.omega, None)) > 0]


@pytest.mark.parametrize("method", METHODS)
def test_a_terminal_event_at_a_jump_ends_the_run(method):
    ball = Ball("rotor", "forward")
    stop = ph.Event(lambda t, omega, attitude: omega[2], terminal=True)
    motion = ph.solve(ball.scene, 1e-9, method=method, events=[stop])
    assert motion.status == "event" and motion.t[-1] == ball.windows[0][0] == motion.events[0].t
    assert motion.omega[-1, 2] == motion.events[0].omega[2] < 0   # as samples have them there
    assert "terminal event" in motion.message


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("backward", [False, True])
def test_zeros_at_an_edge_are_found_once_at_any_rounding(method, backward):
    """A rate and a component of the attitude that pass their values at the edges: neither piece alone sees a zero
    there if rounding puts it into the other."""
    rng = np.random.default_rng(8)
    for _ in range(12):
        span = (3.0, 0.0) if backward else (0.0, 3.0)
        edges = sorted(rng.uniform(0.3, 2.7, 2))
        torque = ph.torques.During(ph.torques.Constant(0.01 * rng.normal(size=3)), [edges])
        attitude = ph.Rotation.random(rng=rng).as_quat()
        scene = ph.Scene(inertia=(1, 1.5, 2.2), omega=rng.normal(size=3), attitude=attitude, t0=span[0],
                         times=sorted([*span, *edges]), torques=[torque])
        motion = ph.solve(scene, 1e-9, method=method)
        for k in (1, 2):
            for pick in (lambda omega, attitude: omega[1], lambda omega, attitude: attitude[0]):
                level = pick(motion.omega[k], motion.attitude[k])
                hits = find(scene, [lambda t, omega, attitude, pick=pick, level=level: pick(omega, attitude) - level],
                            method)
                assert sum(abs(hit.t - motion.t[k]) < 1e-9 for hit in hits) == 1


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("t0", [0.0, 3.0])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_function_that_touches_zero_at_an_edge_is_found_once(method, t0, sign):
    torque = ph.torques.During(ph.torques.Constant((0.01, 0.02, 0)), [(1, 2)])
    scene = ph.Scene(inertia=(1, 1.5, 2.2), omega=(0.3, 1, 0.2), t0=t0, times=[0, 3], torques=[torque])
    for edge in (1.0, 2.0):
        hits = find(scene, [lambda t, omega, attitude, edge=edge: sign * abs(t - edge)], method)
        assert [hit.t for hit in hits] == [edge]


@pytest.mark.parametrize("method", METHODS)
def test_a_function_that_stays_zero_is_reported_when_it_becomes_zero(method):
    """The rate stays at 4 rad/s once the torque has ended."""
    torque = ph.torques.During(ph.torques.Constant((0, 0, 3)), [(1, 2)])
    scene = ph.Scene(inertia=(1, 1, 1), omega=(0, 0, 1), torques=[torque], times=[0, 4])
    level = ph.solve(scene, 1e-9, method=method).omega[-1, 2]
    hits = find(scene, [lambda t, omega, attitude: omega[2] - level], method)
    assert len(hits) <= 1 and all(hit.t > 2 - 1e-14 for hit in hits)
    assert not find(scene, [lambda t, omega, attitude: omega[0]], method)   # zero from the start


def test_neighbours_of_an_edge_are_told_apart():
    ball = Ball("torque", "farther")
    edge = ball.windows[0][0]
    times = [shift(edge, count) for count in (-1, 0, 1)]
    assert np.diff([hit.t for hit in find(ball.scene, [lambda t, w, q, at=at: t - at for at in times])]).tolist() == \
        [times[1] - times[0], times[2] - times[1]]
