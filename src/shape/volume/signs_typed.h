// signs_typed.h - what is done sample by sample, once for each type: SAMPLE, and OF(name) a name

// Bit i of a word: whether sample i is at least `limit`. The last is repeated up to 64.
static uint64_t OF(signs)(const SAMPLE *sample, int count, SAMPLE limit)
{
    uint8_t flag[64];
    uint64_t word = 0, eight;
    if (count >= 64)
        for (int i = 0; i < 64; i++)
            flag[i] = sample[i] >= limit;
    else
        for (int i = 0; i < 64; i++)
            flag[i] = sample[i < count ? i : count - 1] >= limit;
    // the product brings the low bits of eight bytes together in the highest byte
    for (int i = 0; i < 8; i++) {
        memcpy(&eight, flag + 8 * i, sizeof eight);
        word |= eight * 0x0102040810204080u >> 56 << 8 * i;
    }
    return word;
}

// The same of a brick's 16 samples, or of what is left of a row.
static uint64_t OF(signs_of_brick)(const SAMPLE *sample, int count, SAMPLE limit)
{
    uint8_t flag[BRICK_X];
    uint64_t low, high;
    for (int i = 0; i < BRICK_X; i++)
        flag[i] = sample[i < count ? i : count - 1] >= limit;
    memcpy(&low, flag, sizeof low);
    memcpy(&high, flag + 8, sizeof high);
    return low * 0x0102040810204080u >> 56 | high * 0x0102040810204080u >> 56 << 8;
}

// Of a row of bricks, `range` their least and largest: samples count where a surface may be.
static void OF(sign_bricks)(uint64_t *out, const relume_volume *v, size_t row, double limit,
                            const float (*range)[2])
{
    const int width = v->size[0];
    const SAMPLE *sample = (const SAMPLE *)v->data + row * (size_t)width, at = (SAMPLE)limit;
    uint64_t bits = 0;
    for (int x = 0; x < width; x += BRICK_X, range++) {
        bits = (double)(*range)[0] >= limit  ? 0xffff
               : (double)(*range)[1] < limit ? 0
                                             : OF(signs_of_brick)(sample + x, width - x, at);
        if (!(x & 63))
            out[x >> 6] = 0;
        out[x >> 6] |= bits << (x & 63);
    }
    // the last sample is repeated up to the end of its word
    for (int x = (width + BRICK_X - 1) / BRICK_X * BRICK_X; x & 63; x += BRICK_X)
        out[x >> 6] |= (bits >> 15 ? (uint64_t)0xffff : 0) << (x & 63);
}

static void OF(sign_row)(uint64_t *out, const relume_volume *v, size_t row, double limit)
{
    const int width = v->size[0];
    const SAMPLE *sample = (const SAMPLE *)v->data + row * (size_t)width;
    for (int x = 0; x < width; x += 64)
        out[x >> 6] = OF(signs)(sample + x, width - x, (SAMPLE)limit);
}

static void OF(gradient)(float out[3], const SAMPLE *at, const int p[3], const int size[3],
                         const ptrdiff_t step[3])
{
    for (int c = 0; c < 3; c++) {
        const bool below = p[c] > 0, above = p[c] + 1 < size[c];
        const float rise = (float)at[above ? step[c] : 0] - (float)at[below ? -step[c] : 0];
        out[c] = below && above ? 0.5f * rise : rise;
    }
}

// Central differences at both ends, where all samples that they need are there.
static void OF(gradients)(float a[3], float b[3], const SAMPLE *at, int axis,
                          const ptrdiff_t step[3])
{
    const SAMPLE *next = at + step[axis];
    for (int c = 0; c < 3; c++) {
        const ptrdiff_t s = step[c];
        a[c] = 0.5f * ((float)at[s] - (float)at[-s]);
        b[c] = 0.5f * ((float)next[s] - (float)next[-s]);
    }
}

static inline struct place OF(place)(const struct signs *g, int axis, int x, int y, int z)
{
    const relume_volume *v = g->volume;
    const ptrdiff_t step[3] = {1, v->size[0], (ptrdiff_t)v->size[0] * v->size[1]};
    const SAMPLE *at = (const SAMPLE *)v->data + volume_at(v, x, y, z);
    const float low = (float)at[0], high = (float)at[step[axis]];
    const float exact = (g->threshold - low) / (high - low);
    const float above = exact > LEAST_STEP ? exact : LEAST_STEP;
    const float t = above < 1.0f - LEAST_STEP ? above : 1.0f - LEAST_STEP;
    struct place out = {{(float)x, (float)y, (float)z}, {0, 0, 0}};
    int p[3] = {x, y, z};
    float a[3], b[3];
    if (x > 0 && y > 0 && z > 0 && x + 1 + (axis == 0) < g->size[0] &&
        y + 1 + (axis == 1) < g->size[1] && z + 1 + (axis == 2) < g->size[2]) {
        OF(gradients)(a, b, at, axis, step);
    } else {
        OF(gradient)(a, at, p, g->size, step);
        p[axis]++;
        OF(gradient)(b, at + step[axis], p, g->size, step);
    }
    out.position[axis] += t;
    float square = 0.0f;
    for (int c = 0; c < 3; c++) {
        out.normal[c] = -(a[c] + t * (b[c] - a[c]));
        square += out.normal[c] * out.normal[c];
    }
    if (square > 0.0f && square < FLT_MAX) {
        const float scale = 1.0f / sqrtf(square);
        for (int c = 0; c < 3; c++)
            out.normal[c] *= scale;
    } else {
        memset(out.normal, 0, sizeof out.normal);
        out.normal[axis] = high > low ? -1.0f : 1.0f;
    }
    return out;
}

static struct place OF(place_of)(const struct signs *g, int axis, int x, int y, int z)
{
    return OF(place)(g, axis, x, y, z);
}

// The vertices of a word of edges, from x on.
static size_t OF(put_word)(const struct signs *g, int axis, int x, int y, int z, uint64_t word,
                           float (*position)[3], float (*normal)[3])
{
    size_t n = 0;
    for (; word; word &= word - 1, n++) {
        const struct place p = OF(place)(g, axis, x + __builtin_ctzll(word), y, z);
        memcpy(position[n], p.position, sizeof p.position);
        memcpy(normal[n], p.normal, sizeof p.normal);
    }
    return n;
}

#undef SAMPLE
#undef OF
