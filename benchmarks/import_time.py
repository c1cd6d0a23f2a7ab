"""What `import polhode` costs over NumPy's own import, in fresh interpreters.

    python benchmarks/import_time.py [--repeat 21]

NumPy is imported first, so polhode's line is what it adds. On a busy machine the processor's time tells more than the
clock.
"""

import argparse
import statistics
import subprocess
import sys

PROGRAM = """
import time
def now():
    return time.perf_counter(), time.process_time()
start = now()
import numpy
middle = now()
import polhode
end = now()
print(*(b - a for first, last in ((start, middle), (middle, end)) for a, b in zip(first, last)))
"""


def measure():
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True)
    return [1e3 * float(seconds) for seconds in done.stdout.split()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=21)
    measure()   # fills the caches of bytecode and of the file system
    runs = [measure() for _ in range(parser.parse_args().repeat)]
    print(f"{'import':8} {'clock: median':>14} {'least':>6} {'processor: median':>18} {'least':>6}   [ms]")
    columns = list(zip(*runs))
    for name, clock, processor in (("numpy", *columns[:2]), ("polhode", *columns[2:])):
        print(f"{name:8} {statistics.median(clock):14.1f} {min(clock):6.1f} {statistics.median(processor):18.1f} "
              f"{min(processor):6.1f}")


if __name__ == "__main__":
    main()
