#!/usr/bin/env python3
"""Instructions and cache lines that one ray of `heliograph-bench rays` costs, beside Embree, under callgrind.

    tests/bench/ray_cost.py build/release/bin/heliograph-bench --mesh bunny.obj

Every engine traces a set twice; the second time is told, as its caches have been filled by then. Nothing but the
tracing is counted, and what others do on the machine does not count. Two levels of caches are simulated, of sizes that
are told, so that figures of different machines agree. Valgrind knows no AVX-512: all engines run as on a processor
without.
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ENGINES = ["Heliograph", "Embree, single rays", "Embree, packets of 16"]
TRIGGER = "desc: Trigger: Client Request: "
LEAST = 0.005  # of a thing a ray, to be compared with
# What is told, and the events of callgrind that add up to it.
FIGURES = {
    "instructions": ["Ir"],
    "reads_and_writes": ["Dr", "Dw"],
    "lines_into_first_level": ["D1mr", "D1mw"],
    "lines_into_last_level": ["DLmr", "DLmw"],
}


def run_under_callgrind(options, folder):
    """The report of the program; its dumps are in the folder afterwards."""
    # Where things lie in memory decides what they evict: the same places every time, and no other threads.
    command = ["setarch", "-R", "valgrind", "--tool=callgrind", "--cache-sim=yes", "--instr-atstart=no"]
    command += [f"--I1={options.first}", f"--D1={options.first}", f"--LL={options.last}"]
    command += [f"--callgrind-out-file={folder}/dump", options.program, "rays", "--json", f"{folder}/rays.json"]
    command += ["--threads", "1", "--repeats", "1", "--builds", "0", "--every", str(options.every)]
    command += ["--mesh", options.mesh] if options.mesh else ["--terrain", str(options.terrain)]
    command += ["--view", options.view, "--peer", "embree", "--engines", *options.engines]
    if options.only:
        command += ["--only", options.only]
    for program in command[0], command[2]:
        if shutil.which(program) is None:
            sys.exit(f"there is no {program} here")
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{run.stdout}{run.stderr}")
    return json.loads(pathlib.Path(folder, "rays.json").read_text(encoding="utf-8"))


def line_after(text, start, path):
    found = re.findall(f"^{re.escape(start)}(.*)$", text, re.MULTILINE)
    if len(found) != 1:
        sys.exit(f"{path} has {len(found)} lines that begin with '{start}', not one")
    return found[0]


def read_dump(path, options):
    """What a dump is of, and its events; none where the program did not ask for it."""
    text = path.read_text(encoding="utf-8")
    if TRIGGER not in text:
        return None
    for level, asked in ("D1", options.first), ("LL", options.last):
        size, ways, line = asked.split(",")
        simulated = line_after(text, f"desc: {level} cache: ", path)
        if simulated != f"{size} B, {line} B, {ways}-way associative":
            sys.exit(f"{path} has simulated {simulated} instead of {asked}")
    label = json.loads(line_after(text, TRIGGER, path))
    names = line_after(text, "events: ", path).split()
    # Not those of `summary:`, which callgrind gets wrong once some were dumped. Zeros at the end are not written.
    counts = [int(count) for count in line_after(text, "totals: ", path).split()]
    wanted = [name for events in FIGURES.values() for name in events]
    if len(counts) > len(names) or set(wanted) - set(names):
        sys.exit(f"{path} counts {names}: {counts}")
    events = dict(zip(names, counts + [0] * (len(names) - len(counts))))
    if events["Ir"] <= 0 or label["rays"] <= 0:
        sys.exit(f"{path} has counted nothing of {label}")
    return label, {name: events[name] for name in wanted}


def read_dumps(folder, report, options):
    """By set and engine: rays, and events with caches that were cold and warm. All that the report names."""
    found = {}
    for path in pathlib.Path(folder).glob("dump.*"):
        dump = read_dump(path, options)
        if dump is None:
            continue
        label, events = dump
        row = found.setdefault((label["set"], label["engine"]), {"rays": label["rays"]})
        if label["caches"] in row or row["rays"] != label["rays"]:
            sys.exit(f"{path} is the second of {label}")
        row[label["caches"]] = events
    if not found:
        sys.exit("nothing was counted: was the program built where valgrind's headers are?")
    rows = {}
    for engine in report["cases"][0]["engines"]:
        for figures in engine["rays"]:
            key = figures["set"], engine["name"]
            row = found.get(key, {})
            if set(row) != {"rays", "cold", "warm"} or row["rays"] != figures["rays"]:
                sys.exit(f"no count of {' by '.join(key)}, {figures['rays']} rays, but {row}")
            rows.setdefault(key[0], {})[key[1]] = row
    return rows


def a_ray(row, events):
    return {figure: sum(row[events][name] for name in names) / row["rays"] for figure, names in FIGURES.items()}


def the_peer(rows, text):
    """The engine that is called so; None where there is none, or several."""
    names = list(next(iter(rows.values())))
    peers = [name for name in names if name == text] or [name for name in names if text.lower() in name.lower()]
    return peers[0] if len(peers) == 1 else None


def costs_of(rows, peer):
    """As the JSON has them: a list of sets. No ratio where there is no peer, or it has as good as none of a thing."""
    sets = []
    for name, engines in rows.items():
        base = a_ray(engines[peer], "warm") if peer else dict.fromkeys(FIGURES, 0)
        told = {"set": name, "engines": []}
        for engine, row in engines.items():
            costs, cold = a_ray(row, "warm"), a_ray(row, "cold")
            over = {figure: costs[figure] / base[figure] for figure in FIGURES if base[figure] > LEAST}
            counts = {"rays": row["rays"], "a_ray": costs, "over_peer": over, "a_ray_with_cold_caches": cold}
            told["engines"].append({"name": engine, **counts})
        sets.append(told)
    return sets


def print_costs(sets, peer):
    print("a ray" + (f", and over {peer}" if peer else ""))
    for told in sets:
        title = f"{told['set']}, {told['engines'][0]['rays']} rays"
        print(f"\n{title:38}" + "".join(f"{name.replace('_', ' '):>24}" for name in FIGURES))
        for engine in told["engines"]:
            line = f"{engine['name']:38}"
            for figure, cost in engine["a_ray"].items():
                over = engine["over_peer"].get(figure)
                line += f"{cost:17.{0 if figure == 'instructions' else 2}f}"
                line += f"{'-':>7}" if over is None else f"{over:7.2f}"
            print(line)


def main():
    words = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], formatter_class=argparse.ArgumentDefaultsHelpFormatter
    )
    words.add_argument("program", help="the heliograph-bench to measure")
    mesh = words.add_mutually_exclusive_group(required=True)
    mesh.add_argument("--mesh", help="mesh file")
    mesh.add_argument("--terrain", type=int, help="instead of a file: a terrain of so many triangles")
    words.add_argument("--view", choices=["object", "nave"], default="object")
    words.add_argument("--every", type=int, default=8, help="of so many runs of 4096 rays one is traced")
    words.add_argument("--only", help="ray sets: primary,shadow,diffuse,...")
    words.add_argument("--engines", nargs="+", default=ENGINES, metavar="TEXT", help="those whose name contains one")
    words.add_argument("--over", default=ENGINES[-1], metavar="TEXT", help="the peer")
    words.add_argument("--first", default="32768,8,64", help="caches of the first level: bytes, ways, bytes of a line")
    words.add_argument("--last", default="1048576,8,64", help="the cache behind them, as a core may have to itself")
    words.add_argument("--json", help="figures into this file as well")
    options = words.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        report = run_under_callgrind(options, folder)
        rows = read_dumps(folder, report, options)
    case = report["cases"][0]
    name = pathlib.Path(case["mesh"]).name
    print(f"{name}, {options.view} view: {case['triangles']} triangles; of {options.every} runs of rays one")
    print(f"caches {options.first} and {options.last}; no AVX-512")
    peer = the_peer(rows, options.over)
    sets = costs_of(rows, peer)
    print_costs(sets, peer)
    if options.json:
        told = {"format": "heliograph ray_cost 1", "mesh": name, "view": options.view, "triangles": case["triangles"]}
        told |= {"every": options.every, "first_level": options.first, "last_level": options.last, "peer": peer}
        pathlib.Path(options.json).write_text(json.dumps({**told, "sets": sets}, indent=2) + "\n", encoding="utf-8")
    if peer is None:
        names = "; ".join(next(iter(rows.values())))
        sys.exit(f"'{options.over}' is not the name of one engine: {names}")
    return 0


sys.exit(main())
