"""Rate and distortion of three bases on one capture: a table and, where matplotlib is, a plot.

    python rate_distortion.py CAPTURE OUT      # a folder or .lp file; writes OUT.csv and OUT.png
"""

import csv
import sys

import relume

capture = relume.Capture.open(sys.argv[1])
rows = list(relume.sweep(capture, ["ptm", "sh", "pca"], [1, 3, 4, 6, 9, 12, 16], leave_out=4))

with open(sys.argv[2] + ".csv", "w", newline="") as file:
    table = csv.writer(file)
    table.writerow(["basis", "coefficients", "bytes", "bits_per_pixel", "captured_db", "unseen_db"])
    for r in rows:
        table.writerow([r.basis, r.coefficients, r.file_bytes, r.bits_per_pixel, r.captured_db,
                        r.unseen_db])

try:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    sys.exit("matplotlib is not installed: no plot, only " + sys.argv[2] + ".csv")
for basis in dict.fromkeys(r.basis for r in rows):
    mine = [r for r in rows if r.basis == basis]
    line, = plt.plot([r.bits_per_pixel for r in mine], [r.unseen_db for r in mine], "o-", label=basis)
    plt.plot([r.bits_per_pixel for r in mine], [r.captured_db for r in mine], ":", c=line.get_color())
plt.xscale("log", base=2)
plt.gca().xaxis.set_major_formatter("{x:g}")
plt.xlabel("bits per pixel of the file")
plt.ylabel("PSNR, dB (solid: lights left out; dotted: captured lights)")
plt.legend()
plt.grid(alpha=0.3, which="both")
plt.savefig(sys.argv[2] + ".png", dpi=110, bbox_inches="tight")
