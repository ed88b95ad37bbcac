# coin.awk - a glossy coin on cloth under n lamps (-v n=49), as PPM and dirs.lp in the folder -v dir=DIR, which is there;
# -v turn=T turns the lamps by T of the step between them, -v s=160 is the size. Its gloss is Blinn's, with no shadows.
function put(v) { v = v < 0 ? 0 : v > 1 ? 1 : v; return int(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ^ (1 / 2.4) - 0.055) + 0.5) }
function height(x, y,    r) {
    r = sqrt(x * x + y * y)
    return 0.05 * exp(-((r - 0.82) / 0.06) ^ 2) + 0.2 * cos(5 * atan2(y, x)) * r * r * exp(-(r / 0.5) ^ 4) + 0.05 * exp(-(r / 0.12) ^ 2)
}
BEGIN {
    if (!n) n = 49
    if (!s) s = 160
    step = 0.001
    for (k = 0; k < s * s; k++) {
        x = (k % s + 0.5) / s * 2 - 1; y = 1 - (int(k / s) + 0.5) / s * 2
        coin[k] = x * x + y * y < 0.9
        dx = (height(x + step, y) - height(x - step, y)) / (2 * step); dy = (height(x, y + step) - height(x, y - step)) / (2 * step)
        z = 1 / sqrt(1 + dx * dx + dy * dy)
        u[k] = coin[k] ? -dx * z : 0; v[k] = coin[k] ? -dy * z : 0; w[k] = coin[k] ? z : 1
    }
    print n >(dir "/dirs.lp")
    for (i = 0; i < n; i++) {
        z = 1 - 0.8 * (i + 0.5) / n; a = 2.399963 * (i + turn); r = sqrt(1 - z * z)
        x = r * cos(a); y = r * sin(a); half = sqrt(2 + 2 * z)
        name = sprintf("coin%02d.ppm", i)
        print name, x, y, z >(dir "/dirs.lp")
        name = dir "/" name
        printf "P3 %d %d 255\n", s, s >name
        for (k = 0; k < s * s; k++) {
            c = u[k] * x + v[k] * y + w[k] * z; c = c < 0 ? 0 : c
            shine = coin[k] && c > 0 ? c * ((c + w[k]) / half) ^ 400 : 0
            if (coin[k]) print put(0.25 * c + 0.9 * shine), put(0.16 * c + 0.7 * shine), put(0.06 * c + 0.35 * shine) >name
            else print put(0.05 * c), put(0.07 * c), put(0.12 * c) >name
        }
        close(name)
    }
}
