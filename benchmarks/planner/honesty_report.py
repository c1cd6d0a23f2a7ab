"""What honesty.py found, as numbers, as a table and as a page."""

import math
import pathlib

import numpy as np
from family import KINDS, draw, write_python

from polhode._harness.machine import machine

HEADS = ("", "claims", "false", "> 2x", "worst", "beyond asked", "stated / true: 2.5 %, median, 97.5 %", "1 to 100",
         "refused", "needless", "limits false", "runs", "foreseen / taken: 5 %, median, 95 %", "within 3")
GROUPS = ("kinds", "methods", "accuracies", "runs")


def compute_ratios(upper, lower):
    found = np.array([a / b for a, b in zip(upper, lower, strict=True) if a > 0 and b > 0])
    return found if found.size else np.array([np.nan])


def measure(claims):
    """The numbers of some claims. A claim is a success whose error is called bounded; a limit is a refusal."""
    made = [c for c in claims if c["success"] and c["error_kind"] == "bounded"]
    false = [c for c in made if not c["found"] <= c["error"]]
    limits = [c for c in claims if c["error_kind"] == "limit"]
    beyond = [c["found"] / c["error"] for c in false if c["error"] > 0]
    kept = compute_ratios([c["error"] for c in made], [c["found"] for c in made])
    clock = compute_ratios([c["predicted"] for c in made], [c["took"] for c in made])
    return {"claims": len(made), "false": len(false), "false_not_confirmed": sum(c["sure"] is False for c in false),
            "beyond_2": sum(b > 2 for b in beyond), "worst": max(beyond, default=0.0),
            "beyond_asked": sum(not c["found"] <= c["accuracy"] for c in made),
            "stated_over_true": [float(v) for v in np.quantile(kept, (0.025, 0.5, 0.975))],
            "within_1_to_100": float(np.mean((kept >= 1) & (kept <= 100))),
            "others": len(claims) - len(made) - len(limits), "refused": len(limits),
            "needless": sum(c["found"] <= c["accuracy"] or bool(c["plain"]) for c in limits),
            "needless_as_it_was": sum(c["found"] <= c["accuracy"] for c in limits),
            "limits_false": sum(not c["found"] <= c["error"] for c in limits),
            "limits_worst": max((c["found"] / c["error"] for c in limits if c["error"] > 0), default=0.0),
            "runs": float(np.mean([c["runs"] for c in claims])) if claims else 0.0,
            "foreseen_over_taken": [float(v) for v in np.quantile(clock, (0.05, 0.5, 0.95))],
            "foreseen_within_3": float(np.mean((clock >= 1 / 3) & (clock <= 3)))}


def summarise(rows, seed):
    """All numbers: of all claims, by kind, by method, by the accuracy's power of ten and by the number of runs."""
    claims = [c for row in rows for c in row["claims"]]

    def group(key):
        return {name: measure([c for c in claims if key(c) == name]) for name in sorted({key(c) for c in claims})}

    kinds = {kind: [c for row in rows if row["kind"] == kind for c in row["claims"]] for kind in KINDS}
    return {"machine": machine(), "seed": seed, "scenes": len(rows),
            "without_truth": sum(not row["claims"] and "refused" not in row for row in rows),
            "seconds": sum(row["seconds"] for row in rows), "all": measure(claims),
            "kinds": {kind: measure(some) for kind, some in kinds.items() if some},
            "methods": group(lambda c: c["method"]),
            "accuracies": group(lambda c: f"1e{math.floor(math.log10(c['accuracy'])):03d}"),
            "runs": group(lambda c: f"runs: {c['runs']}")}


def write_cells(name, found):
    def percent(value):
        return "" if math.isnan(value) else f"{100 * value:.0f} %"

    def several(values):
        return "" if math.isnan(values[0]) else ", ".join(f"{v:.2g}" for v in values)

    counts = [str(found[key]) for key in ("refused", "needless", "limits_false")]
    return (name, f"{found['claims']}", f"{found['false']}", f"{found['beyond_2']}", f"{found['worst']:.3g}",
            f"{found['beyond_asked']}", several(found["stated_over_true"]), percent(found["within_1_to_100"]), *counts,
            f"{found['runs']:.2f}", several(found["foreseen_over_taken"]), percent(found["foreseen_within_3"]))


def list_cells(summary):
    yield write_cells("all", summary["all"])
    for group in GROUPS:
        yield from (write_cells(name, found) for name, found in summary[group].items())


def write_table(summary):
    rows = [HEADS, *list_cells(summary)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEADS))]
    lines = ["  ".join(f"{cell:<{width}}" if i == 0 else f"{cell:>{width}}"
                       for i, (cell, width) in enumerate(zip(row, widths, strict=True))) for row in rows]
    whole, seconds = summary["all"], summary["seconds"]
    lines.append(f"{summary['scenes']} scenes of seed {summary['seed']}, {summary['without_truth']} without truth in "
                 f"reach; {whole['others']} results neither claimed nor refused; {whole['false_not_confirmed']} false "
                 f"bounds not confirmed; {seconds:.0f} s of CPU, {whole['claims'] / seconds:.1f} claims a second")
    return "\n".join(lines)


def write_markdown(summary):
    """The page of docs/results."""
    whole = summary["all"]
    head = f"""# Results of the certificates

These are the measurements behind [certificates](../notes/certificates.md). The command is
`python benchmarks/planner/honesty.py`. It draws random scenes of {len(summary["kinds"])} kinds and compares each stated
error with the true one. Each scene is solved at three accuracies from 1e-3 to 1e-12. The truth is a Taylor series of
heyoka in long double. Claims close to false are judged again with 113 bits. The processor was
{summary["machine"]["processor"]}.

- {summary["scenes"]} scenes of seed {summary["seed"]} made {whole["claims"]} claims. {summary["without_truth"]} scenes
  had no truth in reach.
- {whole["false"]} stated bounds are false ({100 * whole["false"] / max(1, whole["claims"]):.2f} %). {whole["beyond_2"]}
  of them are false by more than twice. {whole["beyond_asked"]} errors are beyond the accuracy asked.
- Where a run is refused, {whole["limits_false"]} of {whole["refused"]} stated limits are false, the worst by
  {whole["limits_worst"]:.2g}.
- {whole["needless"]} refusals are needless. The run itself or a plain run of a named method met the accuracy.

"Foreseen / taken" is the plan's time over the CPU time of `solve`.

"""
    lines = ["| " + " | ".join(row) + " |" for row in (HEADS, *list_cells(summary))]
    table = "\n".join([lines[0], "|---" * len(HEADS) + "|", *lines[1:]]) + "\n"
    return head + table + pathlib.Path(__file__).with_name("variants.md").read_text()


def list_worst(rows, seed, count):
    """False bounds, then false limits, as Python that makes them again, the worst first."""
    found = []
    for row in rows:
        for claim in row["claims"]:
            if claim["error_kind"] in ("bounded", "limit") and not claim["found"] <= claim["error"]:
                worse = claim["found"] / claim["error"] if claim["error"] > 0 else math.inf
                found.append((claim["error_kind"], worse, row, claim))
    found.sort(key=lambda one: -one[1])
    made = []
    for kind in ("bounded", "limit"):
        for _, worse, row, claim in [one for one in found if one[0] == kind][:count]:
            scene = draw(seed, row["kind"], row["index"]).scene
            made.append({"seed": seed, "kind": row["kind"], "index": row["index"], "parts": row["parts"]} | claim |
                        {"true_over_stated": worse, "scene": write_python(scene)})
    return made
