"""Basilisk's spacecraft on an orbit with its gravity gradient, for worlds.py: prints one line of JSON.

The numbers are those of Basilisk's test of GravityGradientEffector (a = 7000 km, e = 1e-4, i = 33.3 degrees, moments
500, 800 and 350, released at rest), for 3600 s. Each step and integrator runs three times. The least CPU time is told,
of ExecuteSimulation alone, with ten recorded states.
"""

import json
import time

import numpy as np
from Basilisk import __version__
from Basilisk.simulation import GravityGradientEffector, spacecraft, svIntegrators
from Basilisk.utilities import SimulationBaseClass, macros, orbitalMotion, simIncludeGravBody

SPAN, RECORDED = 3600.0, 360.0
RUNS = [("RK4", step) for step in (20.0, 5.0, 1.0)] + [("RKF78", step) for step in (40.0, 20.0, 5.0)]


def run(integrator, step):
    simulation = SimulationBaseClass.SimBaseClass()
    simulation.CreateNewProcess("process").addTask(simulation.CreateNewTask("task", macros.sec2nano(step)))
    bodies = simIncludeGravBody.gravBodyFactory()
    earth = bodies.createEarth()
    earth.isCentralBody = True
    elements = orbitalMotion.ClassicElements()
    elements.a, elements.e, elements.i = 7e6, 1e-4, 33.3 * macros.D2R
    elements.Omega, elements.omega, elements.f = 48.2 * macros.D2R, 347.8 * macros.D2R, 85.3 * macros.D2R
    r, v = orbitalMotion.elem2rv(earth.mu, elements)
    body = spacecraft.Spacecraft()
    body.ModelTag = "body"
    body.hub.mHub, body.hub.r_BcB_B = 100.0, [[0.0], [0.0], [0.0]]
    body.hub.IHubPntBc_B = [[500.0, 0.0, 0.0], [0.0, 800.0, 0.0], [0.0, 0.0, 350.0]]
    body.hub.r_CN_NInit, body.hub.v_CN_NInit = r, v
    body.hub.sigma_BNInit, body.hub.omega_BN_BInit = [[0.1], [0.2], [-0.3]], [[0.0], [0.0], [0.0]]
    kept = (svIntegrators.svIntegratorRKF78(body) if integrator == "RKF78" else svIntegrators.svIntegratorRK4(body))
    body.setIntegrator(kept)
    simulation.AddModelToTask("task", body)
    bodies.addBodiesTo(body)
    gradient = GravityGradientEffector.GravityGradientEffector()
    gradient.ModelTag = "gradient"
    gradient.addPlanetName(earth.planetName)
    body.addDynamicEffector(gradient)
    simulation.AddModelToTask("task", gradient)
    log = body.scStateOutMsg.recorder(macros.sec2nano(RECORDED))
    simulation.AddModelToTask("task", log)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(macros.sec2nano(SPAN))
    begin = time.process_time()
    simulation.ExecuteSimulation()
    seconds = time.process_time() - begin
    return seconds, log, earth.mu, r, v


def main():
    rows = []
    for integrator, step in RUNS:
        found = [run(integrator, step) for _ in range(3)]
        _, log, mu, r, v = found[0]
        rows.append({"integrator": integrator, "step": step, "seconds": min(one[0] for one in found),
                     "sigma": np.array(log.sigma_BN).tolist(), "omega": np.array(log.omega_BN_B).tolist()})
    print(json.dumps({"version": __version__, "mu": mu, "r": np.ravel(r).tolist(), "v": np.ravel(v).tolist(),
                      "times": (np.array(log.times()) * 1e-9).tolist(), "runs": rows}))


if __name__ == "__main__":
    main()
