"""Bodies that change, against mpmath and against laws that hold for them."""

import json
import math
import pathlib
import pickle

import numpy as np
import pytest

import polhode as ph

REFERENCE = json.loads((pathlib.Path(__file__).parents[2] / "reference/changing.json").read_text(encoding="utf-8"))
BEFORE = [[2.0, 0.1, -0.2], [0.1, 2.5, 0.05], [-0.2, 0.05, 1.7]]
AFTER = [[3.1, -0.1, 0.3], [-0.1, 2.9, 0.2], [0.3, 0.2, 3.4]]
KICKED = [[1.2, 0.15, 0.1], [0.15, 1.9, -0.1], [0.1, -0.1, 1.5]]
SPIN = (0.9, -0.7, 1.3)
INFINITY = math.inf

PARTS_MOVE = ph.Changing([(0, 2, [(0, 0.2, 0), (0.3, 0, -0.4), (0, -0.1, 0.15)])], after=(0.1, 0.2, -0.3))
KICKS = ph.Changing([(1, 3, [KICKED])], before=BEFORE, after=AFTER)
TABLE = ph.Changing.table((0, 1, 3, 4), [(2.0, 2.5, 1.7), (2.2, 2.4, 1.9), (2.9, 2.6, 2.6), (3.0, 3.0, 2.5)])
DEPLOYED = ph.Changing.ramp(BEFORE, AFTER, (1, 3))
EMPTIED = ph.Changing.ramp(AFTER, KICKED, (1, 3), order=1)

CASES = {
    "linear": dict(inertia=ph.Changing.ramp(BEFORE, AFTER, (1, 3), order=1), omega=SPIN),
    "smooth": dict(inertia=DEPLOYED, omega=SPIN),
    "cubic on axes": dict(inertia=ph.Changing.ramp((2, 2.5, 1.7), (3, 3.2, 3.5), (1, 3), order=3),
                          omega=(0.2, 1.1, 0.1)),
    "table": dict(inertia=TABLE, omega=(0.4, 1.2, -0.6)),
    "kick": dict(inertia=KICKS, omega=(0.1, 2.2, 0.3)),
    "moving parts": dict(inertia=BEFORE, momentum=PARTS_MOVE, omega=(0.5, 0.3, -0.8)),
    "cat": dict(inertia=BEFORE, momentum=PARTS_MOVE, omega=(0, -0.08, 0)),
    "leaving": dict(inertia=EMPTIED, omega=SPIN, leaving=True),
    "rocket": dict(inertia=EMPTIED, omega=SPIN, leaving=True, torques=[ph.torques.Constant((0.1, -0.2, 0.3))]),
    "driven": dict(inertia=DEPLOYED, omega=(0.3, 0.2, -0.5),
                   torques=[ph.torques.GravityGradient(0.8), ph.torques.Damping((0.1, 0.1, 0.1)),
                            ph.torques.Constant((0.05, 0.0, -0.1), frame="space")]),
}
CLOSED = ("linear", "smooth", "cubic on axes", "table", "kick", "moving parts", "cat")


def make(name, times=None, **more):
    return ph.Scene(**{"times": REFERENCE[name]["t"] if times is None else times, **CASES[name], **more})


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("name", CASES)
def test_motions_are_those_of_the_angular_momentum(name, accuracy):
    motion = ph.solve(make(name), accuracy=accuracy)
    y = np.array([[float(value) for value in row] for row in REFERENCE[name]["y"]])
    assert motion.success and motion.error_kind == "bounded" and motion.error <= accuracy
    assert np.linalg.norm(motion.omega - y[:, :3], axis=1).max() <= max(motion.error, 2e-15) * motion.omega_scale
    assert np.abs(motion.attitude - y[:, 3:]).max() <= max(motion.error, 2e-15)


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("name", CLOSED)
def test_the_angular_momentum_in_space_stays(name, accuracy):
    motion = ph.solve(make(name, np.linspace(0, 4, 81)), accuracy=accuracy)
    assert motion.success and motion.drift["angular_momentum"] <= 1e-13


@pytest.mark.parametrize("name", ["kick", "moving parts"])
def test_pieces_without_change_have_their_closed_forms(name):
    plan = ph.plan(make(name))
    constant = [piece for piece in plan.pieces if piece.model != "changing"]
    assert {piece.method for piece in constant} == {"exact"}
    assert [piece.model for piece in plan.pieces] == {
        "kick": ["triaxial"] * 3, "moving parts": ["changing", "gyrostat"]}[name]
    assert ("momentum" in plan.pieces[-1].torques) == (name == "moving parts")


def test_plans_name_the_torques_of_the_scene():
    plan = ph.plan(make("driven"))
    assert all(piece.torques == ("GravityGradient", "Damping", "Constant") for piece in plan.pieces)


def test_a_kick_keeps_the_angular_momentum_and_a_sample_on_it_has_the_rates_after_it():
    scene = make("kick", (0.0, math.nextafter(1.0, 0.0), 1.0))
    motion = ph.solve(scene, accuracy=1e-12)
    before, after = motion.omega[1:]
    assert np.abs(np.array(KICKED) @ after - np.array(BEFORE) @ before).max() <= 1e-14
    assert np.abs(after - before).max() > 0.1
    leaving = ph.solve(scene.replace(leaving=True), accuracy=1e-12)
    assert np.abs(leaving.omega[2] - leaving.omega[1]).max() <= 1e-14


@pytest.mark.parametrize("name", ["kick", "smooth", "moving parts", "rocket"])
def test_a_motion_runs_back_to_its_start(name):
    scene = make(name, (0.0, 0.7, 1.0, 2.0, 3.5, 4.0))
    there = ph.solve(scene, accuracy=1e-12)
    back = ph.solve(scene.replace(t0=4.0, omega=there.omega[-1], attitude=there.attitude[-1]), accuracy=1e-12)
    assert back.success and np.abs(back.omega - there.omega).max() <= 3e-12
    assert np.abs(back.attitude - there.attitude).max() <= 3e-12


def test_a_symmetric_body_that_grows_has_two_quadratures():
    """With equal moments A(t), C(t) about z: H3 is constant, and the others turn by the angle of H3 (1/C - 1/A)."""
    A, C, t, w = (2.0, 3.0), (1.0, 2.5), 4.0, np.array([0.3, -0.2, 0.9])
    boom = ph.Changing.ramp((A[0], A[0], C[0]), (A[1], A[1], C[1]), (0, t), order=1)
    motion = ph.solve(ph.Scene(inertia=boom, omega=w, times=[t]), accuracy=1e-12)

    def quadrature(m):   # of dt / m(t), m linear
        return t / (m[1] - m[0]) * math.log(m[1] / m[0])

    H3 = C[0] * w[2]
    angle = H3 * (quadrature(C) - quadrature(A))
    across = A[0] / A[1] * np.array([math.cos(angle) * w[0] + math.sin(angle) * w[1],
                                     math.cos(angle) * w[1] - math.sin(angle) * w[0]])
    assert np.abs(motion.omega[0] - [*across, H3 / C[1]]).max() <= 3e-15


def test_a_cat_turns_without_angular_momentum():
    """Parts that circle turn the body by an angle of second order, and it ends at rest."""
    turn, size = 2 * math.pi, 0.5

    up = 4 * size * np.array([(0, 0, 0), (1, 0, 0), (-1, 0, 0)])
    loop = [(i, i + 1, (1 - 2 * (i // 2)) * np.roll(up, i % 2, axis=1)) for i in range(4)]
    cat = ph.Scene(inertia=(1.0, 1.2, 1.5), omega=(0, 0, 0), momentum=ph.Changing(loop), times=np.linspace(0, 4, 41))
    motion = ph.solve(cat, accuracy=1e-12)
    assert motion.success and np.abs(motion.angular_momentum).max() <= 1e-15
    assert np.abs(motion.omega[-1]).max() <= 1e-15 and turn > 2 * math.acos(abs(motion.attitude[-1, 3])) > 0.05


def test_the_energy_is_that_of_the_body_that_turns():
    motion = ph.solve(make("smooth"), accuracy=1e-12)
    J, w = DEPLOYED.at(motion.t), motion.omega
    assert np.abs(motion.energy - 0.5 * np.einsum("ni,nij,nj->n", w, J, w)).max() <= 1e-15


def test_torques_see_the_inertia_of_the_time():
    scene, q = make("driven"), (0.0, 0.0, 0.0, 1.0)
    n, J = 0.8, DEPLOYED.at(2.0)
    gradient = scene.replace(torques=scene.torques[:1])
    u = np.array([math.cos(2 * n), math.sin(2 * n), 0])
    assert np.abs(gradient.torque(2.0, (0, 0, 0), q) - 3 * n**2 * np.cross(u, J @ u)).max() <= 1e-14
    damped = scene.replace(torques=[ph.torques.AngularDamping(0.1)])
    assert np.abs(damped.torque(2.0, SPIN, q) + 0.1 * J @ SPIN).max() <= 1e-14


def test_a_formula_that_is_a_torque_of_the_list_at_one_time_stays_a_formula():
    c = 0.1 * np.array(BEFORE)
    formula = ph.torques.Formula(lambda t, omega, attitude, p: -(c @ omega))
    a = ph.solve(make("smooth", torques=[formula]), accuracy=1e-10)
    b = ph.solve(make("smooth", torques=[ph.torques.Damping(c)]), accuracy=1e-10)
    assert a.success and np.abs(a.omega - b.omega).max() <= 1e-10


@pytest.mark.parametrize("more", [
    dict(rotors=[ph.Rotor((1, 2, 2), momentum=0.9)]),
    dict(rotors=[ph.Rotor((1, 2, 2), momentum=0.9, during=(0.5, 2.0))]),
    dict(rotors=[ph.Rotor((1, 2, 2), inertia=0.1, speed=8.0, free=True)]),
    dict(rotors=[ph.Rotor((1, 2, 2), inertia=0.1, speed=8.0, free=True, torque=0.1, viscous=0.01)]),
    dict(rotors=[ph.Rotor((1, 2, 2), inertia=0.1, speed=1.0, free=True, coulomb=0.1)]),
    dict(damper=ph.Damper(inertia=0.2, viscous=0.1)),
    dict(momentum=PARTS_MOVE, rotors=[ph.Rotor((0, 1, 0), momentum=-0.5)]),
])
def test_rotors_and_a_damper_turn_in_a_body_that_changes(more):
    scene = make("smooth", np.linspace(0, 4, 41), **more)
    motions = [ph.solve(scene, accuracy=accuracy) for accuracy in (1e-6, 1e-9, 1e-12)]
    for motion in motions:
        assert motion.success and motion.drift["angular_momentum"] <= 1e-13
        apart = np.linalg.norm(motion.omega - motions[-1].omega, axis=1).max() / motion.omega_scale
        assert apart <= motion.error + motions[-1].error


def test_a_held_rotor_is_a_constant_momentum():
    wheel = make("smooth", rotors=[ph.Rotor((0, 1, 0), momentum=0.9)])
    inside = make("smooth", momentum=ph.Changing([(-INFINITY, INFINITY, [(0, 0.9, 0)])]))
    a, b = ph.solve(wheel, accuracy=1e-12), ph.solve(inside, accuracy=1e-12)
    assert np.abs(a.omega - b.omega).max() <= 1e-13


@pytest.mark.parametrize("method", ["taylor", "dop853", "rk45", "radau"])
def test_other_methods_integrate_bodies_that_change(method):
    scene = make("driven")
    best, motion = ph.solve(scene, accuracy=1e-12), ph.solve(scene, method=method, accuracy=1e-8)
    assert motion.success and np.abs(motion.omega - best.omega).max() <= motion.error * motion.omega_scale + 1e-12


def test_a_function_of_the_users_own_acts():
    push = ph.torques.Custom(lambda t, omega, attitude: (0.1, -0.2, 0.3))
    motion = ph.solve(make("rocket", torques=[push]), accuracy=1e-9)
    assert motion.success and np.abs(motion.omega - ph.solve(make("rocket"), accuracy=1e-12).omega).max() <= 1e-8


@pytest.mark.parametrize("name", ["smooth", "kick", "driven"])
def test_dense_output_and_events_cross_the_pieces(name):
    scene = make(name, np.linspace(0, 4, 9))
    motion = ph.solve(scene, accuracy=1e-9, dense=True)
    omega, attitude = motion(scene.times)
    assert np.abs(omega - motion.omega).max() <= 1e-8 and np.abs(attitude - motion.attitude).max() <= 1e-8
    found = ph.solve(scene, accuracy=1e-9, events=[ph.Event(lambda t, w, q: t - 2.2)])
    assert [round(event.t, 9) for event in found.events] == [2.2]


@pytest.mark.parametrize("name", CASES)
def test_scenes_survive_files_and_pickles(name, tmp_path):
    scene = make(name)
    scene.save(tmp_path / "scene.toml")
    back = ph.Scene.load(tmp_path / "scene.toml")
    assert back == scene and pickle.loads(pickle.dumps(scene)) == scene and scene.replace(name="other") != scene
    motion = ph.solve(scene, accuracy=1e-9)
    assert (ph.solve(back, accuracy=1e-9).omega == motion.omega).all()
    motion.save(tmp_path / "motion.npz")
    assert ph.load(tmp_path / "motion.npz").scene == scene


def test_a_file_has_pieces(tmp_path):
    path = tmp_path / "boom.toml"
    path.write_text("""
        [body]
        leaving = true
        pieces = [
          { from = -inf, to = 1, inertia = [[[1, 0, 0], [0, 2, 0], [0, 0, 2.5]]], momentum = [[0, 0, 0.1]] },
          { from = 1, to = 2, inertia = [[[1, 0, 0], [0, 2, 0], [0, 0, 2.5]],
                                            [[0.1, 0.2, 0], [0.2, 0, 0], [0, 0, 0.1]]] },
          { from = 1, to = 2, momentum = [[0, 0, 0]] },
        ]
        [start]
        omega = [1, 1, 1]
        [times]
        values = [0.5, 2.0]
        """, encoding="utf-8")
    scene = ph.Scene.load(path)
    assert scene.leaving and scene.changing.at(2.0).tolist() == [[1.1, 0.2, 0], [0.2, 2, 0], [0, 0, 2.6]]
    assert scene.momentum.at([0.0, 1.0]).tolist() == [[0, 0, 0.1], [0, 0, 0]]
    for wrong in ("moments = [1, 2, 2.5]", "shape = 'ball'"):
        path.write_text(path.read_text(encoding="utf-8").replace("leaving = true", wrong), encoding="utf-8")
        with pytest.raises(ph.InvalidInput, match=r"beside pieces with an inertia"):
            ph.Scene.load(path)
        path.write_text(path.read_text(encoding="utf-8").replace(wrong, "leaving = true"), encoding="utf-8")


def test_many_bodies_change_alike():
    scene, starts = make("smooth"), [(1.0, 0.2, 0.3), (0.1, 0.2, 0.9)]
    many = ph.solve_many(scene, omega=starts)
    for omega, found in zip(starts, many.omega):
        assert (found == ph.solve(scene.replace(omega=omega)).omega).all()
    with pytest.raises(ph.InvalidInput, match="a scene whose inertia changes"):
        ph.solve_many(scene, omega=starts, inertia=[(1, 2, 2.5), (1, 2, 2.6)])


def scene_of(inertia, **more):
    return ph.Scene(**{"inertia": inertia, "omega": SPIN, "times": (0, 4), **more})


BOX = (1.0, 2.0, 2.5)
WRONG = {
    "Changing.pieces: .* none": lambda: ph.Changing([]),
    "ends at 1 s, got a begin at 2 s": lambda: ph.Changing([(0, 1, [BOX]), (2, 3, [BOX])]),
    "ends at 1 s, got a begin at 0.5 s": lambda: ph.Changing([(0, 1, [BOX]), (0.5, 3, [BOX])]),
    "an end after its begin, got 1 to 0": lambda: ph.Changing([(1, 0, [BOX])]),
    "an end after its begin, got nan": lambda: ph.Changing([(math.nan, 0, [BOX])]),
    "finite, got nan": lambda: ph.Changing([(0, 1, [(1, 2, math.nan)])]),
    "at least one term": lambda: ph.Changing([(0, 1, [])]),
    "of one shape in all pieces": lambda: ph.Changing([(0, 1, [BOX]), (1, 2, [BEFORE])]),
    "not constant, got 0 to inf": lambda: ph.Changing([(0, INFINITY, [BOX, BOX])]),
    "symmetric, got 4 and 2": lambda: ph.Changing([(0, 1, [[[1, 2, 3], [4, 5, 6], [7, 8, 9]]])]),
    "before: .* no begin": lambda: ph.Changing([(-INFINITY, 1, [BOX])], before=BOX),
    "ramp.times": lambda: ph.Changing.ramp(BOX, BOX, (3, 3)),
    "order: must be 1, 3 or 5, got 4": lambda: ph.Changing.ramp(BOX, BOX, (0, 1), order=4),
    "at least two times, got 1": lambda: ph.Changing.table((0,), [BOX]),
    "above the one before": lambda: ph.Changing.table((0, 0), [BOX, BOX]),
    "a value for each of 2 times": lambda: ph.Changing.table((0, 1), [BOX]),
    "t: must be between 0 and 1, got 2": lambda: ph.Changing([(0, 1, [BOX])]).at(2.0),
    # 2 - 2 t + 0.4 t^2 is 0 at 1.38197 and 3.61803: both ends are those of a body.
    "positive definite at all times, .* at t = 1.3819": lambda: scene_of(
        ph.Changing([(0, 4, [(2, 2, 2), (-2, 0, 0), (0.4, 0, 0)])], physical=False)),
    # 3 = 1 + 2 is passed at t = 0.5 / 3.25.
    "a body's tensor at all times, .* at t = 0.1538": lambda: scene_of(
        ph.Changing.ramp(BOX, (1, 2, 9), (0, 2), order=1)),
    "pieces from 0 to 4 s, got 0 to 2 s": lambda: scene_of(ph.Changing([(0, 2, [BOX])])),
    "momentum: must be of three numbers": lambda: scene_of(BOX, momentum=DEPLOYED),
    "momentum: must be a polhode.Changing": lambda: scene_of(BOX, momentum=(1, 2, 3)),
    "leaving: must be left out": lambda: scene_of(BOX, leaving=True),
    "rotors and a damper take": lambda: scene_of(ph.Changing([(0, 2, [(3, 3, 3)]), (2, 4, [BOX])]), rotors=[
        ph.Rotor((1, 0, 0), inertia=1.5, speed=1.0, free=True)]),
    "certify: .* a body that changes": lambda: ph.solve(make("smooth"), certify="proof"),
    "lyapunov: .* one that changes": lambda: ph.lyapunov(make("smooth")),
    "scene: .* one that changes": lambda: ph.fit({"t": [0.0, 1.0], "omega": [SPIN, SPIN]}, scene=make("smooth")),
}


@pytest.mark.parametrize("message", WRONG)
def test_what_is_wrong_is_refused(message):
    with pytest.raises(ph.InvalidInput, match=message):
        WRONG[message]()


def test_a_moment_may_touch_what_no_body_exceeds():
    """A flat body that grows: c = a + b at all times, to the last bits."""
    flat = ph.Changing.ramp((0.1, 0.2, 0.1 + 0.2), (0.7, 0.1, 0.7 + 0.1), (0, 3))
    assert ph.solve(scene_of(flat), accuracy=1e-9).success


def test_the_effect_of_a_torque_is_refused():
    assert "the body changes" in ph.effect(make("rocket"), torque=0).reason


@pytest.mark.parametrize("name, column", [
    ("smooth", "omega"), ("smooth", "attitude"), ("kick", "omega"), ("moving parts", "omega"), ("leaving", "omega"),
    ("driven", "torques.0.mean_motion"), ("driven", "torques.1.matrix"), ("driven", "torques.2.torque"),
    ("driven", "attitude"), ("rocket", "torques.0.torque")])
def test_columns_are_differences(name, column):
    scene = make(name)
    found = ph.solve(scene, accuracy=1e-10, sensitivity=[column]).sensitivity
    step = 1e-5

    def solve(change):
        parts = {}
        if column == "omega":
            parts["omega"] = scene.omega + [change, 0, 0]
        elif column == "attitude":
            parts["attitude"] = np.array([math.sin(change / 2), 0, 0, math.cos(change / 2)])
        else:
            torques = list(scene.torques)
            number = int(column.split(".")[1])
            own = torques[number]
            torques[number] = {
                "GravityGradient": lambda: ph.torques.GravityGradient(0.8 + change),
                "Damping": lambda: ph.torques.Damping(np.diag([0.1 + change, 0.1, 0.1])),
                "Constant": lambda: ph.torques.Constant(own.torque + [change, 0, 0], frame=own.frame),
            }[type(own).__name__]()
            parts["torques"] = torques
        return ph.solve(scene.replace(**parts), accuracy=1e-12)

    up, down = solve(step), solve(-step)
    differences = (up.omega - down.omega) / (2 * step)
    assert np.abs(found.d_omega[:, :, 0] - differences).max() <= 1e-7 * max(1, np.abs(differences).max())


@pytest.mark.parametrize("column", ["inertia", "axes"])
def test_columns_by_a_body_that_changes_are_refused(column):
    with pytest.raises(ph.InvalidInput, match="by the start or by numbers of torques"):
        ph.solve(make("smooth"), sensitivity=[column])
    with pytest.raises(ph.InvalidInput, match="without rotors and damper"):
        ph.solve(make("smooth", rotors=[ph.Rotor((0, 1, 0), momentum=0.9)]), sensitivity=["omega"])


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-12])
def test_the_reference_scene_has_its_stored_truth(accuracy):
    from polhode._harness.truth import compute_errors, find_truth

    scene = ph.Scene.load("S14")
    motion, truth = ph.solve(scene, accuracy=accuracy), find_truth(scene)
    assert truth.kind == "stored" and motion.success
    assert compute_errors(motion.omega, motion.attitude, truth).largest <= motion.error + truth.uncertainty
