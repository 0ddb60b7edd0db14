#!/usr/bin/env python3
"""Memory of whole renders by the CLI: what the plan foretells beside the peak of what the system counts.

    tests/bench/job_memory.py build/release/bin/heliograph SCENE.json...

What the program takes for a picture of one pixel is taken off first. Scenes are rendered as they are, so choose few samples.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

NOTHING = {"scene": {"objects": [{"shape": "sphere"}]}, "image": {"width": 1, "height": 1}, "quality": {"samples": 1}}


def peak_bytes(program, scene, folder):
    """Of one process: os.wait4 tells that child's own."""
    child = subprocess.Popen([program, "render", "--quiet", scene, "-o", folder / "picture.png"])
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{scene}: render ended with {status}")
    return usage.ru_maxrss * 1024


def main():
    program, scenes = sys.argv[1], sys.argv[2:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        nothing = folder / "nothing.json"
        nothing.write_text(json.dumps(NOTHING))
        base = peak_bytes(program, nothing, folder)
        print(f"{'scene':32} {'foretold MB':>12} {'peak MB':>10} {'ratio':>6}   (the program itself: {base / 1e6:.1f} MB)")
        for scene in scenes:
            plan = json.loads(subprocess.check_output([program, "plan", scene]))
            foretold, peak = plan["prediction"]["memory_bytes"], peak_bytes(program, scene, folder) - base
            print(f"{pathlib.Path(scene).stem[-32:]:32} {foretold / 1e6:12.1f} {peak / 1e6:10.1f} {foretold / peak:6.2f}")


if __name__ == "__main__":
    main()
