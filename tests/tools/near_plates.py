#!/usr/bin/python3
"""Normals of matte surfaces under near lamps at unequal distances, measured. Needs numpy.

usage: near_plates.py RELUME FOLDER     makes captures in FOLDER, fits them by RELUME, prints a table
"""
import os
import subprocess
import sys

import numpy as np

WIDTH, HEIGHT, NOISE = 96, 72, 0.004


def lamps(n, nearest, farthest, rng):
    i = np.arange(n) + 0.5
    z = 0.3 + 0.65 * i / n
    r, a = np.sqrt(1 - z * z), 2.399963 * i
    return np.stack([r * np.cos(a), r * np.sin(a), z], 1) * rng.uniform(nearest, farthest, (n, 1))


def surface(bump):
    """Points on z = 0 in the default window, and normals of a shallow wave of `bump` units."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    x, y = 2 * (x + 0.5) / WIDTH - 1, (HEIGHT - 2 * (y + 0.5)) / WIDTH
    slope_x = -bump * np.pi * np.sin(np.pi * x) * np.cos(np.pi * y)
    slope_y = -bump * np.pi * np.cos(np.pi * x) * np.sin(np.pi * y)
    normal = np.stack([-slope_x, -slope_y, np.ones_like(x)], -1)
    return np.stack([x, y, 0 * x], -1), normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def write(folder, position, power, bump, rng):
    os.makedirs(folder, exist_ok=True)
    point, normal = surface(bump)
    scale = 0.7 * (position ** 2).sum(1).mean()
    with open(f"{folder}/lamps.txt", "w") as f:
        for p in position:
            f.write("%g %g %g\n" % tuple(p))
    for i, p in enumerate(position):
        to = p - point
        far = np.linalg.norm(to, axis=-1)
        value = scale * power[i] * np.clip((to * normal).sum(-1), 0, None) / far ** 3
        image = value[..., None] + rng.normal(0, NOISE, (HEIGHT, WIDTH, 3))
        with open(f"{folder}/l{i:03d}.pfm", "wb") as f:
            f.write(b"PF\n%d %d\n-1.0\n" % (WIDTH, HEIGHT))
            f.write(image[::-1].astype("<f4").tobytes())
    return normal


def error(relume, folder, normal, *options):
    photographs = sorted(f"{folder}/{n}" for n in os.listdir(folder) if n.endswith(".pfm"))
    out = folder + ".normals.pfm"
    subprocess.run([relume, "capture", *photographs, "--lights", f"{folder}/lamps.txt", "--near",
                    "-q", "--force", "-o", folder + ".capture", "--normals", out, *options],
                   check=True, stderr=subprocess.DEVNULL)
    with open(out, "rb") as f:
        for _ in range(3):
            f.readline()
        found = np.frombuffer(f.read(), "<f4").reshape(HEIGHT, WIDTH, 3)[::-1]
    cosine = (found * normal).sum(-1) / np.linalg.norm(found, axis=-1)
    return np.sqrt((np.degrees(np.arccos(np.clip(cosine, -1, 1))) ** 2).mean())


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    relume, folder = sys.argv[1:]
    print("surface lamps distances power | as it is | --refine-brightness (degrees RMS)")
    for bump in (0.0, 0.12):
        for n, nearest, farthest in ((24, 1.6, 2.1), (6, 1.6, 2.1), (60, 1.2, 2.5)):
            for spread in (0.0, 0.2):
                rng = np.random.default_rng(5)
                position = lamps(n, nearest, farthest, rng)
                power = np.exp(rng.normal(0, spread, n))
                case = f"{folder}/{n}_{bump}_{spread}"
                normal = write(case, position, power, bump, rng)
                print("wave" if bump else "plate", n, nearest, farthest, spread, "|",
                      "%.2f |" % error(relume, case, normal),
                      "%.2f" % error(relume, case, normal, "--refine-brightness"))


main()
