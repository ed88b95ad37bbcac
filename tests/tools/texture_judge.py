#!/usr/bin/env python3
"""How a synthesised picture compares with its sample, whoever made it: an independent form of what
`relume btf synth` prints, on pictures in place of maps.

Usage: texture_judge.py SAMPLE.ppm PICTURE.ppm [PERIOD_X PERIOD_Y]. Prints the highest correlation of
the picture with itself moved by at least half a sample (what repeats with the given period is
averaged out first; 0: nothing does), and the mean distance of neighbourhoods of 5 x 5 pixels to the
nearest of the sample over that of the sample's own. Needs NumPy (Debian: python3-numpy).
"""
import os
import sys
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from quilt import read_ppm

LUMA = np.array([0.299, 0.587, 0.114])


def without_structure(grey, period):
    """Less the mean over all pixels of the same phase, in quarters of a pixel."""
    h, w = grey.shape
    bins = [max(int(round(4 * p)), 1) for p in period]
    if period[0] <= 0 and period[1] <= 0:
        return grey - grey.mean()
    phase = [np.floor((np.arange(n) / p % 1.0) * b).astype(int) if p > 0 else np.zeros(n, int)
             for n, p, b in zip((w, h), period, bins)]
    cell = phase[1][:, None] * bins[0] + phase[0][None]
    count = np.bincount(cell.ravel(), minlength=bins[0] * bins[1])
    mean = np.bincount(cell.ravel(), grey.ravel(), bins[0] * bins[1]) / np.maximum(count, 1)
    return grey - mean[cell]


def repetition(grey, sample_size):
    grey = grey[:2048, :2048]
    h, w = grey.shape
    size = (2 * h, 2 * w)
    power = np.abs(np.fft.rfft2(grey - grey.mean(), size)) ** 2
    found = np.fft.irfft2(power, size)
    best = 0.0
    for sign in (1, -1):
        dy = np.arange(h // 2 + 1)
        dx = np.arange(w // 2 + 1) * sign
        part = found[np.ix_(dy, dx % size[1])]
        part = part / ((h - dy)[:, None] * (w - abs(dx))[None])
        part[(dy[:, None] < sample_size[0] // 2) & (abs(dx)[None] < sample_size[1] // 2)] = 0
        best = max(best, part.max())
    return best / (found[0, 0] / (h * w))


def neighbourhoods(picture, places):
    return np.array([picture[y:y + 5, x:x + 5].ravel() for y, x in places], float)


def nearest(queries, all_n, apart=None):
    squares = (all_n ** 2).sum(1)
    out = []
    for i, q in enumerate(queries):
        d = squares - 2 * all_n @ q + q @ q
        if apart is not None:
            d[apart(i)] = np.inf
        out.append(np.sqrt(max(d.min(), 0.0)))
    return np.mean(out)


def main():
    sample, picture = read_ppm(sys.argv[1]), read_ppm(sys.argv[2])
    period = [float(a) for a in sys.argv[3:5]] or [0.0, 0.0]
    rng = np.random.default_rng(1)
    h, w = sample.shape[:2]
    every = [(y, x) for y in range(h - 4) for x in range(w - 4)]
    places = np.array(every)
    all_n = neighbourhoods(sample, every)
    some = rng.integers(0, [picture.shape[0] - 4, picture.shape[1] - 4], (250, 2))
    own = rng.integers(0, [h - 4, w - 4], (250, 2))
    far = nearest(neighbourhoods(picture, some), all_n)
    usual = nearest(neighbourhoods(sample, own), all_n,
                    lambda i: (abs(places - own[i]) < 5).all(1))
    plain = without_structure(picture @ LUMA, period)
    print("%.3f %.3f" % (repetition(plain, (h, w)), far / usual))


main()
