"""Are stated errors true? Random scenes of many kinds against their truth from outside; a claim for each accuracy.

Run: python benchmarks/planner/honesty.py [--count 16] [--seed 1] [--kinds heavy_fast mixed] [--accuracy 1e-6 1e-9]
     [--method taylor] [--workers 2] [--save rows.jsonl] [--json summary.json] [--markdown honesty.md] [--worst 10]

The truth is heyoka's series in long doubles. Where a stated error is less than twice the true one, the truth is made
again with 113 bits, another order and another tolerance, and that one counts. With --save each scene's claims are a
line of a file, and a second run goes on where the first one ended. Seed 2026 is kept for a last judgement: it asks for
--last.
"""

import argparse
import json
import multiprocessing
import pathlib
import time

from family import KINDS, compute_error, compute_truth, draw, missing
from honesty_report import list_worst, summarise, write_markdown, write_table

import polhode as ph

LAST = 2026
MOST_STEPS = 300_000
MOST_CALLED = 10_000   # steps of scenes whose torques are Python functions


def measure(run):
    """What it returns and the CPU time it takes: the least of three, of one when that is long."""
    motion, took = None, []
    while not took or (len(took) < 3 and took[0] < 5e-3):
        start = time.thread_time()
        motion = run()
        took.append(time.thread_time() - start)
    return motion, min(took)


def most_steps(scene):
    return MOST_CALLED if any(isinstance(torque, ph.torques.Custom) for torque in scene.torques) else MOST_STEPS


def find_plain(scene, accuracy, known):
    """A method that meets the accuracy in one run at a tight tolerance; empty where none does."""
    for method in ("taylor", "dop853", "radau"):
        for rtol in (accuracy / 100, 1e-13, 1e-15):
            try:
                motion = ph.solve(scene, method=method, rtol=rtol, max_steps=most_steps(scene) // 10)
            except ph.InvalidInput:   # a method that does not take the scene
                break
            if motion.status == "finished" and compute_error(motion, known) <= accuracy:
                return f"{method} {rtol:.0e}"
    return ""


def judge_claim(drawn, accuracy, method, known, again):
    """One claim as a dict; `again` makes the truth of 113 bits."""
    steps = most_steps(drawn.scene)
    motion, took = measure(lambda: ph.solve(drawn.scene, accuracy, method=method, max_steps=steps))
    found, sure = compute_error(motion, known), None
    if motion.error_kind in ("bounded", "limit") and found > 0.5 * motion.error:
        better = again()
        sure = better is not None
        found = compute_error(motion, better) if sure else found
    row = {"accuracy": accuracy, "success": motion.success, "status": motion.status, "error_kind": motion.error_kind,
           "error": motion.error, "found": found, "sure": sure, "runs": motion.stats["runs"], "took": took,
           "method": "pieces" if motion.plan.pieces else motion.plan.method,
           "predicted": motion.plan.predicted_seconds, "steps": motion.stats["steps"]}
    if motion.error_kind == "limit":
        row["plain"] = find_plain(drawn.scene, accuracy, known)
    return row


def judge(task):
    """All claims of one scene."""
    seed, kind, index, accuracies, method = task
    start = time.process_time()
    drawn = draw(seed, kind, index)
    known = compute_truth(drawn.scene)
    row = {"kind": kind, "index": index, "parts": drawn.parts, "samples": len(drawn.scene.times), "claims": []}
    kept = []

    def again():
        kept[:] = kept or [compute_truth(drawn.scene, "quad", 20_000)]
        return kept[0]

    if known is not None:
        for accuracy in accuracies or drawn.accuracies:
            try:
                row["claims"].append(judge_claim(drawn, accuracy, method, known, again))
            except ph.InvalidInput as refusal:   # a method of the user's choice that does not take the scene
                row["refused"] = str(refusal)
    return row | {"seconds": time.process_time() - start}


def read(path, about):
    """The rows of a file that an earlier run of the same options has begun."""
    if path is None or not path.exists():
        return []
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    if lines[0] != about:
        raise SystemExit(f"{path} is of other options: {lines[0]}")
    return lines[1:]


def collect(options):
    """Judge what a file does not have yet, and return all rows."""
    about = {"seed": options.seed, "accuracy": options.accuracy, "method": options.method}
    rows = [row for row in read(options.save, about) if row["kind"] in options.kinds and row["index"] < options.count]
    done = {(row["kind"], row["index"]) for row in rows}
    tasks = [(options.seed, kind, index, options.accuracy, options.method) for index in range(options.count)
             for kind in options.kinds if (kind, index) not in done]
    if options.save and not options.save.exists():
        options.save.write_text(json.dumps(about) + "\n")
    with multiprocessing.Pool(options.workers) as pool:
        for row in pool.imap_unordered(judge, tasks, chunksize=4):
            rows.append(row)
            if options.save:
                with options.save.open("a") as file:
                    file.write(json.dumps(row) + "\n")
    return sorted(rows, key=lambda row: (KINDS.index(row["kind"]), row["index"]))


def read_options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS), metavar="KIND")
    parser.add_argument("--count", type=int, default=16, help="scenes of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--last", action="store_true", help=f"allows seed {LAST}")
    parser.add_argument("--accuracy", type=float, nargs="+", help="in place of three drawn from 1e-3 to 1e-12")
    parser.add_argument("--method")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--save", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--markdown", type=pathlib.Path)
    parser.add_argument("--worst", type=int, default=10, help="how many false bounds stand in the JSON file, as Python")
    options = parser.parse_args()
    if options.seed == LAST and not options.last:
        parser.error(f"seed {LAST} is kept for a last judgement")
    if missing():
        parser.error(missing())
    return options


def main():
    options = read_options()
    rows = collect(options)
    summary = summarise(rows, options.seed)
    print(write_table(summary))
    if options.json:
        summary["worst"] = list_worst(rows, options.seed, options.worst)
        options.json.write_text(json.dumps(summary, indent=1) + "\n")
    if options.markdown:
        options.markdown.write_text(write_markdown(summary))


if __name__ == "__main__":
    main()
