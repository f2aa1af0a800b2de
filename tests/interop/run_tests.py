"""Runs each test module here in a process of its own, because the libraries bring their own OpenMP.

The last line has the form of ctest's summary.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

import sample

FOLDER = pathlib.Path(__file__).parent
FIGURES = re.compile(r"(?<!expected )(failures|errors|skipped|unexpected successes)=(\d+)")


def run_module(module: str) -> tuple[int, int, int]:
    """The numbers of tests, of failures and of skipped tests. A module that ends early is a failure."""
    run = subprocess.run([sys.executable, "-m", "unittest", "-v", module], cwd=FOLDER, text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(run.stdout, end="", flush=True)
    count = re.search(r"^Ran (\d+) tests? in", run.stdout, re.MULTILINE)
    figures = {name: int(number) for name, number in FIGURES.findall(run.stdout.rpartition("\n\n")[2])}
    skipped = figures.pop("skipped", 0)
    failures = sum(figures.values())
    if not count or (run.returncode != 0 and failures == 0):
        print(f"interop: {module} ended with exit code {run.returncode}")
        return 1, 1, 0
    return int(count[1]), failures, skipped


def main() -> int:
    tests = failures = skipped = 0
    with tempfile.TemporaryDirectory(prefix="fovea_interop_") as folder:
        sample.share(folder)
        for path in sorted(FOLDER.glob("test_*.py")):
            print(f"== {path.stem}", flush=True)
            result = run_module(path.stem)
            tests, failures, skipped = (a + b for a, b in zip((tests, failures, skipped), result))
    if skipped:
        print(f"{skipped} tests skipped")
    print(f"{100 * (tests - failures) // max(tests, 1)}% tests passed, {failures} tests failed out of {tests}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
