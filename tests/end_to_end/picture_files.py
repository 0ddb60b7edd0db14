#!/usr/bin/env python3
"""Renders one scene into every format and reads each file with the standard library alone: chunks, checksums, colour
marks, texts and every pixel, against the same film in PFM.

Bytes are taken apart here as the formats' specifications say, and by nothing of the renderer's.
"""

import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

WIDTH, HEIGHT = 61, 37  # no multiple of anything
SCENE = {
    "scene": {
        "camera": {"position": [0, 1, 5], "look_at": [0, 0, 0]},
        "environment": {"type": "color", "radiance": [0.4, 0.5, 0.7]},
        "materials": {"clay": {"type": "diffuse", "color": [0.7, 0.4, 0.2]}},
        "objects": [{"shape": "sphere", "material": "clay"}],
        "lights": [{"type": "point", "position": [2, 3, 4], "intensity": [90, 80, 70]}],
    },
    "image": {"width": WIDTH, "height": HEIGHT, "layers": ["depth", "normal", "albedo", "samples"]},
    "quality": {"samples": 3},
    "seed": 5,
}


def expect(holds, what):
    if not holds:
        sys.exit("picture_files.py: " + what)


def paeth(a, b, c):
    p = a + b - c
    return min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]


class Png:
    """Strict: every checksum, the order of chunks, exactly as many bytes as there are pixels."""

    def __init__(self, data):
        expect(data[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG")
        self.chunks, at = [], 8
        while at < len(data):
            length, kind = struct.unpack(">I4s", data[at : at + 8])
            body = data[at + 8 : at + 8 + length]
            (check,) = struct.unpack(">I", data[at + 8 + length : at + 12 + length])
            expect(zlib.crc32(kind + body) == check, f"the checksum of {kind}")
            self.chunks.append((kind.decode("ascii"), body))
            at += 12 + length
        kinds = [kind for kind, _ in self.chunks]
        expect(at == len(data) and kinds[0] == "IHDR" and kinds[-1] == "IEND", f"the chunks {kinds}")
        picture = [i for i, kind in enumerate(kinds) if kind == "IDAT"]
        expect(picture == list(range(picture[0], picture[-1] + 1)), "the picture is in one run of chunks")
        for colour in ("sRGB", "gAMA"):
            expect(kinds.count(colour) <= 1, f"{colour} stands once")
            expect(colour not in kinds or kinds.index(colour) < picture[0], f"{colour} stands before the picture")
        self.width, self.height, self.bits, *rest = struct.unpack(">IIBBBBB", self.body("IHDR"))
        expect(rest == [2, 0, 0, 0], "RGB, deflated, not interlaced")
        self.values = self.pixels(zlib.decompress(b"".join(body for kind, body in self.chunks if kind == "IDAT")))

    def body(self, kind):
        return next((body for found, body in self.chunks if found == kind), None)

    def pixels(self, raw):
        step, stride = 3 * self.bits // 8, self.width * 3 * self.bits // 8
        expect(len(raw) == self.height * (1 + stride), "as many bytes as pixels")
        before, values = bytes(stride), []
        for y in range(self.height):
            how, line = raw[y * (1 + stride)], bytearray(raw[y * (1 + stride) + 1 : (y + 1) * (1 + stride)])
            expect(how <= 4, "a filter that there is")
            for i in range(stride):
                left, up = (line[i - step] if i >= step else 0), before[i]
                corner = before[i - step] if i >= step else 0
                guess = (0, left, up, (left + up) // 2, paeth(left, up, corner))[how]
                line[i] = (line[i] + guess) & 255
            before = bytes(line)
            values += struct.unpack(f">{self.width * 3}{'B' if self.bits == 8 else 'H'}", before)
        return values

    def texts(self):
        texts = {}
        for kind, body in self.chunks:
            expect(kind not in ("tEXt", "zTXt"), "texts are international ones")
            if kind != "iTXt":
                continue
            keyword, rest = body.split(b"\0", 1)
            expect(rest[:2] == b"\0\0", "not compressed")
            language, translated, text = rest[2:].split(b"\0", 2)
            expect(language == b"" and translated == b"", "neither language nor translation")
            expect(1 <= len(keyword) <= 79, "a keyword of 1 to 79 bytes")
            texts[keyword.decode("latin-1")] = text.decode("utf-8")
        return texts


def read_pfm(data):
    kind, size, scale, raw = data.split(b"\n", 3)
    width, height = map(int, size.split())
    expect(float(scale) < 0, "little-endian")
    channels = {b"PF": 3, b"Pf": 1}[kind]
    expect(len(raw) == width * height * channels * 4, "as many bytes as pixels")
    rows = [struct.unpack_from(f"<{width * channels}f", raw, y * width * channels * 4) for y in range(height)]
    return width, height, [value for row in reversed(rows) for value in row]


def read_hdr(data):
    head, body = data.split(b"\n\n", 1)
    lines = head.decode("utf-8").split("\n")
    expect(lines[0] == "#?RADIANCE" and "FORMAT=32-bit_rle_rgbe" in lines, "a Radiance picture")
    size, body = body.split(b"\n", 1)
    expect(size == b"-Y %d +X %d" % (HEIGHT, WIDTH), f"the size {size}")
    values, at = [], 0
    for _ in range(HEIGHT):
        expect(body[at : at + 4] == bytes([2, 2, WIDTH >> 8, WIDTH & 255]), "a line of runs")
        at += 4
        planes = []
        for _ in range(4):
            plane = bytearray()
            while len(plane) < WIDTH:
                count = body[at]
                if count > 128:
                    plane += bytes([body[at + 1]]) * (count - 128)
                    at += 2
                else:
                    plane += body[at + 1 : at + 1 + count]
                    at += 1 + count
            expect(len(plane) == WIDTH, "runs end with the line")
            planes.append(plane)
        for r, g, b, e in zip(*planes):
            scale = math.ldexp(1, e - 128 - 8) if e else 0
            values += [r * scale, g * scale, b * scale]
    expect(at == len(body), "nothing after the last line")
    return values, dict(line.split("=", 1) for line in lines[1:] if "=" in line)


def c_string(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode("utf-8"), end + 1


def unpredicted(raw):
    """Of deflated blocks: each byte is its difference from the one before and 128; then the halves are interleaved."""
    data = bytearray(raw)
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    half = (len(data) + 1) // 2
    out = bytearray(len(data))
    out[0::2], out[1::2] = data[:half], data[half:]
    return bytes(out)


def read_exr(data):
    magic, version = struct.unpack("<II", data[:8])
    expect(magic == 20000630 and version & 255 == 2 and version & ~0x4FF == 0, "an OpenEXR file of scan lines")
    attributes, at = {}, 8
    while data[at]:
        name, at = c_string(data, at)
        kind, at = c_string(data, at)
        (size,) = struct.unpack_from("<I", data, at)
        attributes[name] = (kind, data[at + 4 : at + 4 + size])
        at += 4 + size
    at += 1
    for name in ("channels", "compression", "dataWindow", "displayWindow", "lineOrder", "pixelAspectRatio",
                 "screenWindowCenter", "screenWindowWidth"):
        expect(name in attributes, f"the attribute {name}")
    expect(attributes["compression"][1] == b"\3", "ZIP")
    expect(struct.unpack("<4i", attributes["dataWindow"][1]) == (0, 0, WIDTH - 1, HEIGHT - 1), "the window")
    channels, place = [], 0
    listed = attributes["channels"][1]
    while listed[place]:
        name, place = c_string(listed, place)
        kind, _, across, down = struct.unpack_from("<IIII", listed, place)
        expect((kind, across, down) == (2, 1, 1), f"channel {name} is of floats, one a pixel")
        channels.append(name)
        place += 16
    expect(channels == sorted(channels), "channels in the order of their names")
    offsets = struct.unpack_from(f"<{(HEIGHT + 15) // 16}Q", data, at)
    found = {name: [] for name in channels}
    for block, offset in enumerate(offsets):
        y, size = struct.unpack_from("<iI", data, offset)
        lines = min(16, HEIGHT - y)
        expect(y == 16 * block, "blocks of 16 lines")
        raw, whole = data[offset + 8 : offset + 8 + size], lines * len(channels) * WIDTH * 4
        if size < whole:
            raw = unpredicted(zlib.decompress(raw))
        expect(len(raw) == whole, "as many bytes as pixels")
        for line in range(lines):
            for c, name in enumerate(channels):
                found[name] += struct.unpack_from(f"<{WIDTH}f", raw, (line * len(channels) + c) * WIDTH * 4)
    texts = {name: value.decode("utf-8") for name, (kind, value) in attributes.items() if kind == "string"}
    return found, texts


def jpeg_comments(data):
    expect(data[:2] == b"\xff\xd8" and data[-2:] == b"\xff\xd9", "from SOI to EOI")
    comments, at, kinds = [], 2, []
    while kinds[-1:] != [0xDA]:
        expect(data[at] == 0xFF, "a marker")
        kinds.append(data[at + 1])
        (size,) = struct.unpack_from(">H", data, at + 2)
        if kinds[-1] == 0xFE:
            comments.append(data[at + 4 : at + 2 + size].decode("utf-8"))
        if kinds[-1] == 0xC0:
            expect(struct.unpack_from(">BHHB", data, at + 4) == (8, HEIGHT, WIDTH, 3), "8 bits, three components")
        at += 2 + size
    expect(kinds[0] == 0xE0 and 0xC0 in kinds, "JFIF, baseline")
    return comments


def srgb(x):
    x = min(max(x, 0), 1)
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055


def expect_codes(png, values, transfer, what):
    """A code is the nearest one to the number that it stands for."""
    most = 2**png.bits - 1
    for code, value in zip(png.values, values, strict=True):
        expect(abs(transfer(value) * most - code) <= 0.5 + 1e-3 * most / 255, f"{what}: {value} is coded as {code}")


def check_provenance(texts, keyword="heliograph", software="Software"):
    facts = json.loads(texts[keyword])
    expect(facts["seed"] == 5 and facts["samples"] == 3, f"the provenance {facts}")
    expect(facts["render_key"].startswith("sha256:") and len(facts["render_key"]) == 71, "the render key")
    expect(texts[software].startswith("heliograph "), "what made it")


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:

        def render(name, job, *options):
            scene = pathlib.Path(folder, "scene.json")
            scene.write_text(json.dumps(job), encoding="utf-8")
            command = [program, "render", str(scene), "--quiet", "-o", f"{folder}/{name}", *options]
            subprocess.run(command, check=True)
            return pathlib.Path(folder, name).read_bytes()

        layers = {name: f"{folder}/{name}.pfm" for name in SCENE["image"]["layers"]}
        film = render("a.pfm", SCENE, *(w for name, file in layers.items() for w in ("--layer", f"{name}={file}")))
        width, height, radiance = read_pfm(film)
        expect((width, height) == (WIDTH, HEIGHT), "the size")
        beside = {name: read_pfm(pathlib.Path(file).read_bytes())[2] for name, file in layers.items()}

        for bits in (8, 16):
            png = Png(render("a.png", SCENE, "--bits", str(bits)))
            expect((png.width, png.height, png.bits) == (WIDTH, HEIGHT, bits), "the PNG's size")
            expect(png.body("sRGB") == b"\0" and png.body("gAMA") is None, "marked as sRGB, for pictures")
            check_provenance(png.texts())
            expect_codes(png, radiance, srgb, f"PNG of {bits} bits")
        linear = Png(render("b.png", {**SCENE, "image": {**SCENE["image"], "tone": "linear"}}))
        expect(linear.body("sRGB") is None and linear.body("gAMA") == struct.pack(">I", 100000), "marked as linear")
        expect_codes(linear, radiance, lambda x: min(max(x, 0), 1), "linear PNG")
        silent = Png(render("c.png", {**SCENE, "provenance": False}))
        expect(silent.texts() == {} and silent.values == Png(render("a.png", SCENE)).values, "no word of its making")

        channels, texts = read_exr(render("a.exr", SCENE))
        check_provenance(texts, software="software")
        for c, name in enumerate("RGB"):
            expect(channels.pop(name) == radiance[c::3], f"channel {name} of the EXR file")
        names = {"depth": ["Z"], "normal": ["N.X", "N.Y", "N.Z"], "samples": ["samples"],
                 "albedo": ["albedo.R", "albedo.G", "albedo.B"]}
        for layer, of_layer in names.items():
            for c, name in enumerate(of_layer):
                expect(channels.pop(name) == beside[layer][c :: len(of_layer)], f"channel {name} of the EXR file")
        expect(not channels, f"channels that nobody asked for: {list(channels)}")
        expect(any(math.isinf(z) for z in beside["depth"]) and set(beside["samples"]) == {3}, "what layers hold")

        values, texts = read_hdr(render("a.hdr", SCENE))
        check_provenance(texts, "HELIOGRAPH", "SOFTWARE")
        for i in range(0, len(radiance), 3):
            most = max(radiance[i : i + 3])
            for found, real in zip(values[i : i + 3], radiance[i : i + 3], strict=True):
                expect(abs(found - real) <= most / 255, f"HDR: {real} is {found}")

        comments = dict(c.split(": ", 1) for c in jpeg_comments(render("a.jpg", SCENE)))
        check_provenance(comments)

        render("d.png", SCENE, "--layer", f"normal={folder}/n.png", "--layer", f"albedo={folder}/a8.png")
        normal = Png(pathlib.Path(folder, "n.png").read_bytes())
        expect(normal.body("gAMA") == struct.pack(">I", 100000), "normals are linear numbers")
        expect_codes(normal, beside["normal"], lambda n: (n + 1) / 2, "normals as PNG")
        albedo = Png(pathlib.Path(folder, "a8.png").read_bytes())
        expect(albedo.body("sRGB") == b"\0", "albedo is sRGB")
        expect_codes(albedo, beside["albedo"], srgb, "albedo as PNG")
    print("PNG, EXR, HDR, PFM and JPEG hold what they should")


main()
