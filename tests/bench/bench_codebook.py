#!/usr/bin/env python3
"""Codebook training against scikit-learn and faiss: one thread, the same vectors, the same start.

bench_codebook.py BUILD [RUNS]. The three take turns, so that a busy machine slows all of them; times are
those of training alone, squared errors are computed here for the codes that each returns. Also our
splitting start against the best of three starts of faiss's own.
"""
import os
import subprocess
import sys
import tempfile
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"
try:
    import faiss
    import numpy as np
    from sklearn.cluster import KMeans
except ImportError as why:
    print(f"codebook against scikit-learn and faiss: skipped: {why}")
    sys.exit(0)
import warnings

warnings.filterwarnings("ignore")  # not converged after the stated rounds
faiss.omp_set_num_threads(1)
tool = os.path.join(sys.argv[1], "tests/bench/bench_codebook")


def ours(files, dim, codes, rounds, *split):
    out = files["out"]
    args = [tool, "train", files["vectors"], str(dim), files["start"], str(codes), str(rounds), out]
    text = subprocess.run(args + list(split), check=True, capture_output=True, text=True).stdout
    return float(text), np.fromfile(out, np.float32).reshape(codes, dim)


def scikit(x, start, codes, rounds):
    begin = time.perf_counter()
    model = KMeans(codes, init=start, n_init=1, max_iter=rounds, tol=0, algorithm="lloyd").fit(x)
    return time.perf_counter() - begin, model.cluster_centers_


def facebook(x, start, codes, rounds, redo=1):
    clusters = faiss.Clustering(x.shape[1], codes)
    clusters.niter, clusters.nredo, clusters.max_points_per_centroid = rounds, redo, len(x)
    if start is not None:
        faiss.copy_array_to_vector(start.ravel(), clusters.centroids)
    begin = time.perf_counter()
    clusters.train(x, faiss.IndexFlatL2(x.shape[1]))
    seconds = time.perf_counter() - begin
    return seconds, faiss.vector_to_array(clusters.centroids).reshape(codes, x.shape[1])


def squared_error(x, codes):
    """Each vector against its nearest code; the distance itself is summed in double precision."""
    index = faiss.IndexFlatL2(x.shape[1])
    index.add(np.ascontiguousarray(codes, np.float32))
    total = 0.0
    for first in range(0, len(x), 65536):
        part = x[first : first + 65536]
        nearest = index.search(part, 1)[1][:, 0]
        total += float(((part.astype(np.float64) - codes[nearest]) ** 2).sum())
    return total


def compare(folder, n, dim, codes, rounds, runs):
    files = {name: os.path.join(folder, name) for name in ("vectors", "start", "out")}
    subprocess.run([tool, "make", files["vectors"], str(n), str(dim)], check=True)
    x = np.fromfile(files["vectors"], np.float32).reshape(n, dim)
    start = x[np.random.default_rng(1).choice(n, codes, replace=False)].copy()
    start.tofile(files["start"])
    methods = {
        "relume": lambda: ours(files, dim, codes, rounds),
        "scikit-learn": lambda: scikit(x, start, codes, rounds),
        "faiss": lambda: facebook(x, start, codes, rounds),
    }
    times = {name: [] for name in methods}
    found = {}
    for _ in range(runs):
        for name, run in methods.items():
            seconds, found[name] = run()
            times[name].append(seconds)
    print(f"codebook: {codes} codes for {n} x {dim}, {rounds} rounds, 1 thread, {runs} runs")
    median = {name: sorted(t)[len(t) // 2] for name, t in times.items()}
    error = {name: squared_error(x, c) for name, c in found.items()}
    for name, t in times.items():
        print(
            f"  {name:12} {median[name]:7.3f} s ({min(t):.3f} to {max(t):.3f}), {median[name] / median['relume']:6.2f} x"
            f" our time; squared error {error[name]:.6g} ({100 * (error[name] / error['relume'] - 1):+.4f} % of ours)"
        )
    return x, files


with tempfile.TemporaryDirectory() as folder:
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    x, files = compare(folder, 302778, 18, 256, 20, runs)
    seconds, codes = ours(files, 18, 256, 20, "split")
    best = min((facebook(x, None, 256, 20, 3) for _ in range(1)), key=lambda r: squared_error(x, r[1]))
    print(
        f"  splitting start: {seconds:.3f} s, squared error {squared_error(x, codes):.6g};"
        f" faiss, best of 3 starts of its own: {best[0]:.3f} s, {squared_error(x, best[1]):.6g}"
    )
    compare(folder, 1000000, 27, 4096, 2, 1)
