"""Which tests belong to a word: folders of tests/python or files in them, and folders of C++ tests."""

# By the first parts of a path below python/polhode; the longest that fits holds.
PYTHON = {
    "_attitude": ["attitude", "api/arguments"],
    "_batch/closed_forms": ["batch/batch", "batch/batch_top", "batch/directions", "batch/summary", "api/arguments",
                            "api/minimal"],
    "_batch/broadcast": ["batch/batch", "batch/batch_top", "batch/directions", "batch/summary", "batch/solve_many",
                         "api/arguments"],
    "_batch/step": ["batch/step"],
    "_batch/solve_many": ["batch/solve_many", "batch/solve_many_rk45", "batch/solve_many_lanes", "batch/batch_errors",
                          "api/arguments", "process/interrupts"],
    "_batch": ["batch/solve_many", "batch/batch_errors", "process/interrupts"],
    "_ensemble": ["ensemble"],
    "_export": ["files/saved"],
    "_keywords": ["api/arguments", "solve/solve"],
    "_saved": ["files/saved", "ensemble/ensemble_store"],
    "_files": ["files/outputs", "files/hostile_files", "scene/schema", "inertia/mesh_files"],
    "_wings": ["repository/wings"],
    "_workers": ["process/workers", "charts/atlas", "charts/charts_limits", "ensemble/ensemble_engines"],
    "_xml": ["robots/robots", "robots/robots_real", "robots/robots_models", "inertia/mesh_files",
             "files/hostile_files", "files/fuzz"],
    "_harness": ["charts/charts", "charts/charts_peers", "charts/atlas", "charts/charts_limits"],
    "_plot/film": ["films"],
    "_plot/fit": ["derivative/fit", "derivative/fit_cli"],
    "_plot": ["plot/plot", "plot/pictures", "charts/charts", "charts/charts_limits"],
    "_sensitivity/driven": ["derivative/driven_sensitivity", "derivative/driven_fit"],
    "_sensitivity/lyapunov": ["derivative/lyapunov"],
    "_sensitivity/free": ["derivative/free_sensitivity"],
    "_sensitivity": ["derivative"],
    "_scene": ["scene/schema", "files/hostile_files", "inertia/cli_mesh", "api/minimal", "inertia/composites",
               "scene/homework", "solve/family", "api/arguments", "scene/scenes_reference", "torque/torque_windows",
               "solve/solve", "files/fuzz"],
    "_solve/costs": ["solve/plan", "solve/plan_limits", "files/hostile_files", "api/cli"],
    "_solve/calibrate": ["solve/plan", "files/hostile_files", "api/cli"],
    "_solve": ["solve/solve", "solve/plan", "solve/plan_exact", "solve/plan_limits", "api/arguments", "solve/pieces",
               "solve/method_switch", "solve/events", "solve/certificates", "api/minimal", "api/cli",
               "scene/scenes_reference"],
    "atlas": ["charts/atlas_verdicts", "charts/atlas_claims", "charts/atlas"],
    "charts": ["charts/charts_limits", "charts/charts_peers", "charts/charts_choice", "charts/charts_engines",
               "charts/charts_entrants", "charts/charts"],
    "cli": ["api/cli", "inertia/cli_mesh", "files/outputs", "charts/charts_choice", "charts/charts", "robots/robots",
            "robots/robots_ci", "charts/atlas", "charts/report", "derivative/fit_cli", "ensemble/ensemble_cli",
            "films", "repository/readme"],
    "elliptic": ["exact/elliptic", "api/arguments"],
    "inertia/robots": ["robots/robots", "robots/robots_real", "robots/robots_models", "robots/robots_ci",
                       "files/hostile_files", "files/fuzz"],
    "inertia": ["inertia/diagnosis", "inertia/inertia", "robots/robots", "robots/robots_real",
                "inertia/principal_axes", "inertia/shapes", "inertia/mesh", "api/arguments"],
    "measured": ["derivative/fit"],
    "mesh": ["inertia/mesh_files", "inertia/mesh", "files/hostile_files", "inertia/cli_mesh", "files/fuzz"],
    "recipe": ["ensemble/ensemble_recipe"],
    "report": ["charts/report"],
    "schema": ["scene/schema"],
    "shapes": ["inertia/shapes", "inertia/composites", "api/arguments"],
    "torques": ["torque", "api/arguments"],
    "": ["api/minimal", "api/arguments", "repository/stubs"],
}

# By the folder of a source in cpp/src.
CPP = {
    "attitude": ["attitude"],
    "batch": ["batch", "process/interrupts", "exact/gyrostat", "derivative/free_sensitivity",
              "derivative/driven_sensitivity", "derivative/lyapunov"],
    "core": ["api/minimal", "process/interrupts", "attitude/attitude_refusals"],
    "exact": ["exact", "batch/batch", "batch/batch_top", "solve/plan_exact", "derivative/free_sensitivity"],
    "formula": ["formula", "api/minimal"],
    "inertia": ["inertia/inertia", "inertia/principal_axes", "inertia/shapes", "inertia/mesh", "inertia/mesh_files",
                "inertia/diagnosis"],
    "math": ["exact/elliptic", "exact/free_motion"],
    "method": ["method", "solve/solve", "solve/events", "solve/rotors", "batch/step"],
    "ode": ["method/methods", "solve/events", "solve/solve"],
    "scene": ["solve/solve", "scene/schema", "api/minimal", "solve/rotors", "solve/rotors_windows"],
    "solve": ["solve", "method", "torque/torque_windows", "api/arguments"],
    "torque": ["torque", "method/methods"],
}


def python_tests(path):
    """The tests for a file of the package, by its path below python/polhode."""
    word = max((key for key in PYTHON if path.startswith(key)), key=len)
    return PYTHON[word]


def word_of(language, path):
    """The word under which a mutant is counted."""
    return path.removeprefix("cpp/src/").split("/")[0] if language == "C++" else (
        path.removeprefix("python/polhode/").split("/")[0].removesuffix(".py"))
