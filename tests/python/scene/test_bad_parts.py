"""Orbits, fields, plates, rotors, dampers, bodies that change: a refusal is one line with its number."""

import math

import numpy as np
import pytest

import polhode as ph

NAN, Z = math.nan, (0, 0, 1)
J = np.diag([1.0, 2.0, 2.5])
PLACES = [(7e6, 0, 0), (0, 7e6, 0), (-7e6, 0, 0)]
ORBIT = ph.Orbit(mu=4e14, r0=(7e6, 0, 0), v0=(0, 7500, 0))


def rotor(**given):
    return ph.Rotor(**{"axis": Z, "inertia": 0.1, "speed": 3.0, "free": True, **given})


def damper(**given):
    return ph.Damper(**{"inertia": 0.1, "viscous": 0.1, **given})


def scene(**given):
    return ph.Scene(**{"inertia": (1, 2, 2.5), "omega": (0.1, 0.2, 0.3), "times": [0, 1], **given})


def changing(pieces, **beside):
    return scene(inertia=ph.Changing(pieces, **beside))


def elements(**given):
    return ph.Orbit.from_elements(4e14, **given)


def plate(**given):
    return ph.Plate(**{"area": 1.0, "normal": Z, "centre": (1, 0, 0), **given})


def drag(**given):
    return ph.torques.Drag(**{"plates": [plate()], "orbit": ORBIT, "coefficient": 2.2, "density": 1e-12,
                              "height_radius": 7e6, "scale_height": 6e4, **given})


def light(**given):
    return ph.torques.SolarPressure(**{"plates": [plate()], "sun": (1, 0, 0), "pressure": 4e-6, **given})


def gauss(radius, g, h):
    return ph.MagneticField.gauss(ORBIT, radius, g, h)


ROTORS = [
    (lambda: rotor(inertia=-1.5), "Rotor.inertia: must be positive, got -1.5"),
    (lambda: rotor(speed=NAN), "Rotor.speed: must be finite, got nan"),
    (lambda: rotor(viscous=NAN), "Rotor.viscous: must be finite, got nan"),
    (lambda: rotor(coulomb=math.inf), "Rotor.coulomb: must be finite, got inf"),
    (lambda: rotor(torque=1.0, max_torque=-1.5), "Rotor.max_torque: must be positive and finite, got -1.5"),
    (lambda: rotor(torque=1.0, max_speed=NAN), "Rotor.max_speed: must be finite, got nan"),
    (lambda: rotor(torque=1.0, max_speed=0.0, speed=0.0), "Rotor.max_speed: must be positive and finite, got 0"),
    (lambda: rotor(axis=(0, NAN, 0)), "Rotor.axis: must be finite, got nan in component 1"),
    (lambda: rotor(axis=(0, 0, 0)), "Rotor.axis: must be a direction, got (0, 0, 0)"),
    (lambda: rotor(free=False, viscous=0.7), "Rotor.viscous: must be left out for a rotor that is held, got 0.7"),
    (lambda: rotor(free=False, coulomb=0.7), "Rotor.coulomb: must be left out for a rotor that is held, got 0.7"),
    (lambda: rotor(max_speed=11.0), "Rotor.max_speed: must be left out without a motor's torque, got 11"),
    (lambda: rotor(torque=1.0, max_speed=2.0, speed=-3.0), "Rotor.speed: must be at most max_speed, 2, got -3"),
    (lambda: rotor(torque=1.0, during=[(0, 1)]), "Rotor.during: must be left out with free=True, got 1 windows"),
    (lambda: scene(rotors=[rotor(inertia=3.0, torque=1.0)]),
     "scene.rotors[0].inertia: must be below the body's moment about the rotor's axis, 2.5, got 3"),
    (lambda: scene(rotors=[rotor(inertia=1.0, torque=1.0)] * 3), "three positive moments, got a least moment of -0.5"),
]
DAMPERS = [
    (lambda: damper(inertia=-1.5), "Damper.inertia: must be positive and finite, got -1.5"),
    (lambda: damper(viscous=NAN), "Damper.viscous: must be finite, got nan"),
    (lambda: damper(rates=(0, 1)), "Damper.rates: must be an array of shape (3,), got shape (2,)"),
    (lambda: scene(damper=damper(inertia=1.0)),
     "scene.damper.inertia: must be below the body's least moment, 1, got 1"),
    (lambda: scene(damper=damper(inertia=0.9), rotors=[rotor(axis=(1, 0, 0), inertia=0.2)]),
     "three positive moments, got a least moment of -0.0999"),
]
CHANGING = [
    (lambda: changing([(0, 2, [J]), (1, 3, [J])], before=J, after=J), "which ends at 2 s, got a begin at 1 s"),
    (lambda: changing([(0, 1, [J]), (2, 3, [J])], before=J, after=J), "which ends at 1 s, got a begin at 2 s"),
    (lambda: changing([(2, 1, [J])]), "must be with an end after its begin, got 2 to 1"),
    (lambda: changing([(0, NAN, [J])]), "must be with an end after its begin, got 0 to nan"),
    (lambda: changing([(0, 0.5, [J])]), "must be of pieces from 0 to 1 s, got 0 to 0.5 s"),
    (lambda: changing([(0, 2, [J, -2 * J, J])]), "positive definite at all times, got a least moment of 0 at t = 1 s"),
    (lambda: changing([(0, 2, [J, -2.2 * J, 1.1 * J])]), "positive definite at all times, got a least moment of -"),
    (lambda: changing([(0, 2, [J, np.diag([0, 0, 1.0])])]),
     "must be a body's tensor at all times, got moments 1, 2, 3.0"),
    (lambda: changing([(0, 2, [J * NAN])]), "Changing.pieces[0]: must be finite, got nan"),
    (lambda: changing([(0, 2, [J + np.triu(np.ones((3, 3)), 1)])]), "must be symmetric, got 0 and 1"),
    (lambda: changing([]), "Changing.pieces: must be at least one, got none"),
    (lambda: ph.Changing.ramp(J, J, (0, 1), order=2), "Changing.ramp.order: must be 1, 3 or 5, got 2"),
    (lambda: ph.Changing.ramp(J, J, (1, 1)), "the second after the first, got 1 and 1"),
    (lambda: ph.Changing.table([0, 2, 1], [J, J, J]), "each above the one before, got 1 after 2"),
    (lambda: ph.Changing.table([0, 2], [J, J, J]), "must be with a value for each of 2 times, got 3"),
    (lambda: scene(momentum=ph.Changing([(0, 2, [(1, 2)])])), "of shape (3,) or (3, 3), got [1.0, 2.0]"),
    (lambda: scene(leaving=True), "scene.leaving: must be left out for a constant inertia, got true"),
]
ORBITS = [
    (lambda: ph.Orbit(0.0, PLACES[0], PLACES[1]), "mu: must be positive and finite, got 0"),
    (lambda: ph.Orbit(4e14, (0, 0, 0), (0, 1, 0)), "r0: must be not the centre, got 0, 0, 0"),
    (lambda: ph.Orbit(4e14, (0, NAN, 0), (0, 1, 0)), "r0: must be finite, got nan"),
    (lambda: elements(a=7e6, e=-0.1), "e: must be at least 0 and finite, got -0.1"),
    (lambda: elements(a=7e6, e=1.5), "a: must be left out with e >= 1, got 7e+06"),
    (lambda: elements(periapsis_distance=0.0), "periapsis_distance: must be positive and finite, got 0"),
    (lambda: elements(periapsis_distance=7e6, e=1.5, anomaly=3.0), "between the asymptotes of the hyperbola, got 3"),
    (lambda: elements(a=7e6, j2=1e-3), "radius: must be positive and finite, got 0"),
    (lambda: elements(periapsis_distance=7e6, e=1.5, j2=1e-3, radius=6e6),
     "j2: must be left out with e >= 1, got 0.001"),
    (lambda: elements(a=7e6, e=0.5, j2=1e-3, radius=6e6),
     "radius: must be at most the periapsis distance, 3500000, got 6e+06"),
    (lambda: light(orbit=ORBIT, shadow=-1.0), "shadow: must be positive and finite, got -1"),
    (lambda: light(shadow=6e6), "must be given together, got shadow 6000000.0 alone"),
    (lambda: scene(torques=[light(orbit=ORBIT, shadow=7.5e6)]),
     "shadow: must be at most the least distance of the orbit, 6784615.38"),
    (lambda: ph.Orbit.table([0, 2, 1], PLACES, PLACES), "t: must be increasing, got 1 after 2"),
    (lambda: ph.Orbit.table([0, NAN, 1], PLACES, PLACES), "table: must be finite, got row 1"),
    (lambda: ph.Orbit.table([0, 1, 2], PLACES, PLACES).at(3.0), "within the table, 0 to 2 s, got 3"),
    (lambda: gauss(-6e6, [[0], [1, 2]], [[0], [0, 1]]),
     "MagneticField.radius: must be positive and finite, got -6e+06"),
    (lambda: gauss(6e6, [[0], [1, 2]], [[0], [0, 1], [0, 1, 1]]), "must be as many rows as g, 2, got 3"),
    (lambda: gauss(6e6, [[0], [1, 2]], [[0], [1, 1]]), "MagneticField.h[1][0]: must be 0: it has no meaning, got 1"),
    (lambda: ph.MagneticField.dipole(ORBIT, NAN), "MagneticField.strength: must be finite, got nan"),
]
PLATES = [
    (lambda: plate(area=-1.0), "Plate.area: must be at least 0 and finite, got -1"),
    (lambda: plate(area=math.inf), "Plate.area: must be at least 0 and finite, got inf"),
    (lambda: plate(normal=(0, 0, 0)), "Plate.normal: must be not 0, got (0, 0, 0)"),
    (lambda: plate(normal=(0, NAN, 1)), "Plate.normal: must be finite, got nan"),
    (lambda: plate(centre=(0, math.inf, 1)), "Plate.centre: must be finite, got inf"),
    (lambda: plate(specular=0.7, diffuse=0.4), "together at most 1, got 0.7 and 0.4"),
    (lambda: drag(scale_height=0.0), "Drag.scale_height: must be positive and finite, got 0"),
    (lambda: drag(density=-1.0), "Drag.density: must be at least 0 and finite, got -1"),
    (lambda: drag(plates=[]), "Drag.plates: must be at least one plate, got none"),
    (lambda: light(sun=(0, 0, 0)), "SolarPressure.sun: must be finite and not 0, got 0, 0, 0"),
    (lambda: light(sun=(0, NAN, 1)), "SolarPressure.sun: must be finite, got nan"),
    (lambda: light(pressure=-1.0), "SolarPressure.pressure: must be at least 0 and finite, got -1"),
]


@pytest.mark.parametrize(("make", "words"), [
    pytest.param(make, words, id=words[:60]) for make, words in [*ROTORS, *DAMPERS, *CHANGING, *ORBITS, *PLATES]])
def test_a_refusal_is_one_line_with_its_number(make, words):
    with pytest.raises(ph.InvalidInput) as refusal:
        make()
    assert words in str(refusal.value) and "\n" not in str(refusal.value)


def test_an_orbit_that_falls_into_the_centre_within_the_span_is_refused():
    radial = ph.Orbit(mu=4e14, r0=(7e6, 0, 0), v0=(0, 0, 0))
    falling = scene(torques=[ph.torques.GravityGradient(orbit=radial)], times=[0, 500.0])   # it takes 1028.5 s
    assert ph.solve(falling).success
    with pytest.raises(ph.InvalidInput, match="before a radial orbit meets the centre, got 2000") as refusal:
        ph.solve(falling.replace(times=[0, 500.0, 2000.0]))
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("exponent", [-1074, -1030, -700, 700, 1023])
def test_the_axis_of_a_rotor_is_a_direction_of_any_length(exponent):
    size = 2.0**exponent
    assert ph.Rotor(axis=(size, size, 0), momentum=1.0).axis.tolist() == rotor(axis=(1, 1, 0)).axis.tolist()
