"""What is given at the doors: overlapping outputs, odd addresses, masks, wrong keywords, likely slips."""

import contextlib
import copy
import pathlib
import pickle
import warnings

import numpy as np
import pytest

import polhode as ph
from polhode import _core

BLOCK, OMEGA, HERE, TOP = (1, 2, 2.5), (1, 2, 3), (0, 0, 0, 1), (1, 1, 0.5)
RNG = np.random.default_rng(5)


# ---- outputs that overlap


def free(omega, attitude, t, **more):
    return ph.free_motion(BLOCK, omega, attitude, t, **more)


def top(omega, attitude, t, **more):
    return ph.heavy_top(TOP, 2.0, omega, attitude, t, **more)


@pytest.mark.parametrize("motion", [free, top])
def test_an_output_that_overlaps_the_times(motion):
    buffer = np.linspace(0, 9, 95)
    good = motion(OMEGA, HERE, buffer[:30].copy(), want="omega")
    assert (motion(OMEGA, HERE, buffer[:30], want="omega", out=buffer[:90].reshape(30, 3)) == good).all()
    assert (buffer[:90].reshape(30, 3) == good).all()
    buffer = np.linspace(0, 9, 95)   # the times lie within
    good = motion(OMEGA, HERE, buffer[40:70].copy(), want="omega")
    assert (motion(OMEGA, HERE, buffer[40:70], want="omega", out=buffer[:90].reshape(30, 3)) == good).all()


@pytest.mark.parametrize("motion", [free, top])
@pytest.mark.parametrize("shift", [0, 3, 4])
def test_an_output_that_overlaps_the_bodies(motion, shift):
    buffer = RNG.normal(size=3 * 40 + 4)
    omega = buffer[shift:shift + 120].reshape(40, 3)
    good = motion(omega.copy(), HERE, 2.5, want="omega")
    assert (motion(omega, HERE, 2.5, want="omega", out=buffer[:120].reshape(40, 3)) == good).all()
    buffer = np.tile((0.0, 0.6, 0.0, 0.8), 41)
    attitude = buffer[4:].reshape(40, 4)
    good = motion(OMEGA, attitude.copy(), 2.5, want="attitude")
    assert (motion(OMEGA, attitude, 2.5, want="attitude", out=buffer[:160].reshape(40, 4)) == good).all()


@pytest.mark.parametrize("times", [np.linspace(0, 5, 30), np.linspace(0, 5, 30)[:, None]])
def test_two_outputs_that_share_memory_are_refused(times):
    omega, attitude = ph.free_motion(BLOCK, np.array([OMEGA]) if times.ndim > 1 else OMEGA, HERE, times)
    buffer = np.zeros(4 * attitude[..., 0].size)
    out = buffer[:omega.size].reshape(omega.shape), buffer.reshape(attitude.shape)
    with pytest.raises(ph.InvalidInput, match="out: must be arrays apart"):
        ph.free_motion(BLOCK, np.array([OMEGA]) if times.ndim > 1 else OMEGA, HERE, times, out=out)


def test_the_bits_do_not_depend_on_where_an_output_lies():
    omega, times = RNG.normal(size=(20, 1, 3)), np.linspace(0, 5, 100)
    good = free(omega, HERE, times)
    plain = tuple(np.empty_like(part) for part in good)
    odd = tuple(odd_address(part) for part in good)
    for out in (plain, odd):
        for part, given, target in zip(good, free(omega, HERE, times, out=out), out, strict=True):
            assert given is target and (target == part).all()


# ---- odd addresses


def odd_address(array):
    """The same numbers at an address that is no multiple of eight."""
    array = np.asarray(array, np.float64)
    room = np.zeros(array.nbytes + 8, np.uint8)
    odd = room[1:1 + array.nbytes].view(np.float64).reshape(array.shape)
    odd[...] = array
    assert not odd.flags.aligned or array.size == 0
    return odd


Q = np.array((0.0, 0.6, 0.0, 0.8))
MATRIX = np.diag((1.0, 2.0, 2.5))
TETRAHEDRON = (np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]),
               np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
UNALIGNED = {
    "Scene": lambda a: ph.Scene(inertia=a(BLOCK), omega=a(OMEGA), attitude=a(Q), times=a([0, 1.0])).omega,
    "free_motion": lambda a: ph.free_motion(a(BLOCK), a(OMEGA), a(Q), a(np.linspace(0, 1, 300)))[0],
    "free_motion, bodies": lambda a: ph.free_motion(a([BLOCK] * 9), a([OMEGA] * 9), a([Q] * 9), a(np.arange(9.0)))[1],
    "heavy_top": lambda a: ph.heavy_top(a([TOP] * 9), a(2.0), a([OMEGA] * 9), a([Q] * 9), a(np.arange(9.0)))[1],
    "FreeMotion": lambda a: ph.FreeMotion(a(BLOCK), a(OMEGA), a(Q)).at(a(np.linspace(0, 1, 300)))[1],
    "polhode": lambda a: ph.FreeMotion(a(BLOCK), a(OMEGA), a(Q)).polhode(a(np.linspace(0, 1, 300))),
    "HeavyTop": lambda a: ph.HeavyTop(a(TOP), a(2.0), a(OMEGA), a(Q)).at(a(np.linspace(0, 1, 300)))[1],
    "solve_many": lambda a: ph.solve_many(ph.Scene(inertia=BLOCK, omega=OMEGA, times=[1.0]), inertia=a([BLOCK] * 9),
                                          omega=a([OMEGA] * 9), attitude=a([Q] * 9), rtol=1e-9).omega,
    "motion(t)": lambda a: ph.solve(ph.Scene(inertia=BLOCK, omega=OMEGA, times=[1.0]), dense=True)(a([0.1, 0.2]))[0],
    "InertiaTensor": lambda a: ph.InertiaTensor(a(MATRIX)).rotated(a(Q)).matrix,
    "MassProperties": lambda a: ph.MassProperties(2.0, a(OMEGA), a(MATRIX)).about(a(BLOCK)).matrix,
    "from_points": lambda a: ph.MassProperties.from_points(a([1, 2, 3.0]), a(np.eye(3))).com,
    "from_mesh": lambda a: ph.MassProperties.from_mesh(a(TETRAHEDRON[0]), TETRAHEDRON[1], density=1.0).com,
    "mesh.report": lambda a: ph.mesh.report(a(TETRAHEDRON[0]), TETRAHEDRON[1])["high"],
    "principal_axes": lambda a: ph.inertia.principal_axes(a([MATRIX] * 9))[1],
    "check": lambda a: ph.inertia.check(a([MATRIX] * 9))[0],
    "Rotation": lambda a: ph.Rotation(a([Q] * 9)).as_euler("ZXZ"),
    "from_matrix": lambda a: ph.Rotation.from_matrix(a([np.eye(3)] * 9)).apply(a([OMEGA] * 9)),
    "from_euler": lambda a: ph.Rotation.from_euler("ZXZ", a([[0.1, 0.2, 0.3]] * 9)).as_quat(),
    "body_rates": lambda a: ph.body_rates("ZXZ", a([[0.1, 0.2, 0.3]] * 9), a([OMEGA] * 9)),
    "elliptic": lambda a: ph.elliptic.jacobi(a([0.1, 0.2]), a([0.3, 0.4]))[0],
    "a torque's answer": lambda a: ph.solve(ph.Scene(inertia=BLOCK, omega=OMEGA, times=[1.0], torques=[
        ph.torques.Custom(lambda t, w, q: a((0.1, 0.2, 0.3)))]), rtol=1e-9).omega,
    "shape": lambda a: ph.shapes.box(1.0, a(BLOCK)).inertia.matrix,
}


@pytest.mark.parametrize("name", UNALIGNED)
def test_arrays_at_odd_addresses(name):
    call = UNALIGNED[name]
    np.testing.assert_array_equal(call(odd_address), call(np.asarray))


def test_faces_at_odd_addresses():
    vertices, faces = TETRAHEDRON
    for kind in (np.int32, np.int64):
        room = np.zeros(faces.size * np.dtype(kind).itemsize + 8, np.uint8)
        odd = room[1:1 + faces.size * np.dtype(kind).itemsize].view(kind).reshape(faces.shape)
        odd[...] = faces
        assert ph.mesh.report(vertices, odd)["faces"] == 4


def test_the_core_gets_aligned_arrays_alone():
    """One conversion stands at every door of the bindings, and asks NumPy for aligned arrays."""
    odd = odd_address(OMEGA)
    given = _core.to_numbers(odd, "omega", (3,))
    assert given.flags.aligned and (given == odd).all() and not np.may_share_memory(given, odd)
    plain = np.array(OMEGA, float)
    assert np.may_share_memory(_core.to_numbers(plain, "omega", (3,)), plain)
    bindings = pathlib.Path(__file__).parents[3] / "python" / "bindings"
    asked = [line for file in bindings.glob("*.?pp") for line in file.read_text().splitlines() if "forcecast" in line]
    assert len(asked) == 1 and "NPY_ARRAY_ALIGNED_" in asked[0]


def test_the_quick_way_of_one_body_leaves_odd_addresses_to_the_other():
    """Its loads would be undefined behaviour, which the processor forgives and the sanitizer does not."""
    given = (np.array(BLOCK, float), np.array(OMEGA, float), np.array(Q), np.linspace(0, 1, 5))
    assert _core._free_motion_of_one(*given) is not None
    for i in range(4):
        odd = [odd_address(part) if i == k else part for k, part in enumerate(given)]
        assert _core._free_motion_of_one(*odd) is None


# ---- masks and memory

MASKED = np.ma.array([1.0, 777.0, 3.0], mask=[0, 1, 0])
MASKS = {
    "scene.omega": lambda: ph.Scene(inertia=BLOCK, omega=MASKED, times=[0]),
    "scene.times": lambda: ph.Scene(inertia=BLOCK, omega=OMEGA, times=MASKED),
    "inertia": lambda: ph.free_motion(MASKED, OMEGA, HERE, 1.0),
    "omega": lambda: ph.solve_many(ph.Scene(inertia=BLOCK, omega=OMEGA, times=[1]), omega=np.ma.stack([MASKED] * 2)),
    "t": lambda: ph.FreeMotion(BLOCK, OMEGA).at(MASKED),
    "rotvec": lambda: ph.Rotation.from_rotvec(MASKED),
    "mrp": lambda: ph.Rotation.from_mrp(MASKED),
    "Constant.torque": lambda: ph.torques.Constant(MASKED),
    "u": lambda: ph.elliptic.jacobi(MASKED, 0.5),
    "matrices": lambda: ph.inertia.principal_axes(np.ma.array(np.eye(3), mask=np.eye(3))),
    "faces": lambda: ph.mesh.report(np.eye(3), np.ma.array([[0, 1, 2]], mask=[[0, 1, 0]])),
}


@pytest.mark.parametrize("name", MASKS)
def test_masked_entries_are_refused(name):
    with pytest.raises(ph.InvalidInput, match=f"^{name}: must be without masked entries, got"):
        MASKS[name]()


def test_masked_arrays_without_a_masked_entry_are_taken():
    whole = np.ma.array([1.0, 2.0, 3.0], mask=False)
    assert (ph.Scene(inertia=BLOCK, omega=whole, times=[0]).omega == OMEGA).all()
    assert ph.free_motion(BLOCK, whole, HERE, 1.0, want="omega").shape == (3,)


HUGE = np.broadcast_to(1.0, 10**12)


@pytest.mark.parametrize("call", [
    lambda: ph.FreeMotion(BLOCK, OMEGA).at(HUGE), lambda: ph.Scene(inertia=BLOCK, omega=OMEGA, times=HUGE),
    lambda: ph.inertia.principal_axes(np.broadcast_to(np.eye(3), (10**12, 3, 3))),
    lambda: ph.Rotation(np.broadcast_to(HERE, (10**12, 4))), lambda: ph.Rotation.identity(shape=(2**63,)),
    lambda: ph.Rotation.identity(10**13), lambda: ph.free_motion(BLOCK, OMEGA, HERE, HUGE),
], ids=range(7))
def test_too_little_memory_is_a_memory_error(call):
    with pytest.raises(MemoryError):
        call()


# ---- calls that do not fit

SQUARE = np.arange(9.0).reshape(3, 3)
WRONG = {
    "FreeMotion: .*the keyword 'inertai'": lambda: ph.FreeMotion(inertai=BLOCK, omega=OMEGA),
    r"FreeMotion: must be called as FreeMotion\(inertia, omega, attitude=.*nothing for 'omega'":
        lambda: ph.FreeMotion(BLOCK),
    "FreeMotion.at: .*nothing for 't'": lambda: ph.FreeMotion(BLOCK, OMEGA).at(),
    "HeavyTop: .*the keyword 'arm'": lambda: ph.HeavyTop(TOP, arm=2.0, omega=OMEGA),
    "InertiaTensor: .*types ndarray, str": lambda: ph.InertiaTensor(np.eye(3), physical="yes"),
    "InertiaTensor: .*2 positional arguments": lambda: ph.InertiaTensor(np.eye(3), False),
    "MassProperties.from_mesh: .*types": lambda: ph.MassProperties.from_mesh(SQUARE, SQUARE, density=1, check="x"),
    "Custom: .*the keyword 'uses_tme'": lambda: ph.torques.Custom(print, uses_tme=False),
    "During: .*nothing for 'windows'": lambda: ph.torques.During(ph.torques.Constant(OMEGA)),
    r"Gravity: .*weight is the mass times g: Gravity\(weight=mass": lambda: ph.torques.Gravity(mass=3, arm=(0, 0, 1)),
    "Gravity: .*did you mean 'weight'": lambda: ph.torques.Gravity(wieght=3, arm=(0, 0, 1)),
    "solve: has no keyword 'accuarcy', did you mean 'accuracy'": lambda: ph.solve(ph.Scene.load("S1"), accuarcy=1e-6),
    "plan: .* it has scene, accuracy, method": lambda: ph.plan(ph.Scene.load("S1"), tol=1e-6),
    "solve_many: .* did you mean 'threads'": lambda: ph.solve_many([ph.Scene.load("S1")], thread=1),
    "Scene: .* did you mean 'times'": lambda: ph.Scene(inertia=BLOCK, omega=OMEGA, time=[1]),
    "Scene.replace: .* did you mean 'omega'": lambda: ph.Scene.load("S1").replace(omegas=OMEGA),
    "want: must be": lambda: ph.free_motion(BLOCK, OMEGA, HERE, 1.0, want=3),
    "want: must be one": lambda: ph.free_motion(BLOCK, OMEGA, HERE, 1.0, want=[["omega"]]),
    "out: must be": lambda: ph.free_motion(BLOCK, OMEGA, HERE, 1.0, out=3),
    "m: must be": lambda: ph.elliptic.K("0.5"),
    "count: must be": lambda: ph.recipe.load_recipe("S8").draw(1.5),
    "count: must be a": lambda: ph.recipe.load_recipe("S8").draw(-1),
    "max_steps: must be": lambda: ph.solve(ph.Scene.load("S1"), max_steps=2**70),
    "threads: must be": lambda: ph.solve_many([ph.Scene.load("S1")], threads=2**40),
    "threads: must be a": lambda: ph.free_motion(BLOCK, OMEGA, HERE, 1.0, threads=2**40),
    "six numbers": lambda: ph.InertiaTensor((1, 2, 2.5, 0, 0, 0)),
    "six numbers?": lambda: ph.Scene(inertia=(1, 2, 2.5, 0, 0, 0), omega=OMEGA, times=[1]),
    r"InertiaTensor\(matrix\)": lambda: ph.FreeMotion(np.eye(3), OMEGA),
    "from_moments": lambda: ph.InertiaTensor(BLOCK),
    "Rotation.from_matrix": lambda: ph.Scene(inertia=BLOCK, omega=OMEGA, attitude=np.eye(3), times=[1]),
    "Rotation.from_euler": lambda: ph.FreeMotion(BLOCK, OMEGA, (0.1, 0.2, 0.3)),
    "FreeMotion.__setstate__": lambda: ph.FreeMotion.__new__(ph.FreeMotion).__setstate__((1.0, 2, 3)),
    "HeavyTop.__setstate__": lambda: ph.HeavyTop.__new__(ph.HeavyTop).__setstate__((1.0,)),
    "InertiaTensor.__setstate__": lambda: ph.InertiaTensor.__new__(ph.InertiaTensor).__setstate__([1]),
    "cone: must be of a volume": lambda: ph.shapes.volume("cone", radius=1e154, height=9),
}


@pytest.mark.parametrize("message", WRONG)
def test_wrong_calls_have_messages_of_their_own(message):
    with pytest.raises(ph.InvalidInput, match=message) as refused:
        WRONG[message]()
    text = str(refused.value)
    assert len(text) < 400 and "\n" not in text and "pybind" not in text and "incompatible" not in text


def test_docstrings_and_overloads_are_those_of_the_signature():
    assert "Overloaded" not in ph.FreeMotion.__init__.__doc__ and "*args" not in ph.FreeMotion.at.__doc__
    assert ph.FreeMotion.at.__doc__.startswith("at(self: polhode.FreeMotion, t: object, *, progress: object = None)")
    assert pickle.loads(pickle.dumps(ph.FreeMotion(BLOCK, OMEGA))) == ph.FreeMotion(BLOCK, OMEGA)


PICKLED = {
    "tensor": lambda: ph.InertiaTensor.from_moments((1, 2, 2.5)),
    "free motion": lambda: ph.FreeMotion(BLOCK, OMEGA),
    "top": lambda: ph.HeavyTop((1, 1, 0.5), 1.3, (0.1, 0.2, 5), (0.6, 0, 0, 0.8)),
    "torque": lambda: ph.torques.During(ph.torques.Constant((1, 2, 3)), (1, 2)),
    "rotor": lambda: ph.Rotor((0, 0, 1), momentum=0.5),
    "scene": lambda: ph.Scene.load("S5"),
}


@pytest.mark.parametrize("name", PICKLED)
def test_every_protocol_of_pickle_brings_an_object_back(name):
    # Protocols 0 and 1 call __reduce__, whose inherited form ended the process for compiled classes.
    one = PICKLED[name]()
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        assert pickle.loads(pickle.dumps(one, protocol)) == one


def test_what_has_no_state_to_pickle_says_so_at_every_protocol():
    factors = ph._core.CostFactors.__new__(ph._core.CostFactors)
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        with pytest.raises((TypeError, ph.InvalidInput)):
            pickle.dumps(factors, protocol)


# ---- quaternions that may be (w, x, y, z)

HALF = (1, 0, 0, 0)
SCALAR_FIRST = {
    "Scene": lambda q: ph.Scene(inertia=BLOCK, omega=OMEGA, attitude=q, times=[1.0]),
    "FreeMotion": lambda q: ph.FreeMotion(BLOCK, OMEGA, q),
    "HeavyTop": lambda q: ph.HeavyTop(TOP, 2.0, OMEGA, q),
    "free_motion": lambda q: ph.free_motion(BLOCK, OMEGA, q, [1.0, 2.0]),
    "heavy_top": lambda q: ph.heavy_top(TOP, 2.0, OMEGA, q, [1.0, 2.0]),
    "solve_many": lambda q: ph.solve_many(ph.Scene(inertia=BLOCK, omega=OMEGA, times=[1]), omega=[OMEGA], attitude=q),
    "rotated": lambda q: ph.InertiaTensor.from_moments(BLOCK).rotated(q),
    "moved": lambda q: ph.shapes.sphere(1.0, 2.0).moved(q),
}


@pytest.mark.parametrize("name", SCALAR_FIRST)
def test_a_likely_scalar_first_quaternion_is_taken_with_a_warning(name):
    call = SCALAR_FIRST[name]
    for given in (HALF, list(HALF), np.array(HALF, float)):
        with pytest.warns(UserWarning, match=r"Rotation.from_quat\(..., scalar_first=True\)") as caught:
            call(given)
        assert len(caught) == 1 and caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for given in (ph.Rotation(HALF), HERE, (0, 1, 0, 0), (-1, 0, 0, 0), (0.6, 0.8, 0, 0)):
            call(given)


@pytest.mark.parametrize("part, taken", [(0.000999, True), (0.001, True), (0.0010001, False)])
def test_every_door_has_one_tolerance_for_attitudes(part, taken):
    """At 0.001 the norm is 1e-6 off to rounding, and its square a little more than 2e-6."""
    q = (0.0, part, part, 1.0)
    scene = ph.Scene(inertia=BLOCK, omega=OMEGA, times=[1])
    for call in (lambda: ph.FreeMotion(BLOCK, OMEGA, q), lambda: ph.free_motion(BLOCK, OMEGA, q, [1.0, 2.0]),
                 lambda: ph.heavy_top(TOP, 2.0, OMEGA, q, [1.0]), lambda: ph.Rotation(q), lambda: ph.Rotation([q, q]),
                 lambda: ph.Scene(inertia=BLOCK, omega=OMEGA, attitude=q, times=[1]),
                 lambda: ph.solve_many(scene, omega=[OMEGA], attitude=q)):
        with contextlib.nullcontext() if taken else pytest.raises(ph.InvalidInput, match="unit"):
            call()


def test_an_attitude_that_was_taken_gives_no_second_warning():
    with pytest.warns(UserWarning):
        scene = ph.Scene(inertia=BLOCK, omega=OMEGA, attitude=HALF, times=[1.0])
        motion = ph.FreeMotion(BLOCK, OMEGA, HALF)
    assert (scene.attitude == HALF).all()
    for again in (scene.replace(times=[2.0]), pickle.loads(pickle.dumps(scene))):
        assert (again.attitude == HALF).all()
    assert pickle.loads(pickle.dumps(motion)) == motion
    ph.solve_many(scene, omega=[OMEGA])


@pytest.mark.parametrize("motion", [
    ph.FreeMotion(BLOCK, OMEGA, ph.Rotation(HALF)), ph.Gyrostat(BLOCK, omega=OMEGA, attitude=ph.Rotation(HALF)),
    ph.DampedFree(BLOCK, 0.1, OMEGA, ph.Rotation(HALF)), ph.HeavyTop(TOP, 2.0, OMEGA, ph.Rotation(HALF)),
    ph.Pendulum(BLOCK, 2.0, (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), ph.Rotation(HALF))], ids=lambda m: type(m).__name__)
def test_a_pickled_motion_is_taken_as_it_was(motion):
    again = pickle.loads(pickle.dumps(motion))
    assert again == motion and hash(again) == hash(motion) and repr(again) == repr(motion)
    with pytest.raises(ph.InvalidInput, match="given what pickle saved, got another state"):
        type(motion).__new__(type(motion)).__setstate__((1, 2))


class Child(ph.FreeMotion):
    pass


@pytest.mark.parametrize("cls", [ph.Scene, ph.FreeMotion, ph.HeavyTop, ph.InertiaTensor, ph.torques.Gravity, Child])
def test_an_object_that_was_never_initialised_says_so(cls):
    empty = cls.__new__(cls)
    name = next(name for name in vars(cls.__mro__[1] if cls in (ph.Scene, Child) else cls) if not name.startswith("_"))
    with pytest.raises(ph.InvalidInput, match="must be initialised"):
        getattr(empty, name)
    for use in (copy.copy, pickle.dumps):
        with pytest.raises(ph.InvalidInput, match="must be initialised"):
            use(empty)
    if cls not in (ph.Scene, Child):
        assert "not initialised" in repr(empty) + str(empty)
