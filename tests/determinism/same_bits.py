#!/usr/bin/env python3
"""Runs a program twice, the second time as on a processor without FMA, AVX2 and FMA4, and compares what it prints.

glibc chooses other variants of its mathematical functions there, some of which round differently.
"""

import os
import subprocess
import sys

TUNABLES = "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4,-AVX2_Usable,-FMA_Usable,-FMA4_Usable"


def printed(program, **environment):
    run = subprocess.run([program], env={**os.environ, **environment}, stdout=subprocess.PIPE, text=True, check=True)
    return run.stdout.splitlines()


def main():
    program = sys.argv[1]
    here, old = printed(program), printed(program, GLIBC_TUNABLES=TUNABLES)
    sinks = {line for line in here if line.startswith("kitchen_sink")}
    if len(sinks) != 1:
        print("threads or tiles change the picture:", *sinks, sep="\n  ")
        return 1
    different = [(a, b) for a, b in zip(here, old) if a != b]
    for a, b in different:
        print(f"here: {a}\nwithout FMA: {b}")
    if different or len(here) != len(old) or not here:
        return 1
    print(f"{len(here)} digests are the same without FMA")
    return 0


sys.exit(main())
