#!/usr/bin/env python3
"""Of its rays heliograph-bench traces as many as it is told to, by the engines that are named, and tells of no builds
where none are asked for. Of its figures nothing is asked."""

import json
import subprocess
import sys

RUN = 4096


def rays(bench, *options):
    command = [bench, "rays", "--terrain", "1000", "--repeats", "1", "--only", "primary", *options]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def engine_of(run):
    assert run.returncode == 0, run.stderr
    assert "NaN" not in run.stdout and "null" not in run.stdout, "a figure is none"
    return json.loads(run.stdout)["cases"][0]["engines"][0]


def main(bench):
    whole = engine_of(rays(bench, "--json", "-"))
    assert len(whole["builds"]) == 1, "builds are not timed by themselves"
    assert whole["rays"][0]["rays"] == 1024 * 1024
    part = engine_of(rays(bench, "--json", "-", "--every", "100", "--builds", "0", "--engines", "HELIOGRAPH"))
    assert part["builds"] == [], "builds that nobody asked for"
    assert part["rays"][0]["rays"] == 3 * RUN, f"{part['rays'][0]['rays']} rays"
    table = rays(bench, "--every", "100", "--builds", "0").stdout
    assert "of 100 runs of rays one" in table and "nan" not in table and "inf" not in table, table
    unknown = rays(bench, "--engines", "no such engine")
    assert unknown.returncode == 1 and part["name"] in unknown.stderr, unknown.stderr


main(sys.argv[1])
