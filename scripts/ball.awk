# ball.awk - a ball of radius 1 as OBJ: n rings (-v n=64) of 2 n quadrilaterals
BEGIN {
    if (!n) n = 64
    pi = atan2(0, -1)
    for (j = 0; j <= n; j++)
        for (i = 0; i <= 2 * n; i++) {
            t = pi * j / n; p = pi * i / n
            x = sin(t) * sin(p); y = cos(t); z = sin(t) * cos(p)
            printf "v %.7f %.7f %.7f\nvt %.5f %.5f\nvn %.7f %.7f %.7f\n", x, y, z, i / (2 * n), 1 - j / n, x, y, z
        }
    for (j = 0; j < n; j++)
        for (i = 0; i < 2 * n; i++) {
            a = j * (2 * n + 1) + i + 1; b = a + 2 * n + 1
            if (j < n - 1) printf "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, b + 1, b + 1, b + 1
            if (j > 0) printf "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b + 1, b + 1, b + 1, a + 1, a + 1, a + 1
        }
}
