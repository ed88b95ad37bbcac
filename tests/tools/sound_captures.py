#!/usr/bin/python3
"""Sound captures without a ball, for judge_study.py: reliefs of six kinds under lamps on spirals, rings or by hand.

usage: sound_captures.py FOLDER SEED ...     makes FOLDER/sSEED with photographs and dirs.lp

A seed gives the kind of surface, lamps, gloss, noise, ambient light, and how near and how wrong lamps are; all are
printed. Needs numpy, scipy and Pillow.
"""
import os
import sys

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter

KINDS = ["bumps", "coin", "grooves", "cloth", "painting", "head"]


def srgb(v):
    v = np.clip(v, 0, 1)
    return np.where(v <= .0031308, 12.92 * v, 1.055 * np.clip(v, 1e-9, 1) ** (1 / 2.4) - .055)


def rings_of(n):
    """Heights and azimuths of lamps on rings, from 15 to 75 degrees high."""
    rings = max(2, n // 12)
    z, a = [], []
    for k in range(rings):
        m = n // rings if k < rings - 1 else n - n // rings * (rings - 1)
        z += [np.sin(np.radians(15 + 60 * k / max(1, rings - 1)))] * m
        a += list(2 * np.pi * (np.arange(m) + .3 * k) / m)
    return np.array(z), np.array(a)


def lamps(kind, n, rng):
    if kind == "spiral":
        i = np.arange(n) + .5
        z, a = .2 + .77 * i / n, i * 2.399963
    elif kind == "rings":
        z, a = rings_of(n)
    else:
        z, a = rng.uniform(.25, .95, n), np.cumsum(rng.uniform(.2, 1.2, n))
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(a), r * np.sin(a), z], 1)


def height(kind, width, height_, rng):
    """Heights in pixels."""
    shape = (height_, width)
    y, x = np.mgrid[0:height_, 0:width].astype(float)
    s = width / 200

    def rough(radius):
        return gaussian_filter(rng.standard_normal(shape), radius)

    if kind == "bumps":
        h = np.zeros(shape)
        for _ in range(rng.integers(3, 9)):
            cx, cy, w = rng.uniform(0, width), rng.uniform(0, height_), rng.uniform(8, 35) * s
            h += rng.uniform(-.4, .6) * w * np.exp(-((x - cx) ** 2 + (y - cy) ** 2 * rng.uniform(.5, 2)) / w ** 2)
        return h
    if kind == "coin":
        d, radius = np.hypot(x - width / 2, y - height_ / 2), .42 * height_
        h = rough(6 * s)
        h = 4 * s * h / h.std() * (d < radius * .8)
        h += 5 * s / (1 + np.exp((d - radius) / (1.5 * s))) + 3 * s * np.exp(-((d - radius * .93) / (2.5 * s)) ** 2)
        return gaussian_filter(h, s)
    if kind == "grooves":
        m = rough(5 * s)
        m /= m.std()
        return gaussian_filter(-6 * s * (np.abs(m) < .25), 1.2 * s) + .9 * s * rough(1.5)
    if kind == "cloth":
        return 1.2 * s * np.sin(x / (3.1 * s)) * np.sin(y / (2.7 * s)) + 72 * s * rough(14 * s)
    if kind == "painting":
        return 2 * s * rough(1.2 * s) + 6 * s * rough(4 * s)
    d = np.hypot((x - width / 2) / (.33 * width), (y - height_ / 2) / (.42 * height_))
    h = .3 * width * np.sqrt(np.clip(1 - d ** 2, 0, 1))
    h += 30 * s * rough(5 * s) * (d < 1)
    return gaussian_filter(h, 1.2 * s)


def lit(h, light):
    """What of a distant lamp reaches each pixel, 0 to 1."""
    rows, columns = h.shape
    y, x = np.mgrid[0:rows, 0:columns].astype(float)
    share, r = np.ones(h.shape), np.hypot(light[0], light[1])
    for k in range(1, 41) if r >= 1e-3 else ():
        d = k * 1.5 + k * k * .03
        column = np.clip((x + light[0] / r * d).round().astype(int), 0, columns - 1)
        row = np.clip((y - light[1] / r * d).round().astype(int), 0, rows - 1)
        share = np.minimum(share, np.clip((h + light[2] / r * d - h[row, column]) / .8 + .5, 0, 1))
    return share


def make(out, seed):
    rng = np.random.default_rng(seed)
    os.makedirs(out, exist_ok=True)
    kind, n = KINDS[seed % 6], int(rng.choice([12, 16, 20, 24, 30, 36, 48]))
    how = ["spiral", "rings", "hand"][(seed // 6 + seed) % 3]
    width = int(rng.choice([180, 220, 260, 300]))
    rows = int(width * rng.choice([.66, .75, 1.0]))
    h = height(kind, width, rows, rng)
    gy, gx = np.gradient(h)
    normal = np.stack([-gx, gy, np.ones_like(h)], -1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    base = rng.uniform(.15, .7, 3)
    fine = gaussian_filter(rng.standard_normal(h.shape), rng.uniform(.7, 3))
    patch = gaussian_filter(rng.standard_normal(h.shape), rng.uniform(6, 20))
    fine, patch = fine / fine.std(), patch / patch.std()
    albedo = base * np.exp(rng.uniform(0, .3) * fine + rng.uniform(0, .5) * np.tanh(3 * patch))[..., None]
    if kind == "head":
        albedo = albedo * np.where(h > .5, 1, .06)[..., None]
    gloss, power = float(rng.choice([0, 0, .1, .3, .6])), float(rng.choice([12, 30, 80]))
    metal = gloss > .2 and rng.uniform() < .4
    albedo = albedo * (.35 if metal else 1)
    noise, ambient = float(rng.choice([.002, .005, .01])), float(rng.choice([0, .002, .01]))
    gain, distance = float(rng.uniform(.7, 1.3)), float(rng.choice([0, 0, 4, 8]))
    uneven, wrong = float(rng.choice([0, .05])), float(rng.choice([0, .5, 1.5]))
    light = lamps(how, n, rng)
    bright = 1 + uneven * rng.standard_normal(n)
    y, x = np.mgrid[0:rows, 0:width]
    point = np.stack([(x + .5 - width / 2) * 2 / width, -(y + .5 - rows / 2) * 2 / width, 0 * x], -1)
    names = []
    for i, l in enumerate(light):
        to, fall = np.broadcast_to(l, point.shape), 1
        if distance:
            to = l * distance - point
            fall = distance ** 2 / (to ** 2).sum(-1)
            to = to / np.linalg.norm(to, axis=-1, keepdims=True)
        cosine = np.clip((normal * to).sum(-1), 0, 1)
        half = to + np.array([0, 0, 1.])
        half /= np.linalg.norm(half, axis=-1, keepdims=True)
        shine = gloss * np.clip((normal * half).sum(-1), 0, 1) ** power * (cosine > 0)
        tint = base / base.max() if metal else np.ones(3)
        image = albedo * cosine[..., None] + shine[..., None] * tint
        image = image * (lit(h, l) * fall * bright[i] * gain)[..., None] + ambient
        code = srgb(image) + rng.normal(0, noise, image.shape)
        names.append(f"p{i:02d}.jpg")
        Image.fromarray((np.clip(code, 0, 1) * 255 + .5).astype(np.uint8)).save(
            f"{out}/{names[-1]}", quality=int(rng.choice([88, 95])))
    said = light + np.radians(wrong) * rng.standard_normal(light.shape)
    said /= np.linalg.norm(said, axis=1, keepdims=True)
    with open(f"{out}/dirs.lp", "w") as f:
        f.write(f"{n}\n" + "".join("%s %.6f %.6f %.6f\n" % (a, *e) for a, e in zip(names, said)))
    print(out, kind, how, n, (width, rows), "gloss", gloss, power, "metal", metal, "noise", noise, "ambient", ambient,
          "distance", distance, "uneven", uneven, "wrong", wrong, flush=True)


if __name__ == "__main__":
    for number in sys.argv[2:]:
        make(f"{sys.argv[1]}/s{number}", int(number))
