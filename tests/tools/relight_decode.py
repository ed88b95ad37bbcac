#!/usr/bin/env python3
"""An independent decoder of relight folders, .ptm and .rti files, written from the descriptions of
the formats: what a viewer shows under one light, as 8-bit codes.

    relight_decode.py IN X Y Z OUT.ppm             relight's light weights
    relight_decode.py --apart IN X Y Z PICTURE      largest difference from a picture, in codes
    relight_decode.py --score FOLDER TEST.lp        mean PSNR over the lights of a .lp, bytes a pixel
    relight_decode.py --predict IN.ptm OUT.ptm      a raw .ptm as JPEG planes that predict each other
    relight_decode.py --planes IN.ptm RAW.ptm       how its JPEG planes are made: how many predicted,
                                                    inverted, with records; pixels that leave a byte
                                                    without a record; planes that are not baseline
                                                    JPEG; largest error, in codes of RAW.ptm
    relight_decode.py --serve                       arguments line by line from stdin, an answer each
"""
import io
import json
import pathlib
import re
import sys

import numpy as np
from PIL import Image


def unit(v):
    v = np.asarray(v, float)
    return v / np.linalg.norm(v)


def ptm(l):
    x, y, _ = l
    return np.array([1, x, y, x * x, x * y, y * y])


def hsh(l):
    x, y, z = l
    theta = min(np.arccos(np.clip(z, -1, 1)), np.pi / 2 - 0.01)
    phi, c = np.arctan2(y, x), np.cos(theta)
    q, p = np.sqrt(c - c * c), np.pi
    return np.array([
        1 / np.sqrt(2 * p), np.sqrt(6 / p) * q * np.cos(phi), np.sqrt(3 / (2 * p)) * (2 * c - 1),
        np.sqrt(6 / p) * q * np.sin(phi), np.sqrt(30 / p) * (c * c - c) * np.cos(2 * phi),
        np.sqrt(30 / p) * (2 * c - 1) * q * np.cos(phi),
        np.sqrt(5 / (2 * p)) * (1 - 6 * c + 6 * c * c),
        np.sqrt(30 / p) * (2 * c - 1) * q * np.sin(phi),
        np.sqrt(30 / p) * (c * c - c) * np.sin(2 * phi),
        2 * np.sqrt(35 / p) * q ** 3 * np.cos(3 * phi),
        np.sqrt(210 / p) * (2 * c - 1) * (c * c - c) * np.cos(2 * phi),
        2 * np.sqrt(21 / p) * q * (1 - 5 * c + 5 * c * c) * np.cos(phi),
        np.sqrt(7 / (2 * p)) * (20 * c ** 3 - 30 * c * c + 12 * c - 1),
        2 * np.sqrt(21 / p) * q * (1 - 5 * c + 5 * c * c) * np.sin(phi),
        np.sqrt(210 / p) * (2 * c - 1) * (c * c - c) * np.sin(2 * phi),
        2 * np.sqrt(35 / p) * q ** 3 * np.sin(3 * phi)])


def sh(l):
    x, y, z = l
    a, b, c = np.sqrt(3 / np.pi) / 2, np.sqrt(15 / np.pi) / 2, np.sqrt(5 / np.pi)
    return np.array([0.5 / np.sqrt(np.pi), a * y, a * z, a * x, b * x * y, b * y * z,
                     c / 4 * (3 * z * z - 1), b * x * z, b / 2 * (x * x - y * y)])


def rbf(l, lights, sigma):
    w = np.exp(-((lights - l) ** 2).sum(1) / sigma ** 2)
    w /= w.sum()
    w[w <= 0.001] = 0
    return w / w.sum()


def bilinear(l, side):
    x, y, z = l
    s = abs(x) + abs(y) + abs(z)
    u, v = ((x + y) / s + 1) / 2 * (side - 1), ((y - x) / s + 1) / 2 * (side - 1)
    i, j = min(int(u), side - 2), min(int(v), side - 2)
    a, b = u - i, v - j
    w = np.zeros((side, side))
    w[j, i], w[j, i + 1] = (1 - a) * (1 - b), a * (1 - b)
    w[j + 1, i], w[j + 1, i + 1] = (1 - a) * b, a * b
    return w.ravel()


class Folder:
    def __init__(self, path):
        path = pathlib.Path(path)
        d = self.info = json.loads((path / "info.json").read_text())
        self.type, self.space = d["type"], d["colorspace"]
        self.split = d.get("yccplanes")
        n = sum(self.split) if self.split else d["nplanes"]
        m, planes, self.bytes = d["materials"][0], [], 0
        for j in range((n + 2) // 3):
            f = path / f"plane_{j}.jpg"
            if not f.exists():  # deep zoom of a single tile
                f = path / f"plane_{j}_files" / "0" / "0_0.jpg"
            self.bytes += f.stat().st_size
            planes.append(np.asarray(Image.open(f).convert("RGB"), float))
        v = np.concatenate(planes, 2)[:, :, :n]
        self.c = (v / 255 - np.array(m["bias"])) * np.array(m["scale"])
        if self.space == "lrgb":
            self.c[:, :, :3] = v[:, :, :3] / 255
        self.pixels = d["width"] * d["height"]
        if self.type == "rbf":
            self.lights = np.array([unit(l) for l in np.array(d["lights"], float).reshape(-1, 3)])
        if self.space in ("mrgb", "mycc"):
            b = d.get("basis")
            if b is None:
                b = np.frombuffer((path / "materials.bin").read_bytes(), np.uint8)
            b = np.array(b, float).reshape(n + 1, -1, 3)
            self.mean = b[0] / 255
            self.b = (b[1:] - 127) / np.array(m["range"])[:, None, None]

    def weights(self, l):
        if self.type == "rbf":
            return rbf(l, self.lights, self.info["sigma"])
        if self.type == "bilinear":
            return bilinear(l, self.info["resolution"])
        return {"ptm": ptm, "hsh": hsh, "sh": sh}[self.type](l)[:9]

    def render(self, l):
        w, c = self.weights(unit(l)), self.c
        if self.space == "rgb":
            k = c.shape[2] // 3
            return np.einsum("yxkc,k->yxc", c.reshape(*c.shape[:2], k, 3), w[:k])
        if self.space == "lrgb":
            k = c.shape[2] - 3
            return c[:, :, :3] * (c[:, :, 3:] @ w[:k])[:, :, None]
        if self.space == "ycc":
            k = c.shape[2] // 3
            y, cb, cr = c[:, :, ::3] @ w[:k], c[:, :, 1] - 0.5, c[:, :, 2] - 0.5
            return np.stack([y + 1.402 * cr, y - 0.344136 * cb - 0.714136 * cr, y + 1.772 * cb], 2)
        mean = np.einsum("nk,n->k", self.mean, w)
        b = np.einsum("pnk,n->pk", self.b, w)
        if self.space == "mrgb":
            return mean + c @ b
        out = np.tile(mean, (*c.shape[:2], 1))
        for p in range(c.shape[2]):
            k = p % 3 if p < 3 * self.split[1] else 0
            out[:, :, k] += c[:, :, p] * b[p, k]
        y, a, b = out[:, :, 0], out[:, :, 1], out[:, :, 2]
        t = y - b / 2
        blue = t - a / 2
        return np.stack([blue + a, b + t, blue], 2)


class Ptm:
    """Raw RGB and LRGB, and the JPEG forms without motion."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        head = re.match(rb"PTM_([\d.]+)\s+PTM_FORMAT_(\w+)\s+(\d+)\s+(\d+)"
                        rb"((?:\s+[-+.\deE]+){6})((?:\s+[-+\d]+){6})[ \t]*\r?\n", data)
        version, kind = float(head[1]), head[2].decode()
        w, h = int(head[3]), int(head[4])
        scale, bias = np.array(head[5].split(), float), np.array(head[6].split(), float)
        body, self.luminance = data[head.end():], kind.endswith("LRGB")
        if kind.startswith("JPEG"):
            v = self.jpegs(body, 9 if self.luminance else 18, w, h)
        else:
            v = np.frombuffer(body, np.uint8)
            if kind == "LRGB" and version < 1.15:
                v = v[:h * w * 9].reshape(h, w, 9)
            elif kind == "LRGB":
                v = np.concatenate([v[:h * w * 6].reshape(h, w, 6),
                                    v[h * w * 6:h * w * 9].reshape(h, w, 3)], 2)
            else:
                v = v[:h * w * 18].reshape(3, h, w, 6).transpose(1, 2, 0, 3).reshape(h, w, 18)
        self.codes = v
        v = v[::-1].astype(float)
        n = 6 if self.luminance else 18
        self.c = (v[:, :, :n].reshape(h, w, -1, 6) - bias) * scale
        self.colour = v[:, :, 6:] if self.luminance else None

    @staticmethod
    def table(body, n):
        head = re.match(rb"\s*\d+((?:\s+-?\d+){%d})[ \t]*\r?\n" % (7 * n), body)
        table = np.array(head[1].split(), int).reshape(7, n)
        at, parts = head.end(), []
        for i in range(n):
            parts.append((body[at:at + table[5, i]],
                          body[at + table[5, i]:at + table[5, i] + table[6, i]]))
            at += table[5, i] + table[6, i]
        return table, parts

    def jpegs(self, body, n, w, h):
        table, parts = self.table(body, n)
        self.facts = {"predicted": (table[4] >= 0).sum(), "inverted": (table[0] == 1).sum(),
                      "recorded": (table[6] > 0).sum(), "wrapped": 0,
                      "progressive": sum(b"\xff\xc0" not in p[0] for p in parts)}
        planes = [None] * n
        for i in np.argsort(table[3]):
            p = np.asarray(Image.open(io.BytesIO(parts[i][0])).convert("L"), int)
            if table[4, i] >= 0:
                reference = planes[table[4, i]]
                p = p - 128 + (255 - reference if table[0, i] == 1 else reference)
            p, side = p.copy().ravel(), parts[i][1]
            for k in range(0, len(side), 5):
                p[int.from_bytes(side[k:k + 4], "big")] = side[k + 4]
            self.facts["wrapped"] += ((p < 0) | (p > 255)).sum()
            planes[i] = p.reshape(h, w) % 256
        return np.stack(planes, 2)

    def render(self, l):
        x, y, _ = unit(l)
        v = self.c @ np.array([x * x, y * y, x * y, x, y, 1]) / 255
        return v * self.colour / 255 if self.luminance else v


class Rti:
    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        head = re.match(rb"(?:#[^\n]*\n)*\s*3\s+(\d+)\s+(\d+)\s+3\s+(\d+)\s+2\s+1[ \t]*\r?\n", data)
        w, h, n = (int(x) for x in head.groups())
        at = head.end()
        scale = np.frombuffer(data[at:at + 4 * n], "<f4")
        bias = np.frombuffer(data[at + 4 * n:at + 8 * n], "<f4")
        if str(path).endswith(".hsh"):
            scale, bias = bias - scale, scale
        v = np.frombuffer(data[at + 8 * n:], np.uint8)[:h * w * 3 * n].reshape(h, w, 3, n)
        self.c = v / 255 * scale + bias

    def render(self, l):
        return self.c @ hsh(unit(l))[:self.c.shape[3]]


def open_any(path):
    if str(path).endswith(".ptm"):
        return Ptm(path)
    return Rti(path) if str(path).endswith((".rti", ".hsh")) else Folder(path)


def predict(path, out):
    """Version 1.2's prediction: from the plane before, inverted where that is nearer; side
    information where JPEG is off by more than 3."""
    data, f = pathlib.Path(path).read_bytes(), Ptm(path)
    lines = data.split(b"\n", 6)[:6]
    scale, bias = np.array(lines[4].split(), float), np.array(lines[5].split(), float)
    v = np.rint(f.c / scale + bias).reshape(*f.c.shape[:2], -1)
    v = np.concatenate([v, f.colour], 2) if f.luminance else v
    v = v[::-1].astype(np.uint8)
    n = v.shape[2]
    table, body, before = np.zeros((7, n), int), b"", None
    table[3], table[4] = range(n), -1
    for i in range(n):
        plane = want = v[:, :, i].astype(int)
        if i:
            apart = [abs(want - r).mean() for r in (before, 255 - before)]
            table[0, i], table[4, i] = int(np.argmin(apart)), i - 1
            reference = 255 - before if table[0, i] else before
            plane = (want - reference + 128) % 256
        jpeg = io.BytesIO()
        Image.fromarray(plane.astype(np.uint8)).save(jpeg, "JPEG", quality=97)
        got = np.asarray(Image.open(jpeg), int)
        if i:
            got = (got - 128 + reference) % 256
        off = np.flatnonzero(abs(got - want) > 3)
        side = b"".join(int(k).to_bytes(4, "big") + bytes([want.flat[k]]) for k in off)
        before = got.copy()
        before.flat[off] = want.flat[off]
        table[5, i], table[6, i] = len(jpeg.getvalue()), len(side)
        body += jpeg.getvalue() + side
    head = [lines[0], lines[1].replace(b"FORMAT_", b"FORMAT_JPEG_")] + lines[2:] + [b"97"]
    head += [" ".join(map(str, row)).encode() for row in table]
    pathlib.Path(out).write_bytes(b"\n".join(head) + b"\n" + body)
    print(f"{(table[0] == 1).sum()} {(table[6] > 0).sum()}")


def describe(path, raw):
    f = Ptm(path)
    off = abs(f.codes.astype(int) - Ptm(raw).codes.astype(int)).max()
    print(*f.facts.values(), off)


def codes(v):
    return np.clip(np.rint(255 * v), 0, 255).astype(np.uint8)


def score(folder, lp):
    f, lp = Folder(folder), pathlib.Path(lp)
    lines = [line.split() for line in lp.read_text().splitlines()[1:] if line.strip()]
    total = 0.0
    for words in lines:
        name = " ".join(words[:-3])
        want = np.asarray(Image.open(lp.parent / pathlib.Path(name).name).convert("RGB"), float)
        got = codes(f.render([float(x) for x in words[-3:]]))
        total += min(200.0, 10 * np.log10(255 ** 2 / max(((got - want) ** 2).mean(), 1e-16)))
    print(f"{total / len(lines):.4f} {f.bytes / f.pixels:.5f} {f.c.shape[2]}")


def show(path, *light):
    return codes(open_any(path).render([float(x) for x in light]))


def apart(path, x, y, z, picture):
    want = np.asarray(Image.open(picture).convert("RGB"), int)
    print(abs(show(path, x, y, z).astype(int) - want).max())


def run(arguments):
    commands = {"--score": score, "--predict": predict, "--planes": describe, "--apart": apart}
    if arguments[0] in commands:
        commands[arguments[0]](*arguments[1:])
        return
    Image.fromarray(show(*arguments[:4])).save(arguments[4])


def main():
    if sys.argv[1:] != ["--serve"]:
        run(sys.argv[1:])
        return
    for line in sys.stdin:  # so that many questions load NumPy once
        run(line.split())
        sys.stdout.flush()


if __name__ == "__main__":
    main()
