"""The Python module against closed forms and the command line tool.

    RELUME_LIBRARY=.../librelume.so RELUME=.../relume python -m unittest tests/test_relume.py
"""

import json
import logging
import os
import pathlib
import subprocess
import tempfile
import threading
import unittest

import numpy as np

import relume

TOOL = os.environ.get("RELUME")
WIDTH, HEIGHT, LIGHTS = 40, 30, 20
ALBEDO = np.array([0.8, 0.6, 0.4])


def ball():
    """Unit normals [y, x, 3] of a ball, 0 beside it."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    u, v = ((x + 0.5) / WIDTH - 0.5) * 2.2, (0.5 - (y + 0.5) / HEIGHT) * 2.2
    w = np.sqrt(np.maximum(1.0 - u * u - v * v, 0.0))
    return np.stack([u, v, w], -1) * (w > 0.0)[..., None]


def lit(normals, directions):
    """Half Lambert, (1 + n . l) / 2, which four harmonics hold exactly: [light, y, x, 3]."""
    cosine = 0.5 + 0.5 * np.einsum("yxk,lk->lyx", normals, directions)
    return (cosine[..., None] * ALBEDO).astype(np.float32)


class Fixture(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.normals = ball()
        cls.lights = relume.light_directions("hammersley", LIGHTS)
        cls.pictures = lit(cls.normals, cls.lights)
        cls.data = relume.encode(cls.pictures, cls.lights, basis="sh", coefficients=4, bits="half")
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()


class Relighting(Fixture):
    def test_a_new_light(self):
        light = np.array([0.3, -0.5, 0.7])
        with relume.open(self.data) as file:
            got = file.relight(light)
        want = lit(self.normals, [light / np.linalg.norm(light)])[0]
        self.assertEqual((got.shape, got.dtype), (want.shape, np.float32))
        # half floats: 2^-11 of coefficients up to 1, four of them
        np.testing.assert_allclose(got, want, atol=4 * 2.0**-11)

    def test_lights_add(self):
        with relume.open(self.data) as file:
            both = file.relight(["dir 0 0 1", "dir 1 0 0 rgb 0.5 0 0"])
            apart = file.relight((0, 0, 1)) + file.relight("dir 1 0 0 rgb 0.5 0 0")
            same = file.relight([(0, 0, 1), (0, 0, 1)])
            np.testing.assert_allclose(same, 2 * file.relight(), atol=1e-5)
        np.testing.assert_allclose(both, apart, atol=1e-5)  # sums of floats below 3

    def test_weights_and_coefficients_are_the_picture(self):
        light = (0.2, 0.4, 0.9)
        with relume.open(self.data) as file:
            weights, constant = file.weights(light)
            coefficients = file.coefficients()
            picture = file.relight(light)
        self.assertEqual(coefficients.shape, (3, 4, HEIGHT, WIDTH))
        made = np.einsum("ck,ckyx->yxc", weights, coefficients) + constant
        np.testing.assert_allclose(made, picture, atol=1e-5)

    def test_one_set_for_all_channels(self):
        data = relume.encode(self.pictures, self.lights, basis="pca", coefficients=5)
        with relume.open(data) as file:
            weights, constant = file.weights((0, 0, 1))
            coefficients = file.coefficients()
            self.assertEqual(coefficients.shape[1:], (HEIGHT, WIDTH))
            made = np.einsum("ck,kyx->yxc", weights, coefficients) + constant
            np.testing.assert_allclose(made, file.relight((0, 0, 1)), atol=1e-5)

    def test_logarithms(self):
        data = relume.encode(self.pictures, self.lights, basis="eigen", domain="log:0.05")
        with relume.open(data) as file:
            self.assertEqual((file.info.basis, file.info.domain), ("eigen", "log"))
            light = file.directions[0]
            weights, constant = file.weights(light)
            codes = np.einsum("ck,ckyx->yxc", weights, file.coefficients()) + constant
            made = 0.05 * (np.exp(codes * np.log(21)) - 1)
            np.testing.assert_allclose(made, file.relight(light), atol=1e-4)
        with self.assertRaises(relume.UsageError):
            relume.encode(self.pictures, self.lights, domain="lag")

    def test_size_and_views(self):
        with relume.open(self.data) as file:
            self.assertEqual(file.relight(size=(20, 15)).shape, (15, 20, 3))
            self.assertEqual(file.relight(view=0).shape, (HEIGHT, WIDTH, 3))
            with self.assertRaises(relume.UsageError):
                file.relight(view=0, look=(0, 0, 1))
            with self.assertRaises(relume.UsageError):
                file.relight(view=3)

    def test_for_the_screen(self):
        with relume.open(self.data) as file:
            linear, codes = 0.5 * file.relight(), file.display(exposure_ev=-1)
        self.assertEqual((codes.shape, codes.dtype), ((HEIGHT, WIDTH, 4), np.uint8))
        srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
        np.testing.assert_allclose(codes[..., :3], 255 * srgb, atol=0.51)  # rounded
        self.assertTrue((codes[..., 3] == 255).all())

    def test_lights_change_and_come_back(self):
        with relume.open(self.data) as file:
            first = file.relight((0, 0, 1))
            self.assertFalse(np.array_equal(file.relight((1, 0, 0)), first))
            with self.assertRaises(relume.UsageError):
                file.relight("dir 0 0 0")
            np.testing.assert_array_equal(file.relight((0, 0, 1)), first)

    def test_info(self):
        with relume.open(self.data) as file:
            info = file.info
            np.testing.assert_allclose(file.directions, self.lights, atol=1e-6)  # stored as floats
        self.assertEqual((info.basis, info.coefficients, info.bits), ("sh", 4, "half"))
        self.assertEqual((info.width, info.height, info.views), (WIDTH, HEIGHT, 1))
        self.assertEqual((info.lights, info.domain, info.projection), (LIGHTS, "linear", "planar"))
        self.assertEqual(info.file_bytes, len(self.data))

    def test_threads(self):
        with relume.open(self.data) as file:
            want, got = file.relight(), [None] * 4

            def work(i):
                got[i] = file.relight()

            workers = [threading.Thread(target=work, args=(i,)) for i in range(4)]
            for worker in workers:
                worker.start()
            for worker in workers:
                worker.join()
        for picture in got:
            np.testing.assert_array_equal(picture, want)


class Captures(Fixture):
    def test_arrays_of_every_kind(self):
        codes = np.arange(2 * 3 * 4 * 3, dtype=np.uint8).reshape(2, 3, 4, 3)
        srgb = codes / 255.0
        linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
        directions = [(0, 0, 1), (3, 0, 4)]
        for pictures, want in (codes, linear), (codes.astype(np.uint16) * 257, linear), \
                (linear.astype(np.float64), linear), (linear.astype(">f4"), linear):
            with relume.Capture(pictures, directions) as capture:
                np.testing.assert_allclose(capture.image(1), want[1], atol=1e-6)
                np.testing.assert_allclose(capture.directions[1], (0.6, 0, 0.8))
        with relume.Capture(codes[..., 0], directions, transfer="linear") as capture:
            np.testing.assert_allclose(capture.image(0)[..., 2], srgb[0, ..., 0], atol=1e-6)
            with self.assertRaises(IndexError):
                capture.image(2)

    def test_a_view_of_an_array(self):
        wide = np.zeros((LIGHTS, HEIGHT, 2 * WIDTH, 3), np.float32)
        wide[:, :, ::2] = self.pictures
        self.assertEqual(relume.encode(wide[:, :, ::2], self.lights, basis="sh", coefficients=4,
                                       bits="half"), self.data)

    def test_mask_and_depth(self):
        mask = (self.normals[..., 2] > 0).astype(np.float32)
        with relume.Capture(self.pictures, self.lights, mask=mask, depth=2 + mask) as capture:
            np.testing.assert_array_equal(capture.mask(), mask)
            data, report = capture.encode(basis="sh", coefficients=4)
        self.assertEqual((report.basis, report.coefficients), ("sh", 4))
        with relume.open(data) as file:
            np.testing.assert_array_equal(file.mask(), mask)
            np.testing.assert_array_equal(file.depth(), 2 + mask)
        with relume.open(self.data) as file:
            self.assertIsNone(file.mask())

    def test_evaluate_and_sweep(self):
        with relume.Capture(self.pictures, self.lights) as capture:
            with relume.open(self.data) as file:
                found = file.evaluate(capture)
            rows = list(relume.sweep(capture, ["sh", "ptm"], [1, 4], leave_out=5))
        # half floats of values below 1 show as less than half a code of 8 bits
        self.assertGreater(found.psnr_db, 55)
        self.assertEqual(found.light_psnr_db.shape, (LIGHTS,))
        self.assertAlmostEqual(found.light_psnr_db.mean(), found.psnr_db, places=9)
        self.assertEqual([(r.basis, r.coefficients) for r in rows], [("sh", 1), ("sh", 4)])
        self.assertGreater(rows[1].unseen_db, rows[0].unseen_db + 10)  # four are exact, one is not
        self.assertGreater(rows[1].captured_db, 40)


class Errors(Fixture):
    def test_sentences(self):
        for work, kind, sentence in (
            (lambda: relume.open("/nothing.exr"), FileNotFoundError, "/nothing.exr: no such file"),
            (lambda: relume.open(self.data[:900]), relume.DamagedError, "memory: "),
            (lambda: relume.open(b""), relume.FormatError, "memory: "),
            (lambda: relume.encode(self.pictures, self.lights[:3]), relume.UsageError, "3 lights"),
            (lambda: relume.encode(self.pictures[:0], self.lights[:0]), relume.UsageError,
             "pictures: an array of shape (0, "),
            (lambda: relume.encode(self.pictures, self.lights, basis="ssh"), ValueError, "ssh"),
            (lambda: relume.encode(self.pictures, self.lights, bits="9"), ValueError, "bits '9'"),
            (lambda: relume.encode(self.pictures, 0 * self.lights), relume.FormatError,
             "lights.directions[0]; expected a direction"),
            (lambda: relume.encode(self.pictures, self.lights, "/nowhere/x.exr"), OSError,
             "/nowhere"),
            (lambda: relume.load_image(b"GIF89a..."), relume.UnsupportedError, "memory: "),
            (lambda: relume.image_bytes(self.pictures[0], ".xyz"), relume.UsageError, "ending"),
            (lambda: relume.open(self.data).relight("sun 1 2 3"), relume.UsageError, "sun"),
            (lambda: relume.open(self.data).weights((0, 0, 0)), relume.UsageError, "not all 0"),
        ):
            with self.assertRaises(kind) as caught:
                work()
            self.assertIn(sentence, str(caught.exception))

    def test_not_finite(self):
        pictures = self.pictures.copy()
        pictures[3, 2, 1, 0] = np.nan
        with self.assertRaisesRegex(relume.DamagedError, "light 3.*NaN"):
            relume.encode(pictures, self.lights, basis="sh", coefficients=4)

    def test_closed(self):
        file = relume.open(self.data)
        file.close()
        file.close()
        for work in file.relight, file.coefficients, file.mask, lambda: file.weights((0, 0, 1)), \
                lambda: file.info:
            with self.assertRaises(ValueError):
                work()

    def test_progress(self):
        heard = []
        with relume.Capture(self.pictures, self.lights) as capture:
            capture.encode(basis="sh", progress=lambda what, done: heard.append((what, done)))
            self.assertTrue(heard and all(0 <= done <= 1 for _, done in heard))
            with self.assertRaises(relume.Cancelled):
                capture.encode(basis="sh", progress=lambda what, done: False)

            def fails(what, done):
                raise KeyError("mine")

            with self.assertRaisesRegex(KeyError, "mine"):
                capture.encode(basis="sh", progress=fails)

    def test_warnings_are_logged(self):
        upper = self.lights.copy()
        upper[:, 2] = np.abs(upper[:, 2])
        with self.assertLogs("relume", logging.INFO):
            with relume.open(relume.encode(self.pictures, upper, basis="sh")) as file:
                file.relight((0, 0, -1))


class Pictures(Fixture):
    def test_round_trips(self):
        picture = self.pictures[0]
        np.testing.assert_array_equal(relume.load_image(relume.image_bytes(picture, ".exr")),
                                      picture)
        path = self.path / "a.png"
        relume.save_image(picture, path)
        self.assertEqual(path.read_bytes(), relume.image_bytes(picture, ".png"))
        # 8 bits of sRGB, whose slope in linear light is at most 2.3 (at white)
        np.testing.assert_allclose(relume.load_image(path), picture, atol=2.3 / 255 / 2 + 1e-6)
        grey = picture[..., 0]
        np.testing.assert_array_equal(
            relume.load_image(relume.image_bytes(grey, ".exr"), channels=1), grey)


class Exchange(Fixture):
    def test_ptm_in_memory(self):
        with relume.open(self.data) as file:
            ptm, want = file.export("ptm"), file.relight((0.3, 0.2, 0.9))
            self.assertTrue(ptm.startswith(b"PTM_1.2"))
            with self.assertRaisesRegex(relume.UsageError, "folder"):
                file.export("relight")
            with self.assertRaisesRegex(relume.UsageError, "format 'gif'"):
                file.export("gif")
        with relume.open(ptm, name="coin.ptm") as file:
            self.assertEqual(file.info.basis, "ptm")
            self.assertLess(np.abs(file.relight((0.3, 0.2, 0.9)) - want).mean(), 0.05)
        with self.assertRaisesRegex(relume.DamagedError, "coin.ptm: truncated"):
            relume.open(ptm[:-9], name="coin.ptm")


class Contexts(Fixture):
    def test_files_and_limits(self):
        with relume.open(self.data) as file:
            want, ptm = file.relight((0, 0, 1)), file.export("ptm")
        store = {"shelf/coin.exr": self.data, "shelf/coin.ptm": ptm}
        with relume.Context(files=store, threads=1) as context:
            with relume.open("shelf/coin.exr", context=context) as file:
                np.testing.assert_array_equal(file.relight((0, 0, 1)), want)
            with relume.open("shelf/coin.ptm", context=context) as file:
                self.assertEqual(file.info.basis, "ptm")
            with self.assertRaisesRegex(relume.NotFoundError, "shelf/other.exr: no such file"):
                relume.open("shelf/other.exr", context=context)
        with relume.Context(max_side=3) as context:
            with self.assertRaisesRegex(relume.LimitError, "expected 1 to 3 a side and at most 1073741824 in all"):
                relume.open(self.data, context=context)


@unittest.skipUnless(TOOL, "RELUME names no tool")
class Tool(Fixture):
    def run_tool(self, *arguments):
        return subprocess.run([TOOL, *map(str, arguments)], check=True, capture_output=True,
                              cwd=self.path).stdout

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        subprocess.run([TOOL, *"synth box -o dome --size 12 --lights 16 --samples 1 --hemisphere -q".split()],
                       check=True, cwd=cls.path)

    def test_files_of_the_tool(self):
        self.run_tool("synth", "box", "-o", "box", "--size", 24, "--lights", 9, "--samples", 1, "-q")
        self.run_tool("encode", "box", "-o", "box.exr", "--basis", "sh", "--coefficients", 4, "-q")
        self.run_tool("relight", "box.exr", "-o", "relit.exr", "--light", "dir 1 0.5 1", "-q")
        with relume.open(self.path / "box.exr") as file:
            np.testing.assert_array_equal(file.relight("dir 1 0.5 1"),
                                          relume.load_image(self.path / "relit.exr"))
            said = json.loads(self.run_tool("eval", "box.exr", "box", "--json"))
            with relume.Capture.open(self.path / "box") as capture:
                found = file.evaluate(capture)
                data, _ = capture.encode(basis="sh", coefficients=4)
        self.assertAlmostEqual(found.psnr_db, said["psnr_db"], places=4)
        self.assertAlmostEqual(found.ssim, said["ssim"], places=4)
        self.assertEqual(data, (self.path / "box.exr").read_bytes())

    def test_a_part_of_a_capture(self):
        with relume.Capture.open(self.path / "dome") as whole:
            with relume.Capture.open(self.path / "dome", crop=(2, 1, 5, 4)) as part:
                self.assertEqual((part.width, part.height), (5, 4))
                np.testing.assert_array_equal(part.image(3), whole.image(3)[1:5, 2:7])
        with self.assertRaises(relume.UsageError):
            relume.Capture.open(self.path / "dome", crop=(2, 1, 500, 4))

    def test_the_same_decisions(self):
        """The command and the module call one function: equal options, equal bytes."""
        with relume.Capture.open(self.path / "dome") as capture:
            for arguments, options in (
                    ("", {}),
                    ("--psnr 34", {"psnr_db": 34}),
                    ("--basis sh --coefficients 9 --jnd 60",
                     {"basis": "sh", "coefficients": 9, "jnd": 60}),
                    ("--bytes-per-pixel 1.5", {"bytes_per_pixel": 1.5}),
                    ("--shadows no --highlights yes", {"shadows": False, "highlights": True}),
                    ("--quality 30 --no-depth --pyramid no",
                     {"quality_db": 30, "depth": False, "pyramid": False}),
                    ("--basis pca --interpolant auto --bits half --compression zip",
                     {"basis": "pca", "interpolant": "auto", "bits": "half", "compression": "zip"}),
                    ("--basis table --psnr 30 --interpolant natural",
                     {"basis": "table", "psnr_db": 30, "interpolant": "natural"})):
                with self.subTest(arguments or "defaults"):
                    self.run_tool("encode", "dome", "-o", "tool.exr", "-q", *arguments.split())
                    theirs = (self.path / "tool.exr").read_bytes()
                    data, report = capture.encode(**options)
                    self.assertEqual(data, theirs)
                    self.assertEqual(capture.encode(self.path / "ours.exr", **options)[1], report)
                    self.assertEqual((self.path / "ours.exr").read_bytes(), theirs)
                    with relume.open(data) as file:
                        self.assertEqual(file.info.coefficients, report.coefficients)
                        self.assertEqual(file.info.domain, report.domain)

    def test_what_was_decided(self):
        with relume.Capture.open(self.path / "dome") as capture:
            _, usual = capture.encode()
            self.assertTrue(usual.shadows and not usual.highlights)
            self.assertTrue(15 < usual.unseen_db < usual.psnr_db)
            _, moves = capture.encode(shadows=False, highlights="yes", psnr_db=30)
            self.assertTrue(moves.highlights and not moves.shadows)
            self.assertIsNone(moves.bits)
            _, seen = capture.encode(jnd=60, basis="pca", coefficients=9)
            self.assertTrue(seen.reached and seen.jnd <= 60)
            for options, sentence in (
                    ({"psnr_db": 30, "jnd": 1}, "--jnd encodes several times"),
                    ({"quality_db": 30, "basis": "sh"}, "--quality chooses"),
                    ({"shadows": "maybe"}, "expected auto, yes or no"),
                    ({"interpolant": "linear"}, "interpolant 'linear'")):
                with self.assertRaisesRegex(relume.UsageError, sentence):
                    capture.encode(**options)
            with self.assertRaisesRegex(relume.UnfitError, "dome: highlights cannot move; expected"):
                capture.encode(highlights=True, shadows=True)

    def test_files_of_ours(self):
        relume.encode(self.pictures, self.lights, self.path / "ours.exr", basis="sh",
                      coefficients=4, bits="half")
        self.assertEqual((self.path / "ours.exr").read_bytes(), self.data)
        said = json.loads(self.run_tool("info", "ours.exr", "--json"))
        self.assertEqual(said["coefficients"], 4)


if __name__ == "__main__":
    unittest.main()
