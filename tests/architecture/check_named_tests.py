#!/usr/bin/env python3
"""Every test that tests/renderer/README.md names is there, and every case T1 to T37 has one."""
import pathlib
import re
import sys

tests = pathlib.Path(__file__).resolve().parent.parent
defined = {
    ".".join(found)
    for source in tests.rglob("*_test.cpp")
    for found in re.findall(
        r"^(?:TEST|TEST_P|TEST_F|TYPED_TEST)\((\w+),\s*(\w+)\)", source.read_text(), re.M
    )
}
faults = []
cases = set()
for line in (tests / "renderer/README.md").read_text().splitlines():
    row = re.match(r"\| (T\d+) \|.*\|(.*)\|$", line)
    if not row:
        continue
    cases.add(row[1])
    names = re.findall(r"`(\w+\.\w+)`", row[2])
    if not names:
        faults.append(f"{row[1]} names no test")
    faults += [f"{row[1]} names {name}, which is not there" for name in names if name not in defined]
faults += [f"T{i} is missing" for i in range(1, 38) if f"T{i}" not in cases]
print("\n".join(faults) or f"{len(cases)} cases, all held")
sys.exit(bool(faults))
