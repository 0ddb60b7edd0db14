#!/usr/bin/env python3
"""Every source of the programs and of the renderer's tests compiles for 64-bit ARM, Highway's NEON kernels included.

Usage: check_arm64.py [FILES...]   (./dev lint --arm64)

Compiled, not linked: the libraries of that architecture are not wanted. Their headers are the same everywhere, but for
OpenSSL's configuration, which lies in the folder of this machine's architecture: that is looked into last, so that no
other header comes from there.
"""
import concurrent.futures
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ["renderer/*.cpp", "api/*.cpp", "server/*.cpp", "clients/*.cpp", "tests/renderer/*.cpp"]
WARNINGS = "-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Wold-style-cast -Wno-restrict"
DEFINITIONS = ["JSON_USE_IMPLICIT_CONVERSIONS=0", "SPDLOG_COMPILED_LIB", "SPDLOG_FMT_EXTERNAL"] + [
    f'HELIOGRAPH_{name}_DIR=""' for name in ("SOURCE", "ASSET", "BIN")]


def words_of(*command):
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()


def compiler():
    host = words_of("g++", "-print-multiarch")[0]
    ccache = [shutil.which("ccache")] if shutil.which("ccache") else []
    return [*ccache, "aarch64-linux-gnu-g++", "-std=c++20", "-O1", "-ffp-contract=off", "-fno-tree-slp-vectorize",
            *WARNINGS.split(), "-Werror", "-I.", "-isystem", "/usr/include/stb", "-idirafter", f"/usr/include/{host}",
            *(f"-D{name}" for name in DEFINITIONS), *words_of("pkg-config", "--cflags", "libhwy", "cpp-httplib")]


def main():
    sources = sys.argv[1:] or words_of("git", "ls-files", *SOURCES)
    command = compiler()

    def compile_one(source):
        done = subprocess.run([*command, "-c", source, "-o", "/dev/null"], cwd=ROOT, capture_output=True, text=True)
        return source, done.returncode == 0, done.stderr

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for source, good, said in pool.map(compile_one, sources):
            if not good:
                failed += 1
                print(f"{said}not for arm64: {source}", file=sys.stderr)
    print(f"{len(sources) - failed} of {len(sources)} sources compile for arm64")
    return 1 if failed else 0


sys.exit(main())
