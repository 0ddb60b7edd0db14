#!/usr/bin/env python3
"""A crowd of slow clients against a real heliographd, and what others notice of it.

Usage: slow_clients.py BIN [HEADERS BODIES READERS]

Opens HEADERS connections that drip a header, BODIES that drip a body (every second one a large one) and READERS that
fetch a large asset and do not read, from five addresses of this machine. Meanwhile another client asks /healthz on both
ports, submits jobs and fetches documents. Prints latencies, memory, and when the crowd was dropped; fails when an
answer is wrong, when the crowd outlives its deadlines, or when it costs more than 32 MiB (unless SANITIZED is in the
environment). Latencies are figures, not conditions: they are the machine's too.
"""
import http.client
import json
import os
import resource
import selectors
import socket
import subprocess
import sys
import tempfile
import time

ADDRESSES = [f"127.0.0.{i}" for i in range(2, 7)]
MIB = 1 << 20
ASSET = 32 * MIB
PATIENCE_S = 120  # of a hang, not of a figure


def start(bin_folder, data):
    service = subprocess.Popen(
        [f"{bin_folder}/heliographd", "--port", "0", "--health-port", "0", "--data", data],
        stdout=subprocess.PIPE, stderr=open(f"{data}.log", "wb"), text=True)
    words = service.stdout.readline().replace(")", "").split()
    main, health = (int(word.rsplit(":", 1)[1]) for word in words if word.startswith("http://"))
    return service, main, health


def resident(service):
    with open(f"/proc/{service.pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) << 10 for line in status if line.startswith("VmRSS"))


def threads(service):
    return len(os.listdir(f"/proc/{service.pid}/task"))


def ask(port, method, path, body=None):
    began = time.monotonic()
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    connection.request(method, path, body, {"Content-Type": "application/json"} if body else {})
    answer = connection.getresponse()
    text = answer.read()
    connection.close()
    return answer.status, text, time.monotonic() - began


def slow(port, number, text, window=None):
    connection = socket.socket()
    if window:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, window)
    connection.bind((ADDRESSES[number % len(ADDRESSES)], 0))
    connection.connect(("127.0.0.1", port))
    connection.sendall(text)
    return connection


class Crowd:
    """Slow connections; the sending ones drip a byte now and then, the reading ones do nothing at all."""

    def __init__(self, port, headers, bodies, readers, asset):
        self.watch = selectors.DefaultSelector()
        self.dropped = {"header": [], "body": [], "reader": []}
        self.began = time.monotonic()
        for i in range(headers):
            self.add("header", slow(port, i, b"GET / HTTP/1.1\r\nHost: a\r\nX: "))
        for i in range(bodies):
            length = 60000 if i % 2 else 900000
            self.add("body", slow(port, i, b"POST /v1/jobs HTTP/1.1\r\nHost: a\r\nContent-Length: %d\r\n\r\n{" % length))
        self.readers = [slow(port, i, b"GET " + asset + b" HTTP/1.1\r\nHost: a\r\n\r\n", 4096) for i in range(readers)]
        self.last = time.monotonic()
        self.readers_end = self.last + 15  # 10 s of silence and the service cuts them off

    def add(self, kind, connection):
        self.watch.register(connection, selectors.EVENT_READ, kind)

    def here(self):
        return len(self.watch.get_map())

    def step(self):
        """Notes who was dropped, and lets the others drip a byte every 2 s."""
        now = time.monotonic()
        for key, _ in self.watch.select(0):
            self.watch.unregister(key.fileobj)
            key.fileobj.close()  # an answer or the end: either way it is over
            self.dropped[key.data].append(now - self.began)
        if now - self.last > 2:
            self.last = now
            for key in list(self.watch.get_map().values()):
                try:
                    key.fileobj.send(b"a")
                except OSError:
                    pass  # the end of it is read in the next step

    def readers_cut(self):
        """How many of those that did not read were cut off: reading on ends before the asset does."""
        cut = 0
        for connection in self.readers:
            connection.settimeout(PATIENCE_S)
            got = 0
            try:
                while piece := connection.recv(MIB):
                    got += len(piece)
            except ConnectionError:
                pass
            cut += got < ASSET
            connection.close()
        return cut


def quantile(values, q):
    return sorted(values)[int(q * (len(values) - 1))]


def ask_all(main, health, job, seed):
    """One round of an ordinary client: seconds by what was asked."""
    job["seed"] = seed
    asked = {
        "healthz, main port": (main, "GET", "/healthz", None, 200),
        "healthz, own port": (health, "GET", "/healthz", None, 200),
        "capabilities": (main, "GET", "/v1/capabilities", None, 200),
        "submit": (main, "POST", "/v1/jobs", json.dumps(job), 202),
    }
    seconds = {}
    for name, (port, method, path, body, wanted) in asked.items():
        status, text, seconds[name] = ask(port, method, path, body)
        if status != wanted:
            sys.exit(f"FAILED: {name}: {status} {text[:300]!r}")
    return seconds


def main():
    headers, bodies, readers = (int(word) for word in (sys.argv[2:5] or ("1000", "200", "100")))
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard if hard != resource.RLIM_INFINITY else 8192, hard))
    with tempfile.TemporaryDirectory() as folder:
        service, port, health = start(sys.argv[1], f"{folder}/data")
        try:
            run(service, port, health, headers, bodies, readers)
        finally:
            service.terminate()
            service.wait()


def run(service, port, health, headers, bodies, readers):
    status, text, _ = ask(port, "POST", "/v1/assets", os.urandom(ASSET))
    if status != 201:
        sys.exit(f"FAILED: the asset was not taken: {status} {text!r}")
    asset = json.loads(text)["links"]["self"]
    if len(ask(port, "GET", asset)[1]) != ASSET:
        sys.exit("FAILED: the asset did not come back")
    job = {"scene": {"objects": [{"shape": "sphere"}]}, "image": {"width": 8, "height": 8}, "quality": {"samples": 1}}
    quiet = [ask_all(port, health, job, i) for i in range(200)]  # warm, as it is among others
    before, threads_before = resident(service), threads(service)

    crowd = Crowd(port, headers, bodies, readers, asset.encode())
    meanwhile, most, most_threads = [], before, threads_before
    while crowd.here() and time.monotonic() - crowd.began < PATIENCE_S or time.monotonic() < crowd.readers_end:
        meanwhile.append(ask_all(port, health, job, 1000 + len(meanwhile)))
        crowd.step()
        most, most_threads = max(most, resident(service)), max(most_threads, threads(service))
    cut = crowd.readers_cut()

    print(f"{headers} slow headers, {bodies} slow bodies, {readers} that do not read, from {len(ADDRESSES)} addresses")
    for name in quiet[0]:
        values, alone = [r[name] * 1e3 for r in meanwhile], [r[name] * 1e3 for r in quiet]
        print(f"  {name:20} p50 {quantile(values, .5):6.1f} ms  p99 {quantile(values, .99):6.1f} ms  of {len(values)}"
              f"   (without the crowd p50 {quantile(alone, .5):.1f}, p99 {quantile(alone, .99):.1f})")
    print(f"  memory {before / MIB:.1f} -> {most / MIB:.1f} MiB, threads {threads_before} -> {most_threads}")
    for kind, times in crowd.dropped.items():
        if times:
            print(f"  {kind}: dropped after {min(times):.1f} to {max(times):.1f} s")
    print(f"  {cut} of {readers} readers cut off")
    if crowd.here():
        sys.exit(f"FAILED: {crowd.here()} slow senders are still there after {PATIENCE_S} s")
    if cut != readers:
        sys.exit("FAILED: who does not read was served to the end")
    if "SANITIZED" in os.environ:  # its programs hold what was freed, and shadows of the rest
        print("  memory is not judged: a sanitizer takes more than the crowd")
    elif most - before > 32 * MIB:
        sys.exit("FAILED: the crowd cost more than 32 MiB")
    if len(os.listdir(f"/proc/{service.pid}/fd")) > 100:
        sys.exit("FAILED: descriptors of the crowd are still open")


main()
