#!/usr/bin/env python3
"""Instructions that one camera ray costs: a scene rendered under callgrind with two counts of samples, and the
difference of the instructions over that of the rays.

What is done once (reading, building, encoding) falls out of the difference; what a machine does meanwhile does not
count. A scene pays only for the models that it uses: with --before, an older build of `heliograph`, the plain scene
must cost less than 1 % more than it did there, or the exit status is 1.
"""

import argparse
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

WIDTH, HEIGHT = 64, 48
MOST_MORE = 0.01


def ball(rings=48, sectors=96):
    """A mesh of triangles, without normals and coordinates: OBJ."""
    lines = []
    for ring in range(rings + 1):
        polar = math.pi * ring / rings
        for sector in range(sectors):
            turn = 2 * math.pi * sector / sectors
            place = math.sin(polar) * math.cos(turn), math.cos(polar), math.sin(polar) * math.sin(turn)
            lines.append("v %.6f %.6f %.6f" % place)
    for ring in range(rings):
        for sector in range(sectors):
            a, b = ring * sectors + sector + 1, ring * sectors + (sector + 1) % sectors + 1
            if ring > 0:
                lines.append(f"f {a} {b} {a + sectors}")
            if ring + 1 < rings:
                lines.append(f"f {b} {b + sectors} {a + sectors}")
    return "\n".join(lines) + "\n"


def scenes():
    plain = {
        "camera": {"position": [0, 0.5, 4], "look_at": [0, 0, 0], "fov_deg": 35},
        "environment": {"type": "none"},
        "materials": {"clay": {"type": "diffuse", "color": [0.7, 0.6, 0.5]}},
        "objects": [{"mesh": "ball.obj", "material": "clay"}],
        "lights": [{"type": "point", "position": [2, 3, 2], "intensity": [20, 20, 20]}],
        "transport": {"type": "direct"},
    }
    # One more model each: what it costs where it is used.
    lamp = {"type": "rectangle", "size": [1, 1], "radiance": [9, 9, 9], "transform": [{"translate": [0, 0, 3]}]}
    return {
        "one diffuse mesh, one point light": plain,
        "its light has a surface": {**plain, "lights": [lamp]},
        "it is of glass, paths": {
            **plain,
            "materials": {"clay": {"type": "glass"}},
            "environment": {"type": "color", "radiance": [1, 1, 1]},
            "transport": {"type": "path", "max_depth": 8},
        },
    }


def instructions(program, scene, samples, folder):
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/callgrind.out", program, "render"]
    command += [str(scene), "--quiet", "--threads", "1", "--samples", str(samples), "-o", f"{folder}/picture.png"]
    run = subprocess.run(command, cwd=folder, stderr=subprocess.PIPE, text=True, check=False)
    found = re.search(r"Collected\s*:\s*(\d+)", run.stderr)
    if run.returncode != 0 or found is None:
        sys.exit(f"{' '.join(command)} failed:\n{run.stderr}")
    return int(found.group(1))


def cost(program, scene, samples, folder):
    few, many = samples
    spent = instructions(program, scene, many, folder) - instructions(program, scene, few, folder)
    return spent / ((many - few) * WIDTH * HEIGHT)


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("program", help="the heliograph to measure")
    words.add_argument("--before", help="an older heliograph to hold it against")
    words.add_argument("--plain", action="store_true", help="only the scene that is held")
    words.add_argument("--samples", type=int, nargs=2, default=[8, 40], metavar=("FEW", "MANY"))
    options = words.parse_args()
    if not 0 < options.samples[0] < options.samples[1]:
        words.error("MANY must be above FEW")
    programs = [str(pathlib.Path(p).resolve()) for p in (options.program, options.before) if p]
    too_dear = False
    print("instructions a camera ray" + (", and before" if options.before else ""))
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "ball.obj").write_text(ball(), encoding="ascii")
        for number, (name, scene) in enumerate(list(scenes().items())[: 1 if options.plain else None]):
            job = pathlib.Path(folder, "scene.json")
            request = {"scene": scene, "image": {"width": WIDTH, "height": HEIGHT}}
            request["acceleration"] = {"bvh": {"split": "sah"}}  # the same tree, however many samples
            job.write_text(json.dumps(request), encoding="ascii")
            # What is not held need not be known to the older build.
            costs = [cost(p, job, options.samples, folder) for p in (programs if number == 0 else programs[:1])]
            line = f"{name:36} {costs[0]:9.1f}"
            if len(costs) > 1:
                more = costs[0] / costs[1] - 1
                too_dear = too_dear or more >= MOST_MORE
                line += f" {costs[1]:9.1f}  {100 * more:+.2f} %"
            print(line, flush=True)
    return 1 if too_dear else 0


sys.exit(main())
