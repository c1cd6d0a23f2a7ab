"""Torques that act during windows of time: the span is cut there, and an independent integrator agrees."""

import json
import math

import numpy as np
import pytest
from bodies import BLOCK, TILTED
from scipy.integrate import solve_ivp

import polhode as ph
from polhode.torques import Constant, Custom, Damping, During, Gravity, GravityGradient

PLATE = (0.4, 0.4, 0.2)
FIRING = Constant((0.05, -0.02, 0.03))
INF = math.inf


def vertical(q):
    x, y, z, w = q
    return np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])


@pytest.mark.parametrize("count", [6, 7])
def test_of_many_pieces_the_first_and_the_last_are_listed(count):
    windows = [(2.0 * k + 1, 2.0 * k + 2) for k in range(count)]
    scene = ph.Scene(inertia=BLOCK, omega=(0.1, 0.2, 0.3), times=[2.0 * count], torques=[During(FIRING, windows)])
    plan = ph.plan(scene, accuracy=1e-6)
    assert len(plan.pieces) == 2 * count
    text = str(plan)
    assert ("  ... 2 more ..." in text) == (count == 7) and ("more" in text) == (count == 7)
    assert sum("Constant" in line and " to " not in line for line in text.split("\n")) >= 6


def pull(torque, t, w, q):
    """The torques' formulas, written once more."""
    if isinstance(torque, Constant):
        return np.asarray(torque.torque)
    if isinstance(torque, Gravity):
        return np.cross(torque.arm, -torque.weight * vertical(q))
    if isinstance(torque, Damping):
        return -torque.matrix @ w
    return np.asarray(torque.function(t, w, q))


def truth(scene):
    """SciPy's DOP853 from edge to edge; nothing of polhode but the scene's numbers."""
    moments = np.diag(scene.inertia.matrix)
    times, t0 = np.asarray(scene.times), scene.t0

    def rates(acting):
        def f(t, y):
            w, q = y[:3], y[3:] / np.linalg.norm(y[3:])
            tau = sum((pull(one, t, w, q) for one in acting), np.zeros(3))
            a, b, c = w
            x, y_, z, s = q
            turn = 0.5 * np.array([s * a + y_ * c - z * b, s * b + z * a - x * c, s * c + x * b - y_ * a,
                                   -x * a - y_ * b - z * c])
            return np.concatenate([(tau - np.cross(w, moments * w)) / moments, turn])
        return f

    def acting(middle):
        return [one.torque if isinstance(one, During) else one for one in scene.torques
                if not isinstance(one, During) or any(a <= middle < b for a, b in one.windows)]

    rows = np.full((times.size, 7), np.nan)
    edges = sorted({e for one in scene.torques if isinstance(one, During) for pair in one.windows for e in pair})
    for last, sign in ((times.max(), 1), (times.min(), -1)):
        if sign * (last - t0) < 0:
            continue
        stops = sorted((e for e in edges if sign * (e - t0) > 0 and sign * (last - e) > 0), key=lambda e: sign * e)
        begin, y = t0, np.concatenate([scene.omega, scene.attitude])
        for end in [*stops, last]:
            here = (sign * (times - begin) >= 0) & (sign * (end - times) >= 0)
            if end == begin:
                rows[here] = y
                continue
            found = solve_ivp(rates(acting(0.5 * (begin + end))), (begin, end), y, method="DOP853", rtol=1e-13,
                              atol=1e-15, max_step=0.5,
                              dense_output=True)
            if here.any():
                rows[here] = found.sol(times[here]).T
            begin, y = end, found.y[:, -1]
    return rows[:, :3], rows[:, 3:] / np.linalg.norm(rows[:, 3:], axis=1)[:, None]


def distance(motion, reference):
    omega, attitude = reference
    rates = np.linalg.norm(motion.omega - omega, axis=1).max() / np.linalg.norm(omega, axis=1).max()
    sign = np.sign(np.sum(motion.attitude * attitude, axis=1))[:, None]
    return max(rates, 2 * np.linalg.norm(sign * motion.attitude - attitude, axis=1).max())


def scene(*torques, inertia=BLOCK, omega=(0.1, 0.2, 0.3), times=np.linspace(0, 60, 61), **more):
    return ph.Scene(**{"inertia": inertia, "omega": omega, "torques": torques, "times": times, "name": "fired", **more})


SCENES = {
    "a symmetric body": scene(During(FIRING, [(0, 10), (30, 40)]), inertia=PLATE),
    "a body without symmetry": scene(During(FIRING, [(0, 10), (30, 40)])),
    "edges off the samples": scene(During(FIRING, [(3.3, 7.77), (30.123, 41.5)])),
    "two thrusters": scene(During(FIRING, [(5, 20)]), During(Constant((0, 0.1, 0)), [(10, 30)])),
    "partly outside": scene(During(FIRING, [(-50, 10), (55, 90)])),
    "infinite ends": scene(During(FIRING, [(-INF, 4), (50, INF)])),
    "touching": scene(During(FIRING, [(10, 20), (20, 30)])),
    "backwards too": scene(During(FIRING, [(-25, -15), (-5, 5), (20, 25)]), times=np.linspace(-30, 30, 61)),
    "backwards alone": scene(During(FIRING, [(5, 15)]), times=np.linspace(-20, 19, 40), t0=20.0),
    "an edge at the start": scene(During(FIRING, [(0, 12)]), times=np.linspace(-20, 20, 41)),
    "unsorted times": scene(During(FIRING, [(10, 20)]), times=[40.0, 0.0, 10.0, 15.0, 20.0, 20.0, 5.0]),
    "a brake": scene(During(Damping((0.1, 0.02, 0.05)), [(10, 30)]), Gravity(0.3, (0.1, 0.2, 0.3)), attitude=TILTED),
    "let go": scene(During(Gravity(2, (0, 0, 1)), [(5, 25)]), inertia=(1, 1, 0.5), omega=(0.1, 0, 6), attitude=TILTED),
    "a user's own": scene(During(Custom(lambda t, w, q: (0.02 * math.sin(t), 0, 0.01)), [(10, 25)]),
                          times=np.linspace(0, 30, 31)),
}
RUNS = {"planned": {"accuracy": 1e-9}, "tolerance": {"method": "dop853", "rtol": 1e-12},
        "steps": {"method": "rk4", "step": 2e-3}}


@pytest.fixture(scope="module")
def truths():
    kept = {}
    return lambda name: kept.setdefault(name, truth(SCENES[name]))


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("how", RUNS)
def test_windows_against_an_independent_integrator(name, how, truths):
    if how == "steps" and name in ("a user's own", "let go"):
        pytest.skip("takes sixty thousand steps")
    motion = ph.solve(SCENES[name], **RUNS[how])
    error = distance(motion, truths(name))
    assert motion.status == "finished" and np.array_equal(motion.t, SCENES[name].times)
    if how == "planned":
        assert motion.success and motion.error_kind == "bounded", motion.message
        assert error <= motion.error + 2e-10, (error, motion.error)   # SciPy's own error is some 6e-11
        if name != "a user's own":
            assert distance(motion, ph._core.reference(SCENES[name], 26, 1e-21, 10_000)[:2]) <= motion.error
    else:
        assert error < {"tolerance": 3e-10, "steps": 2e-8}[how]


def test_taylor_and_the_reference_agree():
    for name in ("two thrusters", "a brake", "backwards too"):
        omega, attitude, _ = ph._core.reference(SCENES[name], 24, 1e-20, 10_000)
        motion = ph.solve(SCENES[name], method="taylor", rtol=1e-15)
        assert motion.plan.method == "taylor" and distance(motion, (omega, attitude)) < 3e-13


def test_the_reference_refuses_a_users_own():
    with pytest.raises(ph.InvalidInput, match="no series"):
        ph._core.reference(SCENES["a user's own"], 24, 1e-20, 1000)


# ---- what answers each piece


def test_a_free_body_coasts_by_its_closed_form():
    plan = ph.plan(SCENES["a body without symmetry"], 1e-9)
    assert [(p.begin, p.end, p.model, p.torques) for p in plan.pieces] == [
        (0, 10, "euler", ("Constant",)), (10, 30, "triaxial", ()), (30, 40, "euler", ("Constant",)),
        (40, 60, "triaxial", ())]
    assert plan.model == "pieces" and plan.method == plan.pieces[0].method != "exact"
    text = str(plan)
    assert "cut there into 4 pieces" in text and "triaxial, closed form" in text and "Constant during 2 windows" in text
    kept = json.loads(json.dumps(plan.as_dict()))
    assert len(kept["pieces"]) == 4 and kept["pieces"][1]["method"] == "exact"
    motion = ph.solve(plan.scene, plan=plan)
    assert motion.plan.pieces[1] == plan.pieces[1] and motion.success
    assert np.array_equal(motion.omega, ph.solve(plan.scene, accuracy=1e-9).omega)


def test_each_piece_has_the_model_that_holds_there():
    top = ph.plan(SCENES["let go"], 1e-9)
    assert [p.model for p in top.pieces] == ["symmetric", "heavy_top", "symmetric"] and top.method == "exact"
    resting = ph.plan(scene(During(FIRING, [(10, 20)]), omega=(0, 0, 0)), 1e-9)
    assert [p.model for p in resting.pieces] == ["rest", "euler", "triaxial"]
    spun = ph.plan(scene(During(Constant((0, 0, 0.1)), [(10, 20)]), omega=(0, 0, 1)), 1e-9)
    assert [p.model for p in spun.pieces] == ["steady", "euler", "steady"]
    stiff = ph.plan(scene(During(Damping((3e4, 0.01, 0.01)), [(10, 30)]), Gravity(0.3, (0.1, 0.2, 0.3))), 1e-6)
    assert [p.method for p in stiff.pieces] == ["taylor", "radau", "taylor"]


def test_exact_where_every_piece_has_a_closed_form():
    motion = ph.solve(SCENES["let go"], accuracy=1e-10, method="exact")
    assert motion.plan.method == "exact" and motion.stats["steps"] == 0 and motion.error_kind == "bounded"
    with pytest.raises(ph.InvalidInput, match="with pieces that all have a closed form") as refused:
        ph.solve(SCENES["a body without symmetry"], method="exact")
    assert "from t = 0 to 10 s" in str(refused.value)


def test_windows_all_outside_leave_a_free_body():
    away = scene(During(FIRING, [(100, 200), (-20, -10)]))
    motion, free = ph.solve(away, accuracy=1e-12), ph.FreeMotion(BLOCK, (0.1, 0.2, 0.3))
    assert motion.plan.model == "triaxial" and motion.plan.pieces == ()
    np.testing.assert_array_equal(motion.omega, free.at(away.times)[0])
    never = During(FIRING, [])
    assert never.windows == () and ph.solve(scene(never), accuracy=1e-12).plan.model == "triaxial"
    always = ph.solve(scene(During(FIRING, [(-INF, INF)])), accuracy=1e-9)
    np.testing.assert_array_equal(always.omega, ph.solve(scene(FIRING), accuracy=1e-9).omega)
    assert ph.plan(scene(During(FIRING, [(-1, 61)])), 1e-9).pieces == ()


def test_a_long_coast_costs_nothing_and_keeps_its_digits():
    turns, period = 1e5, 2 * math.pi / np.linalg.norm((1, 2, 3))
    end = 10 + turns * period
    firings = During(Constant((0.02, -0.01, 0.03)), [(0, 10), (end, end + 10)])
    long = scene(firings, omega=(1, 2, 3), times=[0.0, 10.0, end, end + 10])
    short = scene(During(firings.torque, [(0, 10), (20, 30)]), omega=(1, 2, 3), times=[0.0, 10.0, 20.0, 30.0])
    motion, other = ph.solve(long, accuracy=1e-6), ph.solve(short, accuracy=1e-6)
    assert motion.success and motion.stats["steps"] < 5 * other.stats["steps"]
    coasted = ph.FreeMotion(BLOCK, motion.omega[1], attitude=motion.attitude[1]).at([end - 10.0])
    assert distance(motion, (np.array([motion.omega[0], motion.omega[1], coasted[0][0], motion.omega[3]]),
                             np.array([motion.attitude[0], motion.attitude[1], coasted[1][0],
                                       motion.attitude[3]]))) < 1e-12


# ---- the joined motion is one motion


@pytest.mark.parametrize("how", [{"accuracy": 1e-10}, {"method": "dop853", "rtol": 1e-12},
                                 {"method": "taylor", "rtol": 1e-14}], ids=str)
def test_dense_output_and_events_go_across_the_joints(how):
    common = SCENES["backwards too"]
    def across(t, w, q):
        return q[0] * q[1] + q[2] * q[3] - 0.1

    seen = ph.Event(across)
    motion = ph.solve(common, dense=True, events=[seen], **how)
    fine = common.replace(times=np.linspace(-30, 30, 481))
    answer = ph.solve(fine, method="dop853", rtol=1e-13)
    omega, attitude = motion(fine.times)
    assert np.abs(omega - answer.omega).max() < 1e-8
    assert np.abs(np.abs(np.sum(attitude * answer.attitude, axis=1)) - 1).max() < 1e-8
    with pytest.raises(ph.InvalidInput, match="between -30 and 30"):
        motion(31.0)
    signs = np.sign([across(0, None, q) for q in answer.attitude])
    assert len(motion.events) == np.count_nonzero(signs[1:] != signs[:-1]) > 3
    times = [hit.t for hit in motion.events]
    back = [t for t in times if t < 0]
    assert times == sorted(back, reverse=True) + sorted(t for t in times if t >= 0)   # in the order of the integration
    assert max(abs(across(hit.t, hit.omega, hit.attitude)) for hit in motion.events) < 1e-9


def test_a_terminal_event_ends_all():
    end = ph.Event(lambda t, w, q: t - 35.0, terminal=True)
    for how in ({"accuracy": 1e-9}, {"method": "rk45", "rtol": 1e-9}):
        motion = ph.solve(SCENES["a body without symmetry"], events=[end], dense=True, **how)
        assert motion.status == "event" and motion.t[-1] == 35.0 and len(motion.events) == 1 and motion.success
        assert motion(34.9)[0].shape == (3,)
    coasting = ph.Event(lambda t, w, q: t - 25.5, terminal=True)
    motion = ph.solve(SCENES["a body without symmetry"], accuracy=1e-9, events=[coasting])
    assert motion.status == "event" and motion.t[-1] == 25.0 and motion.events[0].t == pytest.approx(25.5)


def test_an_event_at_an_edge_is_found_once():
    at_edge = ph.Event(lambda t, w, q: t - 30.0)
    assert ([hit.t for hit in ph.solve(SCENES["a body without symmetry"], accuracy=1e-9, events=[at_edge]).events]
            == [30.0])


def test_max_steps_counts_all_pieces():
    whole = ph.solve(SCENES["two thrusters"], method="rk45", rtol=1e-9)
    motion = ph.solve(SCENES["two thrusters"], method="rk45", rtol=1e-9, max_steps=whole.stats["steps"] - 10)
    assert motion.status == "max_steps" and 30 < motion.t[-1] < 60
    assert motion.stats["steps"] == whole.stats["steps"] - 10
    assert f"max_steps = {whole.stats['steps'] - 10} steps" in motion.message
    np.testing.assert_array_equal(motion.omega, whole.omega[:len(motion)])


def test_a_progress_callback_ends_a_chain():
    windows = [(i, i + 0.5) for i in range(20000)]
    many = scene(During(Constant((1e-6, 0, 0)), windows), times=[0.0, 20000.0])
    reached = []
    motion = ph.solve(many, method="rk45", rtol=1e-9, progress=lambda t, last: bool(reached.append((t, last))))
    assert motion.status == "stopped" and reached == [(pytest.approx(reached[0][0]), 20000.0)]
    assert 0 < reached[0][0] < 20000


def test_a_torque_that_breaks_keeps_what_was_reached():
    broken = Custom(lambda t, w, q: (math.inf if t > 22 else 0.01, 0, 0), uses_attitude=False)
    motion = ph.solve(scene(During(broken, [(10, 40)])), method="dop853", rtol=1e-9)
    assert motion.status == "failed" and 20 <= motion.t[-1] <= 22


def test_a_function_is_called_within_its_windows_alone():
    called = []

    def thruster(t, omega, attitude):
        called.append(t)
        return (0.01, 0, 0)

    for how in ({"accuracy": 1e-8}, {"method": "rk45", "rtol": 1e-8}):
        ph.solve(scene(During(Custom(thruster, uses_rates=False), [(10, 20), (30, 35)])), **how)
    edge = 1e-12   # the certificate moves the windows' ends too
    assert called and all(10 - edge <= t <= 20 + edge or 30 - edge <= t <= 35 + edge for t in called)


def test_a_false_claim_is_found_in_its_window():
    liar = Custom(lambda t, w, q: (0.1 * w[0], 0, 0), uses_rates=False)
    with pytest.raises(ph.InvalidInput, match="uses_rates"):
        ph.solve(scene(During(liar, [(10, 20)])), accuracy=1e-8)


def test_only_rates_are_carried_where_nothing_sees_the_attitude():
    rates = SCENES["a body without symmetry"].replace(want=["omega"])
    motion = ph.solve(rates, accuracy=1e-9)
    assert motion.attitude is None and motion.plan.state == "omega"
    np.testing.assert_allclose(motion.omega, ph.solve(SCENES["a body without symmetry"], accuracy=1e-9).omega,
                               atol=1e-9)
    seen = ph.solve(SCENES["a body without symmetry"].replace(want=["attitude"]), accuracy=1e-9)
    assert seen.omega is None and seen.success


def test_an_edge_belongs_to_the_step_before_it():
    """A fixed step is counted from each piece's start, and the edge is a step's end."""
    motion = ph.solve(scene(During(FIRING, [(10.05, 20)]), times=[0.0, 30.0]), method="rk4", step=0.1)
    assert motion.stats["steps"] == 101 + 100 + 100


def test_certify_false_says_expected():
    motion = ph.solve(SCENES["two thrusters"], accuracy=1e-8, certify=False)
    assert motion.error_kind == "expected" and motion.success and motion.stats["runs"] == 1


def test_what_float64_cannot_hold_is_a_limit():
    end = 1e9
    coast = scene(During(FIRING, [(0, 10)]), omega=(1, 2, 3), times=np.linspace(0, end, 11))
    motion = ph.solve(coast, accuracy=1e-12)
    assert motion.error_kind == "limit" and not motion.success and motion.error > 1e-9


@pytest.mark.parametrize("scale", [1e-12, 1e12])
def test_time_scales_away(scale):
    """Times by s, omega by 1/s, torques by 1/s^2: the same motion, step by step."""
    s = 2.0 ** round(math.log2(scale))
    common = scene(During(FIRING, [(3.3, 10), (30, 40)]), Gravity(0.3, (0.1, 0.2, 0.3)))
    times = np.array(common.times)
    torques = [During(Constant(FIRING.torque / s**2), [(3.3 * s, 10 * s), (30 * s, 40 * s)]),
               Gravity(0.3 / s**2, (0.1, 0.2, 0.3))]
    scaled = scene(*torques, omega=np.array((0.1, 0.2, 0.3)) / s, times=times * s)
    for how in ({"accuracy": 1e-9}, {"method": "dop853", "rtol": 1e-10}):
        a, b = ph.solve(common, **how), ph.solve(scaled, **how)
        np.testing.assert_allclose(a.omega, b.omega * s, rtol=1e-7, atol=1e-9)
        assert a.plan.method == b.plan.method and b.status == "finished"


def test_the_energy_is_that_of_what_acts():
    motion = ph.solve(SCENES["let go"], accuracy=1e-10)
    kinetic = 0.5 * (motion.omega**2 * (1, 1, 0.5)).sum(axis=1)
    height = np.array([2 * vertical(q)[2] for q in motion.attitude])
    on = (motion.t >= 5) & (motion.t < 25)
    np.testing.assert_allclose(motion.energy, kinetic + np.where(on, height, 0), rtol=1e-12)
    assert "energy" not in motion.drift and motion.drift["vertical_momentum"] < 1e-9


def test_solve_many_takes_windows():
    firing = scene(During(FIRING, [(0, 10), (30, 40)]), times=np.linspace(0, 50, 6))
    starts = np.array([(0.1, 0.2, 0.3), (0.3, -0.2, 0.1), (0, 0, 0.5)])
    motions = ph.solve_many(firing, omega=starts, method="taylor", rtol=1e-12)
    assert not motions.lanes.any() and motions.success.all()
    for i, start in enumerate(starts):
        one = ph.solve(firing.replace(omega=start), method="taylor", rtol=1e-12)
        np.testing.assert_array_equal(motions.omega[i], one.omega)
    mixed = ph.solve_many([firing, firing.replace(torques=[FIRING])], method="taylor", rtol=1e-12)
    assert mixed.lanes.tolist() == [False, True]
    np.testing.assert_allclose(mixed.omega[1], ph.solve(firing.replace(torques=[FIRING]), rtol=1e-12,
                                                        method="taylor").omega, atol=1e-10)


def test_what_a_method_refuses_is_refused_with_its_piece():
    gradients = scene(During(GravityGradient(1e-3), [(0, 20)]), During(GravityGradient(2e-3), [(10, 30)]))
    with pytest.raises(ph.InvalidInput, match="gravity gradients of two orbits.*from t = 10 to 20 s"):
        ph.solve(gradients, method="taylor", rtol=1e-9)
    apart = scene(During(GravityGradient(1e-3), [(0, 10)]), During(GravityGradient(2e-3), [(10, 30)]))
    assert ph.solve(apart, method="taylor", rtol=1e-9).status == "finished"


def test_a_torque_that_acts_on_a_body_that_has_come_to_rest():
    """Braked to nothing, then let go under its weight: the first step is not chosen by rates that are gone."""
    braked = scene(During(Damping((1, 1, 1)), [(0, 40)]), During(Gravity(0.3, (0.1, 0.2, 0.3)), [(38, 60)]),
                   attitude=TILTED)
    motion = ph.solve(braked, accuracy=1e-6)
    assert motion.success, motion.message
    assert distance(motion, ph._core.reference(braked, 26, 1e-21, 100_000)[:2]) <= motion.error


def test_the_reference_keeps_two_orbits_apart():
    """It gave neither when both shared their series: seen by windowed scenes drawn at random."""
    two = scene(During(GravityGradient(0.3), [(5, 40)]), During(GravityGradient(0.1, 0.7), [(20, 60)]))
    omega, attitude, _ = ph._core.reference(two, 24, 1e-20, 10_000)
    assert distance(ph.solve(two, method="dop853", rtol=1e-13), (omega, attitude)) < 1e-10
