"""Each fault is named, with its size, from motions that were spoiled by another route."""

import numpy as np
import pytest
import spoiled

import polhode as ph

I = (1.0, 2.0, 2.5)
T = np.linspace(0, 6, 200)
W, Q = ph.FreeMotion(I, (1, 0.5, 2)).at(T)


def judged(case):
    return ph.judge(case.t, case.attitude, case.omega, tolerance=1e-10, **case.words)


@pytest.mark.parametrize("cause", spoiled.FAULTS)
def test_each_fault_is_the_main_finding(cause):
    family = "tensor" if cause == "products of inertia" else "box"
    case = next(filter(None, (spoiled.make(cause, family, [7, seed]) for seed in range(20))))
    found = judged(case)
    assert found.findings[0].cause in (cause, *case.accepted), str(found)
    assert not found.fine and found.fails("warning")


@pytest.mark.parametrize("cause", ["damping", "lag", "gyroscopic sign", "integrator", "clock"])
def test_faults_of_a_heavy_body(cause):
    assert judged(spoiled.make(cause, "heavy", [8, 1])).findings[0].cause == cause


@pytest.mark.parametrize("cause", ["damping", "torque", "clock", "lag", "bias"])
def test_sizes_without_noise_are_exact(cause):
    case = spoiled.make(cause, "box", [9, 2])
    finding = judged(case).findings[0]
    np.testing.assert_allclose(finding.size, case.size, rtol=1e-6, atol=1e-6 * np.max(np.abs(case.size)))
    assert finding.explained > 1 - 1e-9 and finding.margin > 100


@pytest.mark.parametrize("name", spoiled.ORDERS)
def test_an_integrator_is_told_with_order_step_and_name(name):
    scene = spoiled.scene_of("box", np.random.default_rng(4), count=150, turns=2)
    count = 4 if spoiled.ORDERS[name] == 1 else 2
    omega, attitude = spoiled.integrated(scene, name, count)
    finding = ph.judge(scene.times, attitude, omega, inertia=scene.inertia, tolerance=1e-10).findings[0]
    assert (finding.cause, finding.order, finding.method) == ("integrator", spoiled.ORDERS[name], name)
    assert finding.step == pytest.approx(scene.times[1] / count, rel=1e-6)


def test_numbers_come_with_their_errors():
    rng = np.random.default_rng(0)
    off = []
    for _ in range(8):
        shake = ph.Rotation.from_rotvec(1e-3 * rng.normal(size=(200, 3)))
        q = (ph.Rotation.from_quat(Q) * shake).as_quat()
        w = W + 1e-3 * rng.normal(size=W.shape) + [0.05, 0, 0]
        finding = ph.judge(T, q, w, inertia=I).findings[0]
        assert finding.cause == "bias"
        off.append((np.array(finding.size) - [0.05, 0, 0]) / finding.sigma)
    assert 0.5 < np.sqrt(np.mean(np.square(off))) < 1.7


def test_a_slip_of_the_clock_is_the_same_as_a_factor_on_the_rates():
    w, q = ph.FreeMotion(I, (1, 0.5, 2)).at(T * (1 + 1e-4))
    finding = ph.judge(T, q, w, inertia=I).findings[0]
    assert finding.cause == "clock" and finding.rivals == ("units of rates",)
    assert finding.size == pytest.approx(1e-4, rel=1e-6)


def test_two_faults_of_conventions_are_both_undone():
    space = ph.Rotation.from_quat(Q).apply(W)
    found = ph.judge(T * 1000, np.roll(Q, 1, axis=1), space, inertia=I)
    assert {f.cause for f in found.findings} == {"scalar order", "frame of rates", "units of time"}
    np.testing.assert_allclose(found.repaired.omega, W, atol=1e-12)
    np.testing.assert_allclose(found.repaired.attitude, Q, atol=1e-15)
    np.testing.assert_allclose(found.repaired.t, T, rtol=1e-15)


def test_the_declared_convention_is_no_fault():
    rotation = ph.Rotation.from_quat(Q)
    assert ph.judge(T, np.roll(Q, 1, axis=1), W, inertia=I, order="wxyz").fine
    assert ph.judge(T, Q, rotation.apply(W), inertia=I, frame="space").fine
    assert ph.judge(T, rotation.as_euler("ZYX", degrees=True), np.degrees(W), inertia=I, euler="ZYX", degrees=True).fine
    assert ph.judge(T, rotation.as_matrix(), W, inertia=I).fine
    assert ph.judge(T, rotation, W, inertia=ph.InertiaTensor.from_moments(I)).fine


def test_a_large_fault_beside_a_large_motion_is_still_named():
    motion = ph.solve(
        ph.Scene(
            inertia=I, omega=(1, 0.5, 2), times=np.linspace(0, 40, 800), torques=[ph.torques.AngularDamping(0.05)]
        ),
        1e-11,
    )
    finding = ph.judge(motion.t, motion.attitude, motion.omega, inertia=I).findings[0]
    assert finding.cause == "damping" and finding.size == pytest.approx(0.05, rel=1e-3)


def test_another_body_and_a_lag_are_found_by_one_channel_alone():
    w, q = ph.FreeMotion((1, 2.05, 2.5), (1, 0.5, 2)).at(T)
    assert ph.judge(T, omega=w, inertia=I).findings[0].cause == "inertia"
    assert ph.judge(T, q, inertia=I).findings[0].cause == "inertia"
    assert ph.judge(T, q * [-1, -1, -1, 1], inertia=(1, 2.05, 2.5)).findings[0].cause == "conjugate"


def test_ten_thousand_samples_and_gaps_beyond_the_thinning():
    t = np.linspace(0, 60, 10_000)
    w, q = ph.FreeMotion(I, (1, 0.5, 2)).at(t)
    keep = np.delete(np.arange(10_000), [7000, 7001, 7002, 7003, 7004, 7005, 7006, 7007, 7008, 7009])
    assert ph.judge(t, q, w, inertia=I).fine
    found = ph.judge(t[:9990], q[keep], w[keep], inertia=I)
    assert found.findings[0].cause == "dropped" and found.findings[0].size == 10
    assert [f.cause for f in found.findings if f.level != "remark"] == ["dropped"]
    np.testing.assert_allclose(found.repaired.t, t[keep], atol=1e-12)
