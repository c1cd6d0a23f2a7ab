"""Closed loops for the tests, as polhode and tests/python/clock/by_hand.py run them."""

import numpy as np
from by_hand import Body, circular_dipole

import polhode as ph

ORBIT = {"mu": 3.986004418e14, "radius": 6.9e6, "inclination": 1.1}
STRENGTH = -7.8e15


def pd(t, m, s, p):
    return -p.kp * m.attitude[:3] * m.attitude[3] - p.kd * m.omega


def pid(t, m, s, p):
    e = m.attitude[:3] * m.attitude[3]
    z = s.z + p.period * e
    return -p.kp * e - p.kd * m.omega - p.ki * z, {"z": z}


def low_pass(t, m, s, p):
    f = s.f + p.a * (m.omega - s.f)
    return -p.kd * f, {"f": f}


def pulses(t, m, s, p):
    e = m.omega + p.c * m.attitude[:3] * m.attitude[3]
    return np.where(e > p.band, -p.u, np.where(e < -p.band, p.u, 0.0))


def saturated(t, m, s, p):
    return np.clip(-p.kp * m.attitude[:3] * m.attitude[3] - p.kd * m.omega, -p.most, p.most)


def forced(t, m, s, p):
    n = s.n + 1
    return p.u * np.stack([t / (1 + t * t), p.w / (1 + t), 1 / (1 + n)]), {"n": n}


def b_dot(t, m, s, p):
    slope = (m.field - s.old) / p.period
    return np.where(s.n > 0, -p.k * slope, 0.0 * slope), {"old": m.field, "n": s.n + 1}


def b_cross(t, m, s, p):
    return p.k * np.cross(m.omega, m.field)


def wheels(t, m, s, p):
    return p.kp * m.attitude[:3] * m.attitude[3] + p.kd * m.omega - p.ks * m.speed


def momenta(t, m, s, p):
    h = s.h + p.period * (p.kp * m.attitude[:3] * m.attitude[3] + p.kd * m.omega)
    return h, {"h": h}


J = ((3.1, 0.12, -0.2), (0.12, 2.4, 0.05), (-0.2, 0.05, 4.0))
PD = {"kp": 2.0, "kd": 3.0}
Z = {"z": (0.0, 0.0, 0.0)}
AXES = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


def one(function, period, **more):
    return {"function": function, "period": period, **more}


def case(controllers, omega=(0.2, -0.3, 0.1), attitude=(0.5, -0.3, 0.2, 0.7), J=J, span=4.0, samples=5, **more):
    return {"controllers": controllers, "omega": omega, "attitude": attitude, "J": J, "span": span, "samples": samples,
            **more}


LOOPS = {
    "pd": case([one(pd, 0.1, parameters=PD)]),
    "pd fast spin": case([one(pd, 0.05, parameters=PD)], omega=(3.0, -4.0, 2.0), span=2.0),
    "pd coarse": case([one(pd, 0.5, parameters={"kp": 0.5, "kd": 1.0})], span=10.0),
    "pd from diagonal": case([one(pd, 0.2, parameters=PD)], J=(1.0, 2.0, 2.5)),
    "pd sphere": case([one(pd, 0.2, parameters=PD)], J=(2.0, 2.0, 2.0)),
    "pd symmetric": case([one(pd, 0.2, parameters=PD)], J=(2.0, 2.0, 3.0)),
    "pd one axis": case([one(pd, 0.2, parameters=PD)], omega=(0.0, 0.0, 0.4), attitude=(0.0, 0.0, 0.6, 0.8),
                        J=(1.0, 2.0, 2.5)),
    "pd one period beyond the span": case([one(pd, 9.0, parameters=PD)]),
    "limit": case([one(pd, 0.1, parameters=PD, limit=0.3)]),
    "saturated law": case([one(saturated, 0.1, parameters={**PD, "most": 0.4})]),
    "delay of half a period": case([one(pd, 0.1, parameters=PD, delay=0.05)]),
    "delay of 2.5 periods": case([one(pd, 0.1, parameters=PD, delay=0.25)]),
    "delay of two periods": case([one(pd, 0.1, parameters=PD, delay=0.2)]),
    "delay beyond the span": case([one(pd, 0.1, parameters=PD, delay=7.0)], span=1.0),
    "pid": case([one(pid, 0.1, parameters={**PD, "ki": 0.3, "period": 0.1}, states=Z)]),
    "pid against friction": case([one(pid, 0.1, parameters={**PD, "ki": 0.3, "period": 0.1}, states=Z)], damping=0.4),
    "low pass": case([one(low_pass, 0.1, parameters={"a": 0.3, "kd": 2.0}, states={"f": (0.0, 0.0, 0.0)})]),
    "low pass with quantum": case([one(low_pass, 0.1, parameters={"a": 0.3, "kd": 2.0}, states={"f": (0.0, 0.0, 0.0)},
                                       quantum=1e-3)]),
    "pd with quantum": case([one(pd, 0.2, parameters=PD, quantum=1e-2)]),
    "forced": case([one(forced, 0.1, parameters={"u": 0.2, "w": 1.7}, states={"n": 0.0})]),
    "pulses": case([one(pulses, 0.25, parameters={"c": 0.4, "band": 0.05, "u": 0.3}, width=0.1)], span=6.0),
    "pulses of a whole period": case([one(pulses, 0.25, parameters={"c": 0.4, "band": 0.05, "u": 0.3}, width=0.25)]),
    "pulses with delay": case([one(pulses, 0.25, parameters={"c": 0.4, "band": 0.05, "u": 0.3}, width=0.2, delay=0.4)]),
    "first tick later": case([one(pd, 0.3, parameters=PD, start=0.77)]),
    "two periods": case([one(pd, 0.1, parameters=PD), one(low_pass, 0.15, parameters={"a": 0.3, "kd": 0.5},
                                                          states={"f": (0.0, 0.0, 0.0)})]),
    "b cross": case([one(b_cross, 2.0, output="dipole", parameters={"k": 2e7})], span=40.0, J=(0.05, 0.06, 0.04),
                    field=True),
    "b dot": case([one(b_dot, 1.0, output="dipole", parameters={"k": 2e5, "period": 1.0},
                       states={"old": (0.0, 0.0, 0.0), "n": 0.0}, limit=0.2)], span=30.0, J=(0.05, 0.06, 0.04),
                       field=True),
    "b cross with width": case([one(b_cross, 2.0, output="dipole", parameters={"k": 2e7}, width=1.3)], span=20.0,
                               J=(0.05, 0.06, 0.04), field=True),
    "wheels": case([one(wheels, 0.2, output="rotor_torque", parameters={"kp": 0.5, "kd": 1.5, "ks": 1e-4})],
                   wheels={"inertia": 0.02, "speed": 10.0, "viscous": 1e-4}),
    "momentum in steps": case([one(momenta, 0.2, output="rotor_momentum", states={"h": (0.0, 0.0, 0.0)},
                                   parameters={"kp": 0.5, "kd": 1.5, "period": 0.2})],
                              wheels={"inertia": 0.02, "speed": 0.0}),
}


START = ("omega_x", "omega_z", "attitude_y")


def short(name, span, by, **more):
    return {**LOOPS[name], "span": span, "by": by, "samples": 4, **more}


# Of each, the columns whose truth is in slopes.json.
SLOPES = {
    "pd": short("pd from diagonal", 1.5, ("controllers.0.kp", "controllers.0.kd", *START, "inertia_2")),
    "pd fast spin": short("pd fast spin", 0.5, ("controllers.0.kp", "controllers.0.kd", *START)),
    "limit": short("limit", 1.2, ("controllers.0.kp", "controllers.0.kd", *START)),
    "delay of 2.5 periods": short("delay of 2.5 periods", 1.3, ("controllers.0.kp", "controllers.0.kd", *START)),
    "pid against friction": short("pid against friction", 1.2, (
        "controllers.0.kp", "controllers.0.ki", "controllers.0.period", "controllers.0.z_y", *START)),
    "low pass with quantum": short("low pass with quantum", 1.2, (
        "controllers.0.a", "controllers.0.kd", "controllers.0.f_x", *START)),
    "pulses": short("pulses", 2.1, ("controllers.0.u", "controllers.0.c", *START)),
    "pulses with delay": short("pulses with delay", 1.9, ("controllers.0.u", "controllers.0.c", *START)),
    "saturated law": short("saturated law", 1.2, ("controllers.0.kp", "controllers.0.most", *START)),
    "two periods": short("two periods", 1.0, ("controllers.0.kd", "controllers.1.a", "controllers.1.kd", *START)),
    "b cross": short("b cross", 20.0, ("controllers.0.k", *START)),
    "b dot": short("b dot", 12.0, ("controllers.0.k", "controllers.0.period", *START)),
    "wheels": short("wheels", 1.7, ("controllers.0.kp", "controllers.0.ks", *START)),
    "momentum in steps": short("momentum in steps", 1.7, ("controllers.0.kp", "controllers.0.kd", "controllers.0.h_z",
                                                          *START)),
}


def times(loop):
    return np.linspace(0.0, loop["span"], loop["samples"])


def make_field():
    c, s = np.cos(ORBIT["inclination"]), np.sin(ORBIT["inclination"])
    speed = np.sqrt(ORBIT["mu"] / ORBIT["radius"])
    orbit = ph.Orbit(mu=ORBIT["mu"], r0=(ORBIT["radius"], 0.0, 0.0), v0=(0.0, speed * c, speed * s))
    return ph.MagneticField.dipole(orbit, STRENGTH)


def make_scene(loop, **more):
    field = make_field() if loop.get("field") else None
    controllers = []
    for given in loop["controllers"]:
        parts = {k: v for k, v in given.items() if k not in ("quantum",)}
        if "quantum" in given:
            parts["measure"] = ph.Measure(omega_quantum=given["quantum"])
        controllers.append(ph.Controller(parts.pop("period"), parts.pop("function"), field=field, **parts))
    own = loop.get("wheels")
    free = own is not None and "viscous" in own
    drive = {"free": True, "viscous": own["viscous"]} if free else {}
    rotors = [ph.Rotor(a, inertia=own["inertia"], speed=own["speed"], **drive) for a in AXES] if own else []
    torques = [ph.torques.Damping((loop["damping"],) * 3)] if "damping" in loop else []
    return ph.Scene(**{"inertia": loop["J"], "omega": loop["omega"],
                       "attitude": np.array(loop["attitude"]) / np.linalg.norm(loop["attitude"]), "times": times(loop),
                       "controllers": controllers, "rotors": rotors, "torques": torques, **more})


def make_body(loop):
    """The body of by_hand.run, and its keywords."""
    inertia = np.diag(loop["J"]) if np.ndim(loop["J"]) == 1 else np.array(loop["J"])
    own = loop.get("wheels")
    more = {}
    if loop.get("field"):
        more["field"] = circular_dipole(ORBIT["mu"], ORBIT["radius"], ORBIT["inclination"], STRENGTH)
    if own is None:
        return Body(inertia.tolist(), damping=loop.get("damping", 0.0), **more), {}
    held = "viscous" not in own
    import mpmath as mp

    J = mp.matrix(inertia.tolist())
    if not held:
        for i in range(3):
            J[i, i] -= mp.mpf(own["inertia"])
    body = Body(J.tolist(), AXES, [own["inertia"]] * 3, [] if held else [own["viscous"]] * 3)
    start = [mp.mpf(own["inertia"]) * (mp.mpf(own["speed"]) + (0 if held else mp.mpf(w))) for w in loop["omega"]]
    return body, {"h": start, "held": held}
