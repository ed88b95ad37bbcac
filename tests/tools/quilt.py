#!/usr/bin/env python3
"""Image quilting (Efros and Freeman, SIGGRAPH 2001) as published, to hold `relume btf synth` against.

Usage: quilt.py SAMPLE.ppm OUT.ppm WIDTH HEIGHT [BLOCK [SEED]]. Needs NumPy (Debian: python3-numpy).
"""
import sys
import numpy as np


def read_ppm(path):
    with open(path, "rb") as f:
        data = f.read()
    words, at = [], 0
    while len(words) < 4:
        while data[at:at + 1].isspace():
            at += 1
        start = at
        while not data[at:at + 1].isspace():
            at += 1
        words.append(data[start:at])
    width, height = int(words[1]), int(words[2])
    if words[0] != b"P6" or words[3] != b"255":
        sys.exit(path + ": expected a .ppm file of 8 bits")
    return np.frombuffer(data, np.uint8, width * height * 3, at + 1).reshape(height, width, 3)


def write_ppm(path, picture):
    with open(path, "wb") as f:
        f.write(b"P6\n%d %d\n255\n" % (picture.shape[1], picture.shape[0]))
        f.write(np.ascontiguousarray(picture, np.uint8).tobytes())


def cheapest(cost):
    """The column of the cheapest path from top to bottom, for each row."""
    total = cost.copy()
    for y in range(1, len(cost)):
        left = np.r_[np.inf, total[y - 1, :-1]]
        right = np.r_[total[y - 1, 1:], np.inf]
        total[y] += np.minimum(np.minimum(left, total[y - 1]), right)
    path = np.empty(len(cost), int)
    path[-1] = total[-1].argmin()
    for y in range(len(cost) - 2, -1, -1):
        low = max(path[y + 1] - 1, 0)
        path[y] = low + total[y, low:path[y + 1] + 2].argmin()
    return path


def overlap_errors(sample, wanted, known, block):
    """Sum of squares of every block of the sample against what is known, by transforms."""
    size = [sample.shape[0], sample.shape[1]]
    spectrum = lambda a: np.fft.rfft2(a, size)
    error = np.zeros((size[0] - block + 1, size[1] - block + 1))
    for c in range(3):
        s, w = sample[:, :, c], wanted[:, :, c] * known
        both = spectrum(s * s) * np.conj(spectrum(known)) - 2 * spectrum(s) * np.conj(spectrum(w))
        error += np.fft.irfft2(both, size)[:error.shape[0], :error.shape[1]] + (w * w).sum()
    return error


def quilt(sample, width, height, block, seed):
    rng = np.random.default_rng(seed)
    sample = sample.astype(float)
    lap = max(block // 6, 2)
    step = block - lap
    across, down = -(-(width - lap) // step), -(-(height - lap) // step)
    out = np.zeros((down * step + lap, across * step + lap, 3))
    for j in range(down):
        for i in range(across):
            y, x = j * step, i * step
            known = np.zeros((block, block))
            known[:lap] = j > 0
            known[:, :lap] = np.maximum(known[:, :lap], i > 0)
            there = out[y:y + block, x:x + block]
            error = overlap_errors(sample, there, known, block)
            fits = np.argwhere(error <= 1.1 * max(error.min(), 1e-9)) if known.any() \
                else np.argwhere(error >= 0)
            sy, sx = fits[rng.integers(len(fits))]
            new = sample[sy:sy + block, sx:sx + block]
            cost = ((new - there) ** 2).sum(2)
            take = np.ones((block, block), bool)
            if i:
                take &= np.arange(block)[None] >= cheapest(cost[:, :lap])[:, None]
            if j:
                take &= np.arange(block)[:, None] >= cheapest(cost[:lap].T)[None]
            there[take] = new[take]
    return out[:height, :width]


if __name__ == "__main__":
    width, height = int(sys.argv[3]), int(sys.argv[4])
    block = int(sys.argv[5]) if len(sys.argv) > 5 else 32
    seed = int(sys.argv[6]) if len(sys.argv) > 6 else 0
    write_ppm(sys.argv[2], quilt(read_ppm(sys.argv[1]), width, height, block, seed))
