"""Other programs in the charts: one right-hand side for all, each program's answer, and what a crash or a hang does."""

import math
import os
import signal
import time

import numpy as np
import pytest

import polhode as ph
from polhode._harness.truth import compute_errors, find_truth
from polhode.charts import equations, peers
from polhode.charts.candidate import Answer, Candidate, Failure, refuses_times, tolerances
from polhode.charts.candidates import candidates
from polhode.charts.measure import measure
from polhode.charts.runners import InProcess, Subprocess, make_runner

TINY = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(1.0, 2.0, 3.0), times=np.linspace(0, 1, 5), name="tiny")
TORQUES = {
    "none": (),
    "gravity": ph.torques.Gravity(2.0, (0.3, 0.2, 0.5)),
    "gravity gradient": ph.torques.GravityGradient(1.5, 0.7),
    "damping": ph.torques.Damping(np.array([[0.5, 0.1, 0.2], [0.3, 0.4, 0.0], [0.1, 0.6, 0.3]])),
    "thruster": ph.torques.Constant((0.3, -0.2, 0.1)),
    "wind": ph.torques.Constant((0.3, -0.2, 0.1), "space"),
    "two": (ph.torques.Gravity(2.0, (0.0, 0.0, 1.0)), ph.torques.Constant((0.0, 0.0, 0.1))),
}
TURN = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])


@pytest.mark.parametrize("tensor", [np.diag([1.0, 2.0, 2.5]), TURN @ np.diag([1.0, 2.0, 2.5]) @ TURN.T],
                         ids=["diagonal", "full"])
@pytest.mark.parametrize("torque", TORQUES)
def test_the_right_hand_side_is_the_derivative_of_the_motion(torque, tensor):
    h, q = 1e-4, np.array([0.1, 0.7, 0.3, 0.5])
    scene = ph.Scene(inertia=tensor, omega=(1.0, 2.0, 3.0), attitude=q / np.linalg.norm(q), torques=TORQUES[torque],
                     t0=0.4,
                     times=[0.4 - h, 0.4 + h])
    motion = ph.solve(scene, method="rk45", rtol=1e-14)
    y = np.hstack([motion.omega, motion.attitude])
    start = np.concatenate([scene.omega, scene.attitude])
    f = equations.in_floats(scene)(0.4, start)
    np.testing.assert_allclose(f, (y[1] - y[0]) / (2 * h), atol=1e-6)   # the third derivative times h^2 / 6
    np.testing.assert_allclose(equations.derivatives(scene, 0.4, start.tolist()), f, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("tensor", [np.diag([1.0, 2.0, 2.5]), TURN @ np.diag([1.0, 2.0, 2.5]) @ TURN.T],
                         ids=["diagonal", "full"])
@pytest.mark.parametrize("torque", TORQUES)
def test_the_reference_solves_the_same_equations(torque, tensor):
    q = np.array([0.1, 0.7, 0.3, 0.5])
    scene = ph.Scene(inertia=tensor, omega=(1.0, 2.0, 3.0), attitude=q / np.linalg.norm(q), torques=TORQUES[torque],
                     t0=0.4,
                     times=[4.0, -2.0, 0.4])
    truth, motion = find_truth(scene), ph.solve(scene, method="dop853", rtol=1e-13)
    assert "long double" in truth.source and truth.uncertainty < 3e-15
    assert compute_errors(motion.omega, motion.attitude, truth).largest < 3e-12


def test_a_method_that_does_not_reach_the_end_is_no_truth(monkeypatch):
    calls = []

    def solve(scene, **options):
        motion = ph.solve(scene, **options)
        calls.append(options["method"])
        if len(calls) > 1:
            return motion
        return type("M", (), {"status": "max_steps", "message": "", "omega": motion.omega[:1],
                              "attitude": motion.attitude[:1]})

    monkeypatch.setattr("polhode._harness.truth.solve", solve)
    made = find_truth(TINY.replace(torques=[ph.torques.Custom(lambda t, w, q: (0.0, 0.0, 0.0))]))
    omega, attitude = ph.FreeMotion(TINY.inertia, TINY.omega).at(TINY.times)
    assert compute_errors(omega, attitude, made).largest <= made.uncertainty < 1e-10
    assert made.source.startswith(f"{calls[1]} at 1e-14, checked by ") and f"{calls[0]} at 1e-14" not in made.source


def test_the_text_holds_nothing_that_is_not_used():
    steps, names = equations.source(ph.Scene.load("S4"))
    text = " ".join([*(t for _, t in steps), *names])
    assert all(name in text.split() or f"({name})" in text for name, _ in steps)
    assert len(steps) < 50   # the full rotation matrix alone would take 30


def test_a_torque_nobody_else_knows_is_refused():
    custom = TINY.replace(torques=[ph.torques.Custom(lambda t, w, q: (0.0, 0.0, 0.0))])
    assert "Custom" in equations.unwritten(custom)
    assert all(c.refuses(custom) for c in peers.candidates())


@pytest.mark.parametrize("name", [peer.NAME for peer in peers.PEERS])
def test_a_peer_is_there_or_named_as_missing(name):
    assert (name in peers.here()) != (name in peers.missing())


@pytest.mark.parametrize("scene", ["S1", "S5"])
@pytest.mark.parametrize("name", [c.name for c in peers.candidates()])
def test_peers_answer_the_same_question(name, scene):
    candidate = next(c for c in candidates() if c.name == name)
    if name.startswith("Odeint") and scene == "S1":
        pytest.skip("it is compiled for S5")
    scene = ph.Scene.load(scene)
    scene = scene.replace(times=scene.times[:11], name="short")
    if candidate.refuses(scene):
        pytest.skip(candidate.refuses(scene))
    if name in ("MuJoCo Euler", "MuJoCo RK4"):
        value, wanted = (1e-3, 1e-8) if name == "MuJoCo RK4" else (1e-4, 1e-2)
    else:
        value, wanted = 1e-9, 1e-6
    truth = find_truth(scene)
    run = candidate.start(scene)
    answers = [run(value, None), run(value, 60.0)]
    assert compute_errors(answers[0].omega, answers[0].attitude, truth).largest < wanted
    np.testing.assert_array_equal(answers[0].omega, answers[1].omega)


def test_scipys_counts_do_not_depend_on_the_unit_of_time():
    pytest.importorskip("scipy")
    peer = next(c for c in candidates() if c.name == "SciPy RK45")
    fast = TINY.replace(times=20 * TINY.times)
    slow = fast.replace(omega=1e-3 * fast.omega, times=1e3 * fast.times)
    counts = [peer.run(scene, 1e-6, None).stats["derivatives"] for scene in (fast, slow)]
    assert counts[1] == pytest.approx(counts[0], rel=0.05)   # SciPy's first step is not free of the unit


def test_times_from_the_start_on_are_in_order():
    assert refuses_times(TINY) == refuses_times(TINY.replace(t0=-1.0)) == ""   # a sample may be at the start
    assert "in order" in refuses_times(TINY.replace(t0=0.1)) and "in order" in refuses_times(TINY.replace(
        times=[1.0, 0.5]))


def test_peers_want_their_times_in_order():
    backwards = TINY.replace(times=[1.0, 0.5])
    assert all("in order" in c.refuses(backwards)
               for c in peers.candidates() if c.name.startswith(("SciPy RK", "heyoka", "Odeint")))


# a process apart


def test_a_process_apart_gives_the_same_bits():
    scene = ph.Scene.load("S5")
    runners = InProcess(candidates()), Subprocess()
    replies = []
    for runner in runners:
        runner.enter(scene)
        runner.start("rk45")
        replies.append(runner.run("rk45", 1e-6, 5.0))
        assert runner.clock("rk45", 1e-6, 2) > 0
        runner.close()
    np.testing.assert_array_equal(replies[0].answer.omega, replies[1].answer.omega)
    assert replies[0].answer.stats == replies[1].answer.stats


@pytest.mark.parametrize("gone", [False, True])
def test_a_crash_and_a_hang_are_points_and_the_others_go_on(monkeypatch, gone):
    runner = Subprocess()
    runner.enter(TINY)
    runner.start("rk45")
    os.kill(runner._process.pid, signal.SIGSEGV)   # as a program with a bug would end it
    if gone:
        runner._process.wait()   # before anything is sent to it
    with pytest.raises(Failure, match="by signal 11"):
        runner.run("rk45", 1e-6, 1.0)
    assert runner.run("rk45", 1e-6, 1.0).seconds > 0   # in a new one
    os.kill(runner._process.pid, signal.SIGSTOP)
    monkeypatch.setattr("polhode.charts.runners.GRACE", 0.2)
    begin = time.monotonic()
    with pytest.raises(Failure, match="hung: not back after"):
        runner.run("rk45", 1e-6, 0.01)
    assert time.monotonic() - begin < 5
    runner.close()


def test_what_cannot_be_sent_stays_here():
    scene = TINY.replace(torques=[ph.torques.Custom(lambda t, w, q: (0.0, 0.0, 0.0))])
    runner, why = make_runner([], [scene])
    assert isinstance(runner, InProcess) and "cannot be sent" in why


def test_an_answer_that_never_comes_is_left_out_for_tighter_settings():
    def run(scene):
        def one(value, limit):
            raise Failure("hung: not back after 15 s")
        return one

    result = measure(TINY, "", [Candidate("slow", "peer", "", tolerances(3, 5), run, lambda scene: "")], 1.0,
                     lambda text: None)
    assert [p.left_out for p in result.points] == [False, True, True]


def test_startups_are_told():
    def start(scene):
        time.sleep(0.05)
        return lambda value, limit: Answer(*ph.FreeMotion(scene.inertia, scene.omega).at(scene.times), {})

    result = measure(TINY, "", [Candidate("late", "method", "", tolerances(3, 4), start, lambda scene: "")], 1.0,
                     lambda text: None)
    assert 0.05 <= result.startups["late"] < 1 and all(p.seconds < 0.01 for p in result.points)
    assert math.isfinite(result.points[0].slowest)


@pytest.mark.parametrize("torque", ["none", "gravity", "gravity gradient", "damping", "thruster", "wind"])
@pytest.mark.parametrize("moments", [(1.0, 2.0, 2.5), (2.5, 1.0, 2.0), (2.0, 1.0, 2.5), (1.0, 2.5, 2.0)])
def test_the_separatrix_variables_have_the_same_motion(torque, moments):
    q = np.array([0.1, 0.7, 0.3, 0.5])
    scene = ph.Scene(inertia=moments, omega=(1.0, 2.0, 3.0), attitude=q / np.linalg.norm(q), times=[0.0, 1.0],
                     torques=TORQUES[torque])
    form, h = equations.Separatrix(scene), 1e-6
    y = form.start(scene)
    np.testing.assert_allclose(form.rates(y[None])[0], scene.omega, rtol=1e-15)
    slope = np.array(form.derivatives(scene, 0.3, y.tolist()))
    plain = equations.derivatives(scene, 0.3, [*scene.omega, *scene.attitude])
    moved = form.rates(np.stack([y + h * slope, y - h * slope]))
    np.testing.assert_allclose((moved[0] - moved[1]) / (2 * h), plain[:3], atol=1e-9)
    np.testing.assert_allclose(slope[3:], plain[3:], rtol=1e-14, atol=1e-14)


def test_scenes_without_separatrix_variables_are_refused():
    assert equations.Separatrix.refuses(TINY) == ""
    assert "triaxial" in equations.Separatrix.refuses(TINY.replace(inertia=(1.0, 1.0, 1.5)))
    assert "triaxial" in equations.Separatrix.refuses(TINY.replace(inertia=TURN @ np.diag([1.0, 2.0, 2.5]) @ TURN.T))
    assert "rotors" in equations.Separatrix.refuses(TINY.replace(rotors=[ph.Rotor((0, 0, 1), momentum=0.3)]))


def test_heyoka_in_u_v_keeps_the_racket():
    pytest.importorskip("heyoka")
    scene, found = ph.Scene.load("S2"), {}
    truth = find_truth(scene)
    for candidate in peers.heyoka.candidates():
        answer = candidate.start(scene)(2.3e-16, None)
        found[candidate.name] = compute_errors(answer.omega, answer.attitude, truth).largest
    assert found["heyoka u v"] < 1e-11 < 1e-6 < found["heyoka high_accuracy"] < found["heyoka"]


def test_cvode_takes_a_compiled_right_hand_side():
    pytest.importorskip("numba")
    program = equations.for_numba(TINY, "t, u, f")
    y, slope = np.array([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]), np.empty(7)
    program(0.0, y, slope)
    np.testing.assert_array_equal(slope, equations.in_floats(TINY)(0.0, y))
