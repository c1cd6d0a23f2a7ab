"""How often the judge is right: random faults by cause, clean runs, and the cost. Seeds are arguments."""

import argparse
import json
import pathlib
import sys
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))

import spoiled

import polhode as ph


def right_size(case, finding):
    """Whether a finding's size is within 20 %; None where it has none to compare."""
    if case.cause == "integrator" or case.cause == "kinematics" and case.step and finding.order:
        return bool(finding.order == case.order and abs(finding.step / case.step - 1) < 0.2)
    if case.cause not in ("lag", "clock", "torque", "bias", "damping") or case.size is None:
        return None
    given, found = np.atleast_1d(case.size), np.atleast_1d(finding.size)
    return bool(given.shape == found.shape and np.linalg.norm(found - given) < 0.2 * np.linalg.norm(given))


def judged(case):
    return ph.judge(case.t, case.attitude, case.omega, tolerance=1e-10, **case.words)


def faults(seed, each, causes):
    """Yield one record for each case."""
    for number, cause in enumerate(spoiled.FAULTS):
        if cause not in causes:
            continue
        done = k = 0
        while done < each and k < 20 * each:
            rng = np.random.default_rng([seed, number, k])
            family = spoiled.FAMILIES[(k + number) % 5]
            k += 1
            case = spoiled.make(cause, family, [seed, number, k])
            if case is None:
                continue
            clean = judged(case)
            effect = max((f.effect for f in clean.findings), default=0.0)
            wanted = [1e-3, 1e-6, 0.0][done % 3]
            noise = next((n for n in (1e-3, 1e-6, 0.0) if n <= wanted and n <= effect / 5), 0.0)
            if effect < 1e-9:
                continue  # nothing is left of this fault after the best start
            case = spoiled.noisy(case, noise, rng)
            began = time.process_time()
            found = judged(case) if noise else clean
            spent = time.process_time() - began
            main = [f for f in found.findings if f.level != "remark"]
            said = main[0].cause if main else ""
            unsure = said in ("cannot tell", "") or said == "clock" and cause in main[0].rivals
            ok = said == cause or said in case.accepted
            done += 1
            yield {
                "cause": cause,
                "family": family,
                "noise": noise,
                "said": said,
                "effect": effect,
                "verdict": "right" if ok else "cannot tell" if unsure else "wrong",
                "seconds": spent,
                "k": k,
                "rivals": list(main[0].rivals) if main else [],
                "size": right_size(case, main[0]) if ok else None,
            }


def table(records):
    """A table by fault, in Markdown."""
    lines = ["| fault | right | cannot tell or silent | wrong | size within 20 % |", "|---|---|---|---|---|"]
    for cause in dict.fromkeys(r["cause"] for r in records):
        mine = [r for r in records if r["cause"] == cause]
        count = {v: sum(r["verdict"] == v for r in mine) for v in ("right", "cannot tell", "wrong")}
        sized = [r["size"] for r in mine if r["size"] is not None]
        lines.append(
            f"| {cause} | {count['right']} | {count['cannot tell']} | {count['wrong']} | "
            + (f"{sum(sized)} of {len(sized)} |" if sized else "|")
        )
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--each", type=int, default=8)
    parser.add_argument("--only", default="", help="one fault, or a part of all such as 1/3")
    parser.add_argument("--json", type=pathlib.Path, help="a file that gets a line for each run")
    given = parser.parse_args()
    part, _, parts = given.only.partition("/")
    own = spoiled.FAULTS[int(part) :: int(parts)] if parts else (given.only,) if given.only else spoiled.FAULTS
    causes = [c for c in spoiled.FAULTS if c in own]
    records = []
    for record in faults(given.seed, given.each, causes):
        records.append(record)
        if given.json:
            with given.json.open("a") as file:
                file.write(json.dumps(record) + "\n")
        if record["verdict"] != "right" or record["size"] is False:
            print(record, file=sys.stderr, flush=True)
    print(table(records))
    total = len(records)
    right = sum(r["verdict"] == "right" for r in records)
    sized = [r["size"] for r in records if r["size"] is not None]
    print(
        f"\n{right} of {total} right, {sum(r['verdict'] == 'wrong' for r in records)} wrong; "
        f"{sum(sized)} of {len(sized)} sizes within 20 %"
    )


if __name__ == "__main__":
    main()
