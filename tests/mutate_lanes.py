#!/usr/bin/env python3
"""Changes the translator of plain kernels on purpose and reports the changes that no test notices.

    tests/mutate_lanes.py [--check] [--only WORD] [BUILD]

Makes the changes of tests/lanes_changes.txt in host/lanes, one at a time, builds the tests of BUILD (default build/release) and runs
those of lanes. The sources are put back whatever happens. --check: only see that each change fits its file. Exit status 0 when all are noticed."""
import os, pathlib, subprocess, sys

root = pathlib.Path(__file__).resolve().parent.parent


def changes():
    """(file, what, old, new) of each row."""
    for block in (root / "tests/lanes_changes.txt").read_text().split("\n## ")[1:]:
        head, *lines = block.split("\n")
        file, what = head.split(": ", 1)
        part = lambda sign: "\n".join(line[2:] for line in lines if line.startswith(sign + " "))
        yield root / "host/lanes" / file, what, part("-"), part("+")


def result(build):
    made = subprocess.run(["cmake", "--build", build, "--target", "unit_tests", "device_tests"], capture_output=True)
    if made.returncode:  # the host compiles halos in lanes, too: a compiler may refuse what is made of them
        return "noticed" if b"halo_lanes.inc" in made.stdout else "DOES NOT BUILD"
    environment = dict(os.environ, SUNDOG_TEST_DEVICES=os.environ.get("SUNDOG_TEST_DEVICES", "pocl"))
    for program, tests in (("unit_tests", "[#test_lanes_text],[#test_lanes_refused]"), ("device_tests", "[#test_lanes]")):
        try:
            run = subprocess.run([f"{build}/tests/{program}", "-#", tests], capture_output=True, env=environment, timeout=400)
        except subprocess.TimeoutExpired:
            return "noticed"
        if run.returncode:
            return "noticed"
    return "NOT NOTICED"


def main():
    if "--help" in sys.argv:
        return print(__doc__)
    words = [a for a in sys.argv[1:] if not a.startswith("--")]
    only = words.pop(0) if "--only" in sys.argv else ""
    build = words[0] if words else str(root / "build/release")
    bad = total = 0
    for file, what, old, new in changes():
        text = file.read_text()
        if text.count(old) != 1:
            print(f"DOES NOT FIT   {file.name}: {what}: its text is there {text.count(old)} times")
            bad += 1
            continue
        if "--check" in sys.argv or only not in f"{file.name} {what}":
            continue
        total += 1
        try:
            file.write_text(text.replace(old, new))
            found = result(build)
        finally:
            file.write_text(text)
        bad += found != "noticed"
        print(f"{found:14} {file.name}: {what}", flush=True)
    print(f"{total} changes, {bad} not noticed")
    return 6 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
