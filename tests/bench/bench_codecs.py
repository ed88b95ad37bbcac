#!/usr/bin/env python3
"""Bytes at equal quality of lights that were not captured: relume's files and web folders against
video and still codecs of all captured pictures (docs/measurements/compression.md).

    bench_codecs.py BUILD DATA WORK [CAPTURE ...]     CAPTURE: single multi item1 teapot slab chess attic

Codecs keep the captured pictures; a light between them is interpolated from the decoded ones, by
whatever `relume encode --basis table` does best on pictures without loss: moving highlights are
found in the decoded pictures and cost the codec nothing. Bytes are those of the video's stream
without a container, of all JPEGs, of a web folder with info.json after gzip, of relume's whole file.
PSNR is psnr_pooled_db of `relume eval`; of chess, which has one light, on the captured pictures.

Needs Python 3 alone, ffmpeg with libaom and libx265, djpeg and cjpeg; without ffmpeg or djpeg all is
skipped, without an encoder its rows.
DATA is a folder with synthrti, realrti and lf-stanford-chess-9x9; a capture that is not there is
skipped. Results stay in WORK/points.csv: a run that was stopped goes on, points there are not
measured again. One or two hours on two cores; slab, 8100 pictures at one level, takes as long again
and 20 GB, and is measured where it is named only.
"""
import csv
import glob
import gzip
import json
import math
import os
import shutil
import subprocess
import sys
import time

SURFACES = {"single": "synthrti/Single/Object2/material3", "multi": "synthrti/Multi/Object1/material3"}
TEAPOT = ["--views", "5x5", "--size", "128", "--hemisphere"]
SLAB = ["--views", "9x9", "--size", "128", "--hemisphere"]
EYES = ["--eye", "0,0,3", "--eye", "0.25,-0.25,3", "--eye=-0.5,0.5,3"]  # cameras of these slabs
ATTIC = ["--projection", "cylindrical", "--size", "192"]
# what is tried of each: PSNR of `encode --psnr`, crf of AV1 and x265, quality of JPEG, bytes a pixel of a
# web folder; None where it cannot be made
RATES = {
    "single": ([29, 32], [52, 40, 26, 14, 6], [38, 30, 22, 16, 10], [10, 30, 70, 90, 96], [0.25, 0.5, 1, 2, 4]),
    "multi": ([38, 42, 45], [38, 24, 12, 5], [30, 22, 15, 9], [50, 90], [0.25, 1, 2]),
    "item1": ([36, 38, 39], [44, 32, 22, 10], [34, 26, 19, 12], [40, 80, 93], [0.3, 1]),
    "teapot": ([36], [46, 32], [34, 26], [30], [0.5]),
    "slab": ([36, 40], [46, 38, 28], [32, 26], [40, 75], None),
    "chess": ([37], [48, 38], [32, 26], [15, 40], None),
    "attic": ([25, 36], [62, 56, 48, 38], [46, 40, 34, 26], [5, 20, 60], None),
}
NEEDS = {**SURFACES, "item1": "realrti/item1", "chess": "lf-stanford-chess-9x9"}
LEVELS = {"chess": (36.95,)}
DOMAINS = {"slab": ("display",)}  # what decoded pictures are interpolated in: of others both
LOWER = (0.25, 1.0)  # the levels: so much below the best that both relume and the pictures reach

SWS = "accurate_rnd+full_chroma_int+full_chroma_inp"
TO_YUV = "scale=out_color_matrix=bt709:out_range=full:flags=%s,format=yuv444p" % SWS
TO_RGB = "scale=in_color_matrix=bt709:in_range=full:flags=%s,format=rgb24" % SWS
VIDEO = {
    "AV1": ("obu", "libaom-av1", ["-cpu-used", "6", "-b:v", "0", "-row-mt", "1", "-g", "9999"]),
    "x265": ("hevc", "libx265", ["-preset", "medium", "-x265-params", "log-level=error:keyint=-1"]),
}


# libaom 3.6 stops at an assertion in long videos of these captures: runs of so many pictures, and how far ahead
# it looks. With 25 it keeps all 8100 of slab in one run; with 19 it stops even in runs of 162.
RUNS = {"teapot": (500, 19), "slab": (8100, 25)}
PNG = ["-compression_level", "1"]


def numbered(folder, ending, first=0):
    return ["-start_number", str(first), "-i", folder + "/%05d" + ending]


def run(*command, **more):
    done = subprocess.run([str(c) for c in command], capture_output=True, **more)
    if done.returncode:
        sys.exit("%s\n%s" % (" ".join(map(str, command)), done.stderr.decode()[-400:]))
    return done.stdout


class Capture:
    """A capture and its pictures in the order of a video, as 8-bit PNGs."""

    def __init__(self, relume, data, work, name):
        self.relume, self.name, self.folder = relume, name, os.path.join(work, name)
        os.makedirs(self.folder, exist_ok=True)
        self.unseen = os.path.join(self.folder, "unseen")
        getattr(self, "_" + ("surface" if name in SURFACES else name))(data)
        self._read()
        self._pictures()

    def _surface(self, data):
        folder = os.path.join(data, SURFACES[self.name])
        self.path, self.unseen = folder + "/Dome/dirs.lp", folder + "/Test/dirs.lp"

    def _item1(self, data):
        """Every sixth photograph is kept from the codecs."""
        with open(data + "/realrti/item1/dirs.lp") as f:
            lines = f.read().split("\n")[1:]
        lines = [line for line in lines if line.strip()]
        for name in (line.split()[0] for line in lines):
            if not os.path.exists(os.path.join(self.folder, name)):
                os.symlink("%s/realrti/item1/%s" % (data, name), os.path.join(self.folder, name))
        for name, part in (("unseen", lines[3::6]), ("photographs", [l for i, l in enumerate(lines) if i % 6 != 3])):
            with open(os.path.join(self.folder, name + ".lp"), "w") as f:
                f.write("%d\n%s\n" % (len(part), "\n".join(part)))
        self.path, self.unseen = self.folder + "/photographs.lp", self.folder + "/unseen.lp"

    def _synth(self, name, *options):
        path = os.path.join(self.folder, name)
        if not os.path.exists(path):
            run(self.relume, "synth", "attic" if self.name == "attic" else "teapot", "-o", path, *options, "-q")
        return path

    def _slab_of(self, options, size):
        self.path = self._synth("capture", *options, "--lights", "100")
        random = ["--lights", "16", "--pattern", "random", "--seed", "7", "--hemisphere"]
        self._synth("unseen", *random, "--projection", "slab", "--size", size, *EYES)

    def _teapot(self, data):
        self._slab_of(TEAPOT, "128")

    def _slab(self, data):
        self._slab_of(SLAB, "128")

    def _attic(self, data):
        self.path = self._synth("capture", *ATTIC, "--lights", "64")
        self._synth("unseen", *ATTIC, "--lights", "12", "--pattern", "random", "--seed", "7")

    def _chess(self, data):
        self.path, self.unseen = self.folder + "/capture", None
        views = sorted(glob.glob(data + "/lf-stanford-chess-9x9/view_*.jpg"))
        if not os.path.exists(self.path):
            run(self.relume, "lightfield", *views, "-o", self.path, "-q")

    def _read(self):
        """Views as lists of pictures, directions, and the coding order: light by light in a chain of
        nearest ones, views there and back."""
        if self.path.endswith(".lp"):
            with open(self.path) as f:
                rows = [line.split() for line in f.read().split("\n")[1:] if line.strip()]
            base = os.path.dirname(self.path)
            self.manifest, self.views = None, [[os.path.join(base, r[0]) for r in rows]]
            self.lights = [[float(x) for x in r[1:4]] for r in rows]
            places = [[0, 0]]
        else:
            with open(self.path + "/capture.json") as f:
                self.manifest = json.load(f)
            views = self.manifest["views"]
            self.views = [[os.path.join(self.path, i) for i in v["images"]] for v in views]
            self.lights = self.manifest["lights"]["directions"]
            places = [v.get("uv", [k, 0]) for k, v in enumerate(views)]
        self.linear = self.views[0][0].endswith(".exr")
        chain, left = [0], set(range(1, len(self.lights)))
        while left:
            last = self.lights[chain[-1]]
            chain.append(max(sorted(left), key=lambda i: sum(a * b for a, b in zip(self.lights[i], last))))
            left.remove(chain[-1])
        eyes, rows = [], sorted({round(p[1], 4) for p in places})
        for i, row in enumerate(rows):
            line = [k for k, p in enumerate(places) if round(p[1], 4) == row]
            eyes += sorted(line, key=lambda k: places[k][0], reverse=i % 2 == 1)
        self.order = [(v, l) for i, l in enumerate(chain) for v in (eyes if i % 2 == 0 else eyes[::-1])]

    def _pictures(self):
        """WORK/NAME/pictures: what the codecs are given."""
        self.pictures = os.path.join(self.folder, "pictures")
        if os.path.exists(self.pictures):
            return
        links, making = os.path.join(self.folder, "links"), self.pictures + ".making"
        for folder in (links, making):
            shutil.rmtree(folder, ignore_errors=True)
            os.makedirs(folder)
        ending = ".exr" if self.linear else ".ppm"
        for k, (v, l) in enumerate(self.order):
            if self.linear:
                os.symlink(os.path.abspath(self.views[v][l]), "%s/%05d.exr" % (links, k))
            else:  # as relume decodes it; ffmpeg has chroma of its own
                run("djpeg", "-outfile", "%s/%05d.ppm" % (links, k), self.views[v][l])
        run("ffmpeg", "-v", "error", *(["-apply_trc", "iec61966_2_1"] if self.linear else []), *numbered(links, ending),
            "-sws_flags", SWS, "-pix_fmt", "rgb24", *PNG, "-start_number", "0", making + "/%05d.png")
        shutil.rmtree(links)
        os.rename(making, self.pictures)

    def decoded(self, folder, ending):
        """Makes folder, which holds decoded pictures in coding order, a capture."""
        names = {at: "%05d%s" % (k, ending) for k, at in enumerate(self.order)}
        if self.manifest is None:
            with open(folder + "/dirs.lp", "w") as f:
                f.write("%d\n" % len(self.lights))
                for l, d in enumerate(self.lights):
                    f.write("%s %r %r %r\n" % (names[0, l], *d))
            return folder + "/dirs.lp"
        made = json.loads(json.dumps(self.manifest))
        made["transfer"] = "srgb"
        for v, view in enumerate(made["views"]):
            view["images"] = [names[v, l] for l in range(len(self.lights))]
            view.pop("depth", None)
            view.pop("mask", None)
        with open(folder + "/capture.json", "w") as f:
            json.dump(made, f)
        return folder


class Bench:
    """Points of one capture: bytes and PSNR of each method at each rate."""

    def __init__(self, capture, points):
        self.capture, self.points, self.relume = capture, points, capture.relume
        self.scratch = os.path.join(capture.folder, "scratch")

    def psnr(self, file, capture):
        return json.loads(run(self.relume, "eval", file, capture, "--json"))["psnr_pooled_db"]

    def point(self, method, rate, make):
        """make() answers bytes and a file to be judged; a point that is known is not made again."""
        key = (self.capture.name, method, str(rate))
        if key in self.points.known:
            return
        shutil.rmtree(self.scratch, ignore_errors=True)
        os.makedirs(self.scratch)
        begin = time.time()
        size, *judged = make(rate)
        seconds = time.time() - begin
        files, capture = judged[0], self.capture
        files = files if isinstance(files, list) else [(files, capture.path, capture.unseen)]
        captured = pooled([self.psnr(file, path) for file, path, _ in files])
        unseen = pooled([self.psnr(file, path) for file, _, path in files]) if capture.unseen else captured
        self.points.add(*key, size, captured, unseen, seconds)
        shutil.rmtree(self.scratch)

    def encode(self, source, *options):
        out = os.path.join(self.scratch, "made.exr")
        run(self.relume, "encode", source, "-o", out, "-q", *options)
        return out

    def moving(self):
        """Of surfaces highlights move with the light, where that helps."""
        return [] if self.capture.manifest else ["--highlights", "auto"]

    def default(self, rate):
        out = self.encode(self.capture.path)
        return os.path.getsize(out), out

    def lossy(self, rate):
        out = self.encode(self.capture.path, "--psnr", rate, *self.moving())
        return os.path.getsize(out), out

    def interpolated(self, pictures, ending, domain):
        made = self.capture.decoded(pictures, ending)
        return self.encode(made, "--basis", "table", "--interpolant", "auto", "--bits", "16", "--domain", domain,
                           "--compression", "none", *self.moving())

    def lossless(self, domain):
        """The captured pictures as the codecs see them, interpolated in this domain."""
        folder = os.path.join(self.scratch, "pictures")
        shutil.copytree(self.capture.pictures, folder)
        size = sum(os.path.getsize(os.path.join(folder, f)) for f in os.listdir(folder))
        return size, self.interpolated(folder, ".png", domain)

    def video(self, kind, domain, crf):
        muxer, codec, options = VIDEO[kind]
        pictures, run_of, size = len(self.capture.order), len(self.capture.order), 0
        if kind == "AV1" and self.capture.name in RUNS:
            run_of, look_ahead = RUNS[self.capture.name]
            options = options + ["-lag-in-frames", str(look_ahead)]
        out, decoded = os.path.join(self.scratch, "video." + muxer), os.path.join(self.scratch, "decoded")
        os.makedirs(decoded)
        for first in range(0, pictures, run_of):
            run("ffmpeg", "-v", "error", "-y", "-r", "30", *numbered(self.capture.pictures, ".png", first), "-frames:v",
                run_of, "-vf", TO_YUV, "-color_range", "pc", "-c:v", codec, *options, "-crf", crf, "-f", muxer, out)
            run("ffmpeg", "-v", "error", "-i", out, "-vf", TO_RGB, "-vsync", "passthrough", *PNG,
                "-start_number", first, decoded + "/%05d.png")
            size += os.path.getsize(out)
        if len(os.listdir(decoded)) != pictures:
            sys.exit("%s: %d pictures decoded" % (kind, len(os.listdir(decoded))))
        return size, self.interpolated(decoded, ".png", domain)

    def jpeg(self, domain, quality):
        decoded, size = os.path.join(self.scratch, "decoded"), 0
        os.makedirs(decoded)
        plain = os.path.join(self.scratch, "plain")
        os.makedirs(plain)
        run("ffmpeg", "-v", "error", *numbered(self.capture.pictures, ".png"), "-start_number", "0",
            plain + "/%05d.ppm")
        for k in range(len(self.capture.order)):
            out = "%s/%05d.jpg" % (decoded, k)
            run("cjpeg", "-quality", quality, "-sample", "1x1", "-optimize", "-progressive", "-outfile", out,
                "%s/%05d.ppm" % (plain, k))
            size += os.path.getsize(out)
        return size, self.interpolated(decoded, ".jpg", domain)

    def web(self, rate):
        """A slab's web folders are one for each view; those of the judged views stand for all."""
        file = self.encode(self.capture.path, "--basis", "table", "--interpolant", "auto", "--bits", "16")
        if len(self.capture.views) == 1:
            size, shown = self.folder_of(file, 0, rate)
            return size, [(shown, self.capture.path, self.capture.unseen)]
        with open(self.capture.unseen + "/capture.json") as f:
            unseen = json.load(f)
        size, files = 0, []
        for v, view in enumerate(unseen["views"]):
            at = next(k for k, c in enumerate(self.capture.manifest["views"]) if near(c["uv"], view["uv"]))
            bytes_of_view, shown = self.folder_of(file, at, rate)
            size += bytes_of_view * len(self.capture.views) / len(unseen["views"])
            files.append((shown, self.one_view(self.capture.path, self.capture.manifest, at),
                          self.one_view(self.capture.unseen, unseen, v)))
        return size, files

    def folder_of(self, file, view, rate):
        out = os.path.join(self.scratch, "web%d" % view)
        run(self.relume, "export", file, "--to", "relight", "-o", out, "--bytes-per-pixel", rate, "--view", view, "-q")
        run(self.relume, "import", out, "-o", out + ".exr", "-q")
        return folder_bytes(out), out + ".exr"

    def one_view(self, folder, manifest, view):
        """A view of a slab as a planar capture, beside the slab's own."""
        images = manifest["views"][view]["images"]
        made = {"format": "relume-capture", "version": 1, "transfer": "linear", "projection": "planar",
                "lights": {"directions": manifest["lights"]["directions"]}, "views": [{"images": images}]}
        path = os.path.join(folder, "view%d.json" % view)
        with open(path, "w") as f:
            json.dump(made, f)
        return path


def near(a, b):
    return max(abs(x - y) for x, y in zip(a, b)) < 1e-4


def pooled(decibels):
    return -10 * math.log10(sum(10 ** (-d / 10) for d in decibels) / len(decibels))


def folder_bytes(folder):
    """As a web server sends it: info.json is compressed on the way."""
    size = 0
    for name in os.listdir(folder):
        with open(os.path.join(folder, name), "rb") as f:
            content = f.read()
        size += len(gzip.compress(content)) if name.endswith(".json") else len(content)
    return size


class Points:
    def __init__(self, path):
        self.path, self.known = path, {}
        if os.path.exists(path):
            with open(path) as f:
                for row in list(csv.reader(f))[1:]:
                    self.known[tuple(row[:3])] = [float(x) for x in row[3:]]
        else:
            with open(path, "w") as f:
                f.write("capture,method,rate,bytes,captured_db,unseen_db,seconds\n")

    def add(self, capture, method, rate, size, captured, unseen, seconds):
        self.known[capture, method, rate] = [size, captured, unseen, seconds]
        row = "%s,%s,%s,%d,%.3f,%.3f,%.0f" % (capture, method, rate, size, captured, unseen, seconds)
        with open(self.path, "a") as f:
            f.write(row + "\n")
        print(row, flush=True)

    def curve(self, capture, method):
        return sorted(v[:3] for k, v in self.known.items() if k[:2] == (capture, method))


def measure(bench, rates, part, missing):
    capture, known = bench.capture, bench.points.known
    psnr, av1, x265, jpeg, web = rates
    if part == "lossy":
        for rate in psnr:
            bench.point("lossy", rate, bench.lossy)
        return
    bench.point("relume", "default", bench.default)
    domains = DOMAINS.get(capture.name, ("display", "linear"))
    for domain in domains:
        bench.point("pictures", domain, bench.lossless)
    domain = max(domains, key=lambda d: known[capture.name, "pictures", d][2])
    for crf in av1 if "AV1" not in missing else ():
        bench.point("AV1", crf, lambda r: bench.video("AV1", domain, r))
    for crf in x265 if "x265" not in missing else ():
        bench.point("x265", crf, lambda r: bench.video("x265", domain, r))
    for quality in jpeg if "JPEG" not in missing else ():
        bench.point("JPEG", quality, lambda r: bench.jpeg(domain, r))
    for rate in web or ():
        bench.point("web", rate, bench.web)


def at(curve, level):
    """Bytes at a PSNR: the logarithm between the points around it, which rise."""
    best = []
    for p in curve:
        if not best or p[2] > best[-1][2]:
            best.append(p)
    if not best:
        return "-"
    if level > best[-1][2]:
        return "(%.2f dB at %s)" % (best[-1][2], kilobytes(best[-1][0]))
    if level <= best[0][2]:
        return "below %s" % kilobytes(best[0][0])
    for low, high in zip(best, best[1:]):
        if level <= high[2]:
            t = (level - low[2]) / (high[2] - low[2])
            return kilobytes(low[0] * (high[0] / low[0]) ** t)
    return "-"


def kilobytes(size):
    return "%.3g kB" % (size / 1000) if size < 1e6 else "%.0f kB" % (size / 1000)


def table(points, names):
    methods = ("lossy", "web", "AV1", "x265", "JPEG")
    print("| capture | default | pictures reach | at | " + " | ".join(methods) + " |\n" + "|---" * 9 + "|")
    for name in names:
        pictures, (file,) = points.curve(name, "pictures"), points.curve(name, "relume")
        reach = max(p[2] for p in pictures)
        for level in LEVELS.get(name) or [min(reach, file[2]) - d for d in LOWER]:
            print("| %s | %s at %.2f dB | %.2f dB | %.2f dB | %s |" % (
                name, kilobytes(file[0]), file[2], reach, level,
                " | ".join(at(points.curve(name, m), level) for m in methods)))


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    relume, data, work = os.path.join(os.path.abspath(sys.argv[1]), "relume"), sys.argv[2], sys.argv[3]
    for tool in ("ffmpeg", "djpeg"):
        if not shutil.which(tool):
            sys.exit("bench_codecs: skipped: no %s" % tool)
    missing = [m for m in VIDEO if VIDEO[m][1].encode() not in run("ffmpeg", "-v", "error", "-encoders")]
    missing += [] if shutil.which("cjpeg") else ["JPEG"]
    for method in missing:
        print("%s: skipped: %s" % (method, "no cjpeg" if method == "JPEG" else "ffmpeg has no " + VIDEO[method][1]))
    os.makedirs(work, exist_ok=True)
    points, benches = Points(os.path.join(work, "points.csv")), []
    for name in sys.argv[4:] or [n for n in RATES if n != "slab"]:
        needed = NEEDS.get(name)
        if needed and not os.path.exists(os.path.join(data, needed)):
            print("%s: skipped: no %s" % (name, os.path.join(data, needed)))
            continue
        benches.append(Bench(Capture(relume, os.path.abspath(data), os.path.abspath(work), name), points))
    for part in ("others", "lossy"):  # the slowest last
        for bench in benches:
            measure(bench, RATES[bench.capture.name], part, missing)
    table(points, [bench.capture.name for bench in benches])


if __name__ == "__main__":
    main()
