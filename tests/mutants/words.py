"""Which tests belong to a word: files of Python tests, and folders of C++ tests."""

SOLVE = ["solve", "plan", "plan_exact", "plan_limits", "plan_custom", "handover", "pieces", "certificates",
         "certificates_hold", "events", "taylor_invariants", "torque_windows", "methods", "doors", "proof",
         "proof_rotors", "rotors", "rotors_windows", "gyrostat_plan", "far_times"]

# By the first parts of a path below python/polhode; the longest that fits holds.
PYTHON = {
    "_attitude": ["attitude", "attitude_euler", "attitude_fits", "attitude_refusals", "doors"],
    "_batch/closed_forms": ["batch", "batch_top", "directions", "summary", "doors", "minimal"],
    "_batch/broadcast": ["batch", "batch_top", "directions", "summary", "solve_many", "doors"],
    "_batch/step": ["step"],
    "_batch/solve_many": ["solve_many", "solve_many_rk45", "solve_many_lanes", "batch_errors", "doors", "interrupts"],
    "_batch": ["solve_many", "batch_errors", "interrupts"],
    "_ensemble": ["ensemble_recipe", "ensemble_draw", "ensemble_truth", "ensemble_store", "ensemble_engines",
                  "ensemble_dask", "ensemble_cli"],
    "_export": ["saved"],
    "_keywords": ["doors", "solve"],
    "_saved": ["saved", "ensemble_store"],
    "_files": ["outputs", "hostile_files", "schema", "mesh_files"],
    "_wings": ["wings"],
    "_workers": ["workers", "atlas", "charts_limits", "ensemble_engines"],
    "_xml": ["robots", "robots_real", "robots_models", "mesh_files", "hostile_files", "fuzz"],
    "_harness": ["charts", "charts_peers", "atlas", "charts_limits"],
    "_plot/film": ["film"],
    "_plot/fit": ["fit", "fit_cli"],
    "_plot": ["plot", "pictures", "charts", "charts_limits"],
    "_sensitivity/driven": ["driven_sensitivity", "driven_fit"],
    "_sensitivity/lyapunov": ["lyapunov"],
    "_sensitivity/free": ["free_sensitivity"],
    "_sensitivity": ["free_sensitivity", "fit", "driven_sensitivity", "driven_fit", "lyapunov", "fit_cli"],
    "_scene": ["schema", "hostile_files", "cli_mesh", "minimal", "composites", "homework", "family", "doors",
               "scenes_reference", "torque_windows", "solve", "fuzz"],
    "_solve/costs": ["plan", "plan_limits", "hostile_files", "cli"],
    "_solve/calibrate": ["plan", "hostile_files", "cli"],
    "_solve": ["solve", "plan", "plan_exact", "plan_limits", "doors", "pieces", "handover", "events",
               "certificates", "minimal", "cli", "scenes_reference"],
    "atlas": ["atlas_verdicts", "atlas_claims", "atlas"],
    "charts": ["charts_limits", "charts_peers", "charts_choice", "charts_engines", "charts_entrants", "charts"],
    "cli": ["cli", "cli_mesh", "outputs", "charts_choice", "charts", "robots", "robots_ci", "atlas", "report",
            "fit_cli", "ensemble_cli", "film", "readme"],
    "elliptic": ["elliptic", "doors"],
    "inertia/robots": ["robots", "robots_real", "robots_models", "robots_ci", "hostile_files", "fuzz"],
    "inertia": ["diagnosis", "inertia", "robots", "robots_real", "principal_axes", "shapes", "mesh", "doors"],
    "measured": ["fit"],
    "mesh": ["mesh_files", "mesh", "hostile_files", "cli_mesh", "fuzz"],
    "recipe": ["ensemble_recipe"],
    "report": ["report"],
    "schema": ["schema"],
    "shapes": ["shapes", "composites", "doors"],
    "torques": ["torque", "torque_windows", "doors"],
    "": ["minimal", "doors", "stubs"],
}

# By the folder of a source in cpp/src.
CPP = {
    "attitude": ["attitude", "attitude_euler", "attitude_fits", "attitude_refusals"],
    "batch": ["batch", "batch_top", "directions", "summary", "draw", "solve_many", "solve_many_rk45",
              "solve_many_lanes", "batch_errors", "interrupts", "step", "gyrostat", "free_sensitivity",
              "driven_sensitivity", "lyapunov"],
    "core": ["minimal", "interrupts", "attitude_refusals"],
    "exact": ["free_motion", "heavy_top", "time_grid", "batch", "batch_top", "plan_exact", "gyrostat", "heavy_gyrostat",
              "damped_free", "pendulum", "free_sensitivity"],
    "formula": ["minimal"],   # its C++ tests see it; nothing of Python uses it yet
    "inertia": ["inertia", "principal_axes", "shapes", "mesh", "mesh_files", "diagnosis"],
    "math": ["elliptic", "free_motion"],
    "method": ["methods", "taylor", "taylor_invariants", "solve", "events", "rotors", "step"],
    "ode": ["methods", "events", "solve"],
    "scene": ["solve", "schema", "minimal", "rotors", "rotors_windows"],
    "solve": SOLVE,
    "torque": ["torque", "torque_windows", "methods"],
}


def python_tests(path):
    """The test files for a file of the package, by its path below python/polhode."""
    word = max((key for key in PYTHON if path.startswith(key)), key=len)
    return PYTHON[word]


def word_of(language, path):
    """The word under which a mutant is counted."""
    return path.removeprefix("cpp/src/").split("/")[0] if language == "C++" else (
        path.removeprefix("python/polhode/").split("/")[0].removesuffix(".py"))
