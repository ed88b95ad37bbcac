#!/usr/bin/env python3
"""Isosurfaces beside vtkFlyingEdges3D, and beside meshoptimizer at equal numbers of triangles
(docs/measurements/geometry.md).

    bench_isosurface.py BUILD DATA WORK [NAME ...]     NAME: knot64 ... bucky teapot ch2; default: all

BUILD has tests/bench/bench_isosurface; DATA is a folder with volumes/; WORK keeps made fields. All on
one thread, rounds of both programs in turn, the best time of the processor of each. Needs python3-vtk9, python3-numpy and
libmeshoptimizer-dev (Debian), and mricron-data for two heads; what is not there is skipped.
"""
import ctypes
import gzip
import json
import os
import subprocess
import sys
import time

import numpy as np
import vtkmodules.all as vtk
from vtkmodules.util import numpy_support

ROUNDS = 3
build, data, work = sys.argv[1:4]
wanted = sys.argv[4:]
bench = os.path.join(build, "tests/bench/bench_isosurface")
vtk.vtkSMPTools.Initialize(1)
os.makedirs(work, exist_ok=True)


def unpacked(path):
    opener = gzip.open if path.endswith(".gz") else open
    with opener(path, "rb") as file:
        return file.read()


def flying_edges(samples, size, threshold):
    """Best of three times, and the triangles."""
    image = vtk.vtkImageData()
    image.SetDimensions(*size)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(samples))
    best = 1e9
    for _ in range(3):
        f = vtk.vtkFlyingEdges3D()
        f.SetInputData(image)
        f.SetValue(0, threshold)
        f.ComputeNormalsOn()
        f.ComputeGradientsOff()
        f.ComputeScalarsOff()
        start = time.process_time()
        f.Update()
        best = min(best, time.process_time() - start)
    return best, f.GetOutput().GetNumberOfPolys()


def ours(path, size, kind, threshold):
    return json.loads(subprocess.check_output([bench, "volume", path, size, kind, str(threshold)]))


def simplified(fine, triangles, out):
    """meshopt_simplify of a PLY of relume's to that many triangles; its time."""
    try:
        library = ctypes.CDLL("libmeshoptimizer.so")
    except OSError:
        return None
    reader = vtk.vtkPLYReader()
    reader.SetFileName(fine)
    reader.Update()
    mesh = reader.GetOutput()
    points = np.ascontiguousarray(numpy_support.vtk_to_numpy(mesh.GetPoints().GetData()), np.float32)
    index = np.ascontiguousarray(
        numpy_support.vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()), np.uint32)
    result = np.zeros_like(index)
    simplify = library.meshopt_simplify
    simplify.restype = ctypes.c_size_t
    error = ctypes.c_float()
    pointer = lambda a: a.ctypes.data_as(ctypes.c_void_p)
    start = time.process_time()
    count = simplify(pointer(result), pointer(index), ctypes.c_size_t(index.size), pointer(points),
                     ctypes.c_size_t(len(points)), ctypes.c_size_t(12),
                     ctypes.c_size_t(3 * triangles), ctypes.c_float(1e9), ctypes.c_uint(0),
                     ctypes.byref(error))
    taken = time.process_time() - start
    faces = result[:count].reshape(-1, 3)
    with open(out, "wb") as file:
        file.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\n"
                   b"property float y\nproperty float z\nelement face %d\n"
                   b"property list uchar uint vertex_indices\nend_header\n" % (len(points), len(faces)))
        file.write(points.tobytes())
        rows = np.zeros(len(faces), dtype=[("n", "u1"), ("v", "<u4", 3)])
        rows["n"] = 3
        rows["v"] = faces
        file.write(rows.tobytes())
    return taken


def volumes():
    for kind, n in (("knot", 64), ("knot", 128), ("knot", 256), ("gyroid", 256), ("sphere", 257)):
        path = os.path.join(work, "%s%d.raw" % (kind, n))
        if wanted and "%s%d" % (kind, n) not in wanted:
            continue
        if not os.path.exists(path):
            subprocess.check_call([bench, "make", kind, str(n), path])
        yield "%s%d" % (kind, n), path, (n, n, n), "f32", 0.0, np.float32
    for name, size, threshold in (("bucky_32x32x32_u8.raw", (32, 32, 32), 127.5),
                                  ("teapot_ct_256x256x178_u8.raw.gz", (256, 256, 178), 50.5)):
        path = os.path.join(data, "volumes", name)
        if os.path.exists(path):
            yield name.split("_")[0], path, size, "u8", threshold, np.uint8
    for name, threshold in (("ch2", 60.5), ("ch2bet", 60.5)):
        path = "/usr/share/mricron/templates/%s.nii.gz" % name
        if os.path.exists(path):
            raw = os.path.join(work, name + ".raw")
            with open(raw, "wb") as file:
                file.write(unpacked(path)[352:])
            yield name, raw, (181, 217, 181), "u8", threshold, np.uint8


for name, path, size, kind, threshold, dtype in volumes():
    if wanted and name not in wanted:
        continue
    samples = np.frombuffer(unpacked(path), dtype)
    text = "x".join(map(str, size))
    best_fe, best = 1e9, None
    for _ in range(ROUNDS):
        seconds, triangles = flying_edges(samples, size, threshold)
        best_fe = min(best_fe, seconds)
        found = ours(path, text, kind, threshold)
        if best is None:
            best = found
        for a, b in zip(best["levels"], found["levels"]):
            for key in ("s", "indexed_s"):
                a[key] = min(a[key], b[key])
    print("%-8s %-12s FE %8d tri %7.1f ms" % (name, text, triangles, 1e3 * best_fe))
    for a in best["levels"]:
        print("   N=%d %8d tri (FE / %5.2f) %7.1f ms (%.2f of FE), indexed %7.1f ms (saves %2.0f %%), "
              "rms %.3f max %.2f" % (a["block"], a["triangles"], triangles / a["triangles"],
                                     1e3 * a["s"], a["s"] / best_fe, 1e3 * a["indexed_s"],
                                     100 - 100 * a["indexed_s"] / a["s"], a["rms"], a["max"]))
    fine, coarse = os.path.join(work, "fine.ply"), os.path.join(work, "coarse.ply")
    subprocess.check_call([os.path.join(build, "relume"), "mesh", path, "--size", text, "--type", kind,
                           "--threshold", str(threshold), "-o", fine, "-q"])
    for level in (2, 3):
        seconds = simplified(fine, best["levels"][level]["triangles"], coarse)
        if seconds is None:
            continue
        e = json.loads(subprocess.check_output([bench, "error", coarse, path, text, kind,
                                                str(threshold)]))
        print("   meshoptimizer to N=%d: %8d tri, %7.1f ms (%.1f of N=%d's), rms %.3f max %.2f" %
              (best["levels"][level]["block"], e["triangles"], 1e3 * seconds,
               seconds / best["levels"][level]["s"], best["levels"][level]["block"], e["rms"], e["max"]))
    sys.stdout.flush()
