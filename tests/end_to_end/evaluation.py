#!/usr/bin/env python3
"""The evaluation of small pictures runs to its end and leaves five charts and a table in which every picture is the
same. Of its figures nothing is asked."""

import json
import pathlib
import subprocess
import sys
import tempfile

CHARTS = ["bounding_boxes", "hierarchies", "growth", "threads", "overall"]


def pictures(part):
    """Every `same_picture` below a part of the table."""
    if isinstance(part, dict):
        found = [part["same_picture"]] if "same_picture" in part else []
        return found + [same for member in part.values() for same in pictures(member)]
    if isinstance(part, list):
        return [same for member in part for same in pictures(member)]
    return []


def main(bench):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        subprocess.run([bench, "evaluation", "--repeats", "1", "--width", "8", "--out", out], check=True)
        for chart in CHARTS:
            assert "<svg" in (out / f"{chart}.svg").read_text(), f"{chart}.svg is no picture"
        table = json.loads((out / "evaluation.json").read_text())
    same = pictures(table)
    assert len(same) > 20, f"only {len(same)} pictures were compared"
    assert all(same), "a picture differs"


main(sys.argv[1])
