"""Times what a call from Python costs beside the library's own time, the import, and arrays that are asked for.

    python benches/overhead.py
"""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys
import time

import gelbench as gb


def milliseconds(work):
    start = time.perf_counter()
    found = work()
    return 1e3 * (time.perf_counter() - start), found


def main():
    for cells, repeats in [((60, 20), 20), ((600, 200), 3)]:
        plate = gb.Plate(material="pva-10", cells=cells)
        calls, beside, first, again = [], [], [], []
        for _ in range(repeats):
            took, solution = milliseconds(lambda: plate.solve("corrected", 0.5))  # noqa: B023
            calls.append(took)
            beside.append(took - 1e3 * solution.seconds)
            first.append(milliseconds(lambda: solution.displacement)[0])  # noqa: B023
            again.append(milliseconds(lambda: solution.displacement)[0])  # noqa: B023
        own = (statistics.median(values) for values in (calls, beside, first, again))
        print(
            f"{len(solution.points):7} nodes: a call {next(own):9.1f} ms, of which not in the library {next(own):6.2f} ms; "
            f"displacement {1e3 * next(own):.0f} µs, again {1e3 * next(own):.0f} µs"
        )
    for name, program in {"nothing": "pass", "numpy": "import numpy", "gelbench": "import gelbench"}.items():
        wall, processor = [], []
        for _ in range(15):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            wall.append(milliseconds(lambda: subprocess.run([sys.executable, "-c", program], check=True))[0])  # noqa: B023
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            processor.append(1e3 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime))
        print(
            f"starting Python with {name:8}: {min(wall):4.0f} ms at best, {statistics.median(wall):4.0f} in the middle; "
            f"{statistics.median(processor):4.0f} ms of the processor"
        )


if __name__ == "__main__":
    main()
