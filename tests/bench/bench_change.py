#!/usr/bin/env python3
"""What `relume change` finds of a scratch and a stain, beside plain differences of photographs.

    bench_change.py BUILD [FOLDER]

Makes pairs of captures by tests/tools/change_scene.c and prints the table of docs/change.md. Plain
differences are those of the mean photographs by `relume compare -o`, without and with --register
--fit-colours, marked above the threshold that gives them their best F1: nobody knows that one
beforehand. Precision and recall allow 2 pixels. Needs numpy and Pillow.
"""
import json
import math
import pathlib
import subprocess
import sys

import numpy as np
from PIL import Image

build, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "build/change")
SIZE, NOISE = (320, 240), ["--noise", "0.004", "--gloss", "0.1"]
EXPOSED = ["--gain", "0.7", "0.8", "0.75"]


def camera(deg):
    """Turned, shifted, nearer, askew: its pixels to those of the first."""
    (w, h), t = SIZE, math.radians(deg)
    to = np.array([[1, 0, w / 2], [0, 1, h / 2], [0, 0, 1.0]])
    roll = np.array([[math.cos(t), -math.sin(t), 0], [math.sin(t), math.cos(t), 0], [0, 0, 1]])
    askew = np.array([[1, 0, 0], [0, 1, 0], [1.6e-2 / w, -8e-3 / w, 1]])
    shift = np.array([[1, 0, 0.027 * w], [0, 1, -0.017 * w], [0, 0, 1]])
    m = to @ shift @ roll @ np.diag([0.97, 0.97, 1]) @ askew @ np.linalg.inv(to)
    return ["--homography"] + [f"{v:.9g}" for v in (m / m[2, 2]).ravel()[:8]] + ["--roll", f"{-deg}"]


PAIRS = {
    "other lamps": ["--lights", "24", "--seed", "5"],
    "and exposures": ["--lights", "24", "--seed", "9", *EXPOSED],
    "and camera, 5 degrees": ["--lights", "30", "--seed", "7", *EXPOSED, *camera(5)],
}


def scene(name, *options):
    subprocess.run([build / "tests/tools/change_scene", work / name, "--size", *map(str, SIZE), *NOISE, *options],
                   check=True)


def mean_photograph(name):
    """In linear light."""
    decode = lambda v: np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)
    photos = sorted((work / name).glob("*.png"))
    mean = sum(decode(np.asarray(Image.open(p)).astype(float) / 255) for p in photos) / len(photos)
    path = work / f"{name}.pfm"
    with open(path, "wb") as f:
        f.write(b"PF\n%d %d\n-1.0\n" % SIZE)
        mean[::-1].astype("<f4").tofile(f)
    return path


def difference(a, b, *options):
    out = work / "difference.pfm"
    subprocess.run([build / "relume", "compare", mean_photograph(a), mean_photograph(b), "-o", out, "-q", *options],
                   check=True, stdout=subprocess.DEVNULL)
    data = open(out, "rb").read()
    return np.frombuffer(data[data.index(b"-1.0") + 5:], "<f4").reshape(SIZE[1], SIZE[0], 3)[::-1].max(axis=2)


def grown(mask, by=2):
    padded = np.pad(mask, by)
    return np.any([padded[i:i + mask.shape[0], j:j + mask.shape[1]]
                   for i in range(2 * by + 1) for j in range(2 * by + 1)], axis=0)


def score(mask, truth):
    precision = (mask & grown(truth)).sum() / max(mask.sum(), 1)
    recall = (truth & grown(mask)).sum() / truth.sum()
    return 2 * precision * recall / max(precision + recall, 1e-9), precision, recall


def main():
    work.mkdir(parents=True, exist_ok=True)
    scene("first", "--lights", "24", "--truth", work / "truth.png")
    truth = np.asarray(Image.open(work / "truth.png"))[..., :2].max(axis=2) > 127
    print("| pair | | F1 | precision | recall | marked where nothing has changed |\n|---|---|---|---|---|---|")
    for pair, options in PAIRS.items():
        scene("second", *options, "--scratch", "--stain")
        scene("unchanged", *options)
        for name, own in (("difference", []), ("difference, aligned, colours fitted", ["--register", "--fit-colours"])):
            changed, none = difference("first", "second", *own), difference("first", "unchanged", *own)
            best = max(np.quantile(changed, np.linspace(0.5, 0.999, 200)), key=lambda t: score(changed > t, truth)[0])
            f1, precision, recall = score(changed > best, truth)
            print(f"| {pair} | {name} | {f1:.2f} | {precision:.2f} | {recall:.2f} | {100 * (none > best).mean():.1f} % |")
        found = {}
        for name in ("second", "unchanged"):
            text = subprocess.run([build / "relume", "change", work / "first/lights.lp", work / name / "lights.lp", "-o",
                                   work / f"change-{name}", "--force", "--json", "-q"], check=True,
                                  stdout=subprocess.PIPE).stdout
            found[name] = json.loads(text)
        marked = np.asarray(Image.open(work / "change-second/changed.png").convert("RGB")).astype(int)
        f1, precision, recall = score(np.ptp(marked, axis=2) > 60, truth)
        print(f"| {pair} | **relume change** | {f1:.2f} | {precision:.2f} | {recall:.2f} | "
              f"{found['unchanged']['changed_percent']:.1f} % |", flush=True)


main()
