#!/usr/bin/python3
"""How true the stated error of light directions is, over made captures. Needs numpy and Pillow.

usage: ball_study.py RELUME FOLDER [NAME ...]    makes 48 captures in FOLDER (or those named), and
prints for each the stated and the true RMS error of its directions, in degrees

Every capture has 16 lamps over a relief with shadows of a checked table, and one or two mirror
balls that are sampled once a pixel, as the hardest case for spots of few pixels.
"""
import json
import os
import subprocess
import sys

import numpy as np
from PIL import Image

WIDTH, HEIGHT, LAMPS = 360, 270, 16


def lamps(distance, spread, rng):
    """Positions in units of half the width; infinite distances are 1e4."""
    i = np.arange(LAMPS) + 0.5
    z = 0.3 + 0.65 * i / LAMPS
    r, a = np.sqrt(1 - z * z), 2.399963 * i
    direction = np.stack([r * np.cos(a), r * np.sin(a), z], 1)
    return direction * distance * rng.uniform(1 - spread, 1 + spread, (LAMPS, 1))


def srgb(v):
    v = np.clip(v, 0, 1)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * np.maximum(v, 1e-9) ** (1 / 2.4) - 0.055)


def pixels():
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    return x + 0.5, y + 0.5


def scene(gloss):
    x, y = pixels()
    u, v = 2 * x / WIDTH - 1, (HEIGHT - 2 * y) / WIDTH
    slope_x, slope_y = 0.1 * np.cos(9 * u) * np.sin(7 * v), 0.1 * np.sin(8 * u + 1) * np.cos(9 * v)
    normal = np.stack([-slope_x, -slope_y, np.ones_like(u)], -1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    check = 0.9 + 0.1 * ((x // 24 + y // 24) % 2)
    albedo = check[..., None] * np.array((0.55, 0.42, 0.3))
    return np.stack([u, v, 0 * u], -1), normal, albedo, gloss


def lit(made, lamp, mean_square):
    point, normal, albedo, gloss = made
    to = lamp - point
    far = np.linalg.norm(to, axis=-1, keepdims=True)
    to = to / far
    half = to + np.array((0, 0, 1.0))
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    shine = gloss * np.clip((normal * half).sum(-1, keepdims=True), 0, 1) ** 40
    facing = np.clip((normal * to).sum(-1, keepdims=True), 0, 1)
    return (albedo * facing + shine) * mean_square / far ** 2 + 0.002


def add_ball(image, ball, lamp, base, power):
    cx, cy, r = ball
    x, y = pixels()
    u, v = (x - cx) / r, -(y - cy) / r
    q = u * u + v * v
    nz = np.sqrt(np.clip(1 - q, 0, 1))
    normal = np.stack([u, v, nz], -1)
    mirrored = 2 * nz[..., None] * normal - (0, 0, 1)
    middle = np.array((2 * cx / WIDTH - 1, (HEIGHT - 2 * cy) / WIDTH, 0))
    to = lamp - middle - 2 * r / WIDTH * normal
    to /= np.linalg.norm(to, axis=-1, keepdims=True)
    value = base * (1 + 0.5 * mirrored[..., 1])
    value = value + 20 * np.exp(power * ((mirrored * to).sum(-1) - 1))
    share = np.clip((1 - np.sqrt(q)) * r + 0.5, 0, 1)[..., None]
    return image * (1 - share) + share * value[..., None]


def make(folder, case, seed):
    rng = np.random.default_rng(seed)
    os.makedirs(folder, exist_ok=True)
    position = lamps(case["distance"], case["spread"], rng)
    mean_square = (position ** 2).sum(1).mean()
    made = scene(case["gloss"])
    r = case["radius"]
    off = rng.uniform(-0.5, 0.5, 4)
    balls = [(r + 12 + off[0], HEIGHT - r - 12 + off[1], r)]
    if case["balls"] > 1:
        balls.append((WIDTH - 0.9 * r - 12 + off[2], 0.9 * r + 12 + off[3], 0.9 * r))
    for i, lamp in enumerate(position):
        image = lit(made, lamp, mean_square)
        for ball in balls:
            image = add_ball(image, ball, lamp, case["base"], case["power"])
        image = srgb(image)
        if case["shift"] and i >= LAMPS // 2:
            image = np.roll(image, case["shift"], 1)
        image = np.clip(image + rng.normal(0, case["noise"], image.shape), 0, 1)
        Image.fromarray((255 * image + 0.5).astype(np.uint8)).save(
            f"{folder}/i{i:03d}.jpg", quality=95)
    return position


def angles(a, b):
    cosine = (a * b).sum(1) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def measure(relume, folder, position):
    """Stated and true error; NaN where no capture is made."""
    out = folder + ".capture"
    done = subprocess.run([relume, "capture", folder, "-o", out, "--force", "--json", "-q"],
                          capture_output=True, text=True)
    if done.returncode:
        return np.nan, np.nan, done.stderr.strip()[:80]
    errors = [p["error_deg"] for p in json.loads(done.stdout)["photographs"]]
    stated = np.sqrt(np.mean(np.square(errors)))
    with open(out + "/capture.json") as f:
        found = json.load(f)
    used = [int(p["file"][1:4]) for p in found["provenance"]["photographs"]]
    lights = found["lights"]
    off = angles(np.array(lights.get("positions", lights["directions"])), position[used])
    note = "positions" if "positions" in lights else ""
    return stated, np.sqrt((off ** 2).mean()), note


def cases():
    """One after another through radii, lamp sizes, noise, gloss, shifts and distances."""
    for i in range(48):
        near = i % 4 == 3
        yield f"{i:02d}", {
            "radius": (14, 20, 28, 40, 55, 75)[i % 6],
            "power": (100, 400, 1200)[i // 2 % 3],
            "noise": (0.001, 0.003, 0.01, 0.02)[i // 3 % 4],
            "base": (0.1, 0.015)[i // 5 % 2],
            "gloss": (0.0, 0.25, 0.6)[i // 4 % 3],
            "shift": (0, 0, 3)[i // 7 % 3],
            "balls": 2 if near or i % 5 == 0 else 1,
            "distance": (3.0, 5.0, 9.0)[i // 4 % 3] if near else 1e4,
            "spread": 0.2 if near and i % 8 == 3 else 0.0,
        }


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    relume, folder, names = sys.argv[1], sys.argv[2], sys.argv[3:]
    within = total = 0
    for seed, (name, case) in enumerate(cases()):
        if names and name not in names:
            continue
        truth = f"{folder}/{name}.npy"
        if not os.path.exists(truth):
            os.makedirs(folder, exist_ok=True)
            np.save(truth, make(f"{folder}/{name}", case, seed))
        stated, true, note = measure(relume, f"{folder}/{name}", np.load(truth))
        good = 0.5 <= stated / true <= 2 if true > 0 else False
        within += good
        total += 1
        print(name, *(f"{k}={v:g}" for k, v in case.items()),
              f"| stated {stated:.2f} true {true:.2f} ratio {stated / true:.2f}",
              "" if good else "OUTSIDE", note, flush=True)
    print(f"{within} of {total} within a factor of 2")


main()
