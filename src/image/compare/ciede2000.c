// ciede2000.c - perceived colour difference (Sharma, Wu, Dalal 2005, kL = kC = kH = 1)
#include "image/compare/ciede2000.h"

#include "image/image/power.h"

#include <pthread.h>

static double degrees(double radians)
{
    return radians * (180.0 / M_PI);
}

static double cosine(double deg)
{
    return cos(deg * (M_PI / 180.0));
}

static double hue(double a, double b)
{
    const double h = a == 0.0 && b == 0.0 ? 0.0 : degrees(atan2(b, a));
    return h < 0.0 ? h + 360.0 : h;
}

static double mean_hue(double h1, double h2, double chroma_product)
{
    if (chroma_product == 0.0)
        return h1 + h2;
    if (fabs(h1 - h2) <= 180.0)
        return 0.5 * (h1 + h2);
    return h1 + h2 < 360.0 ? 0.5 * (h1 + h2 + 360.0) : 0.5 * (h1 + h2 - 360.0);
}

static double power7(double v)
{
    const double v3 = v * v * v;
    return v3 * v3 * v;
}

// Names and equation numbers as in the paper.
double ciede2000(const double lab1[3], const double lab2[3])
{
    const double c_mean = 0.5 * (hypot(lab1[1], lab1[2]) + hypot(lab2[1], lab2[2]));
    const double c7 = power7(c_mean), seven = power7(25.0);
    const double g = 0.5 * (1.0 - sqrt(c7 / (c7 + seven)));           // (4)
    const double a1 = (1.0 + g) * lab1[1], a2 = (1.0 + g) * lab2[1];  // (5)
    const double c1 = hypot(a1, lab1[2]), c2 = hypot(a2, lab2[2]);    // (6)
    const double h1 = hue(a1, lab1[2]), h2 = hue(a2, lab2[2]);        // (7)
    double dh = c1 * c2 == 0.0 ? 0.0 : h2 - h1;                       // (10)
    dh += dh > 180.0 ? -360.0 : dh < -180.0 ? 360.0 : 0.0;
    const double dl = lab2[0] - lab1[0], dc = c2 - c1;                      // (8), (9)
    const double dhh = 2.0 * sqrt(c1 * c2) * sin(0.5 * dh * M_PI / 180.0);  // (11)
    const double l = 0.5 * (lab1[0] + lab2[0]), c = 0.5 * (c1 + c2);        // (12), (13)
    const double h = mean_hue(h1, h2, c1 * c2);                             // (14)
    const double t = 1.0 - 0.17 * cosine(h - 30.0) + 0.24 * cosine(2.0 * h) +
                     0.32 * cosine(3.0 * h + 6.0) - 0.20 * cosine(4.0 * h - 63.0);  // (15)
    const double turn = (h - 275.0) / 25.0;
    const double theta = 30.0 * exp(-turn * turn);                  // (16)
    const double rc = 2.0 * sqrt(power7(c) / (power7(c) + seven));  // (17)
    const double l50 = (l - 50.0) * (l - 50.0);
    const double sl = 1.0 + 0.015 * l50 / sqrt(20.0 + l50);       // (18)
    const double sc = 1.0 + 0.045 * c, sh = 1.0 + 0.015 * c * t;  // (19), (20)
    const double rt = -sin(2.0 * theta * M_PI / 180.0) * rc;      // (21)
    const double x = dl / sl, y = dc / sc, z = dhh / sh;
    return sqrt(x * x + y * y + z * z + rt * y * z);  // (22)
}

// ---------------------------------------------------------------- for many pixels

enum { TURN_STEPS = 1024 };

struct ciede_tables {
    struct power cube_root;
    float turn[4 * TURN_STEPS + 2];  // sin(2 theta) of (16), (21) over the quadrants of the hue
};

static double turn_at(double quadrant)
{
    const double q = fmod(quadrant, 1.0),
                 angle = floor(quadrant) * 90.0 + degrees(atan2(q, 1.0 - q));
    const double turn = (angle - 275.0) / 25.0;
    return sin(60.0 * exp(-turn * turn) * M_PI / 180.0);
}

static struct ciede_tables shared;

static void make_tables(void)
{
    power_init(&shared.cube_root, 1.0 / 3.0);
    for (int i = 0; i < 4 * TURN_STEPS + 2; i++)
        shared.turn[i] = (float)turn_at(i / (double)TURN_STEPS);
}

const struct ciede_tables *ciede_tables(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_tables);
    return &shared;
}

static inline double lab_curve(const struct ciede_tables *tables, double t)
{
    return t > 216.0 / 24389.0 ? power_of(&tables->cube_root, t)
                               : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

void lab_from_linear(const struct ciede_tables *tables, struct lab_block *lab, const float *rgb,
                     int n)
{
    static const double xyz[3][3] = {
        {0.4124564 / 0.95047, 0.3575761 / 0.95047, 0.1804375 / 0.95047},
        {0.2126729, 0.7151522, 0.0721750},
        {0.0193339 / 1.08883, 0.1191920 / 1.08883, 0.9503041 / 1.08883}};
    for (int p = 0; p < n; p++) {
        const double r = (double)rgb[3 * p], g = (double)rgb[3 * p + 1], b = (double)rgb[3 * p + 2];
        double f[3];
        for (int i = 0; i < 3; i++)
            f[i] = lab_curve(tables, xyz[i][0] * r + xyz[i][1] * g + xyz[i][2] * b);
        lab->l[p] = 116.0 * f[1] - 16.0;
        lab->a[p] = 500.0 * (f[0] - f[1]);
        lab->b[p] = 200.0 * (f[1] - f[2]);
    }
}

// (15) by multiple angles of the mean hue.
static inline float hue_term(float c, float s)
{
    const float c2 = 2.0f * c * c - 1.0f, s2 = 2.0f * s * c;
    const float c3 = c * (2.0f * c2 - 1.0f), s3 = s * (2.0f * c2 + 1.0f);
    const float c4 = 2.0f * c2 * c2 - 1.0f, s4 = 2.0f * s2 * c2;
    return 1.0f - 0.17f * (0.8660254f * c + 0.5f * s) + 0.24f * c2 +
           0.32f * (0.9945219f * c3 - 0.1045285f * s3) -
           0.20f * (0.4539905f * c4 + 0.8910065f * s4);
}

// sqrt(c^7 / (c^7 + 25^7))
static inline float saturation(float c)
{
    const float c3 = c * c * c, c7 = c3 * c3 * c;
    return sqrtf(c7 / (c7 + 6103515625.0f));
}

// The four quadrants as 0..4, growing with the angle, without an arc tangent.
static inline float quadrant_of(float cosine_h, float sine_h)
{
    const float q = sine_h / (fabsf(cosine_h) + fabsf(sine_h) + 1e-30f);
    return cosine_h < 0.0f ? 2.0f - q : sine_h < 0.0f ? 4.0f + q : q;
}

struct half_done {  // from the first step to the second
    float square[CIEDE_BLOCK], turned[CIEDE_BLOCK], quadrant[CIEDE_BLOCK];
    float unlike[CIEDE_BLOCK];  // 0 where hues are opposite
};

// What subtracts is subtracted in double precision before anything is rounded to single. The mean
// hue is the direction half way between both (a', b'), and (11) is the chord of their angle: cross
// and dot product say both.
static void first_step(const struct lab_block *one, const struct lab_block *two,
                       struct half_done *out)
{
    const float tiny = 1e-30f;
    for (int i = 0; i < CIEDE_BLOCK; i++) {
        const double p1 = one->a[i], q1 = one->b[i], p2 = two->a[i], q2 = two->b[i];
        const float dl = (float)(two->l[i] - one->l[i]);
        const float l = (float)(0.5 * (one->l[i] + two->l[i]) - 50.0);
        const float aa1 = (float)(p1 * p1), bb1 = (float)(q1 * q1);
        const float aa2 = (float)(p2 * p2), bb2 = (float)(q2 * q2);
        const float aa = (float)(p1 * p2), bb = (float)(q1 * q2);
        const float daa = (float)(p2 * p2 - p1 * p1), dbb = (float)(q2 * q2 - q1 * q1);
        const float area = (float)(p1 * q2 - q1 * p2);

        const float g = 1.5f - 0.5f * saturation(0.5f * (sqrtf(aa1 + bb1) + sqrtf(aa2 + bb2)));
        const float c1 = sqrtf(g * g * aa1 + bb1), c2 = sqrtf(g * g * aa2 + bb2);
        const float both = c1 * c2, dot = g * g * aa + bb, cross = g * area;
        // both (1 + cos of the angle), without cancelling for wide ones
        const float wide = cross * cross / (both - dot + tiny);
        const float toward = dot < 0.0f ? wide : both + dot;
        const float inverse = 1.0f / sqrtf(2.0f * both * toward + tiny);
        const float cosine_h = g * ((float)p1 * c2 + (float)p2 * c1) * inverse;
        const float sine_h = ((float)q1 * c2 + (float)q2 * c1) * inverse;
        const float dc = (g * g * daa + dbb) / (c1 + c2 + tiny);
        const float dh = 2.0f * cross * sqrtf(both) * inverse;
        const float c = 0.5f * (c1 + c2);

        const float x = dl / (1.0f + 0.015f * l * l / sqrtf(20.0f + l * l));
        const float y = dc / (1.0f + 0.045f * c);
        const float z = dh / (1.0f + 0.015f * c * hue_term(cosine_h, sine_h));
        out->square[i] = x * x + y * y + z * z;
        out->turned[i] = 2.0f * saturation(c) * y * z;
        out->quadrant[i] = quadrant_of(cosine_h, sine_h);
        out->unlike[i] = toward - 1e-3f * both;
    }
}

static inline float turn_of(const struct ciede_tables *tables, float quadrant)
{
    const float x = quadrant * TURN_STEPS;
    const int i = (int)x;
    return tables->turn[i] + (x - (float)i) * (tables->turn[i + 1] - tables->turn[i]);
}

// Opposite hues have no mean: the paper's rule decides.
static float by_the_paper(const struct lab_block *one, const struct lab_block *two, int i)
{
    const double lab1[3] = {one->l[i], one->a[i], one->b[i]};
    const double lab2[3] = {two->l[i], two->a[i], two->b[i]};
    return (float)ciede2000(lab1, lab2);
}

void ciede2000_block(const struct ciede_tables *tables, const struct lab_block *lab1,
                     const struct lab_block *lab2, float *delta_e)
{
    struct half_done p;
    first_step(lab1, lab2, &p);
    for (int i = 0; i < CIEDE_BLOCK; i++)
        delta_e[i] = sqrtf(fmaxf(p.square[i] - p.turned[i] * turn_of(tables, p.quadrant[i]), 0.0f));
    for (int i = 0; i < CIEDE_BLOCK; i++)
        if (p.unlike[i] < 0.0f)
            delta_e[i] = by_the_paper(lab1, lab2, i);
}
