// psf_lanes.h - the chromatic sum for any set of WIDTH lanes; included by its file, which looks up
// WIDTH places in registers (`lanes_look_up`)
static void mix(float *out, const float *a, const float *b, float t, int n)
{
    const lanes weight = lanes_all(t);
    int i = 0;
    for (; i + WIDTH <= n; i += WIDTH) {
        const lanes x = lanes_load(a + i), y = lanes_load(b + i);
        lanes_store(out + i, lanes_madd(weight, y - x, x));
    }
    for (; i < n; i++)
        out[i] = fmaf(t, b[i] - a[i], a[i]);
}

static inline lanes look_up_line(const float *line, float at, float scale, int i)
{
    const float first = fmaf(scale, (float)i, at);
    const int base = (int)first;
    return lanes_look_up(line + base, first - (float)base, scale);
}

static inline float look_up_one(const float *line, float at, float scale, int i)
{
    const float x = fmaf(scale, (float)i, at);
    const int j = (int)x;
    return fmaf(x - (float)j, line[j + 1] - line[j], line[j]);
}

static inline void add(float *out, lanes weight, lanes value)
{
    lanes_store(out, lanes_madd(weight, value, lanes_load(out)));
}

static void spread(float *const out[3], int n, const float *line, float at, float scale,
                   const float rgb[3])
{
    const lanes r = lanes_all(rgb[0]), g = lanes_all(rgb[1]), b = lanes_all(rgb[2]);
    int i = 0;
    for (; i + WIDTH <= n; i += WIDTH) {
        const lanes v = look_up_line(line, at, scale, i);
        add(out[0] + i, r, v);
        add(out[1] + i, g, v);
        add(out[2] + i, b, v);
    }
    for (; i < n; i++)
        for (int c = 0; c < 3; c++)
            out[c][i] = fmaf(rgb[c], look_up_one(line, at, scale, i), out[c][i]);
}

static void spread_one(float *out, int n, const float *line, float at, float scale, float weight)
{
    const lanes w = lanes_all(weight);
    int i = 0;
    for (; i + WIDTH <= n; i += WIDTH)
        add(out + i, w, look_up_line(line, at, scale, i));
    for (; i < n; i++)
        out[i] = fmaf(weight, look_up_one(line, at, scale, i), out[i]);
}
