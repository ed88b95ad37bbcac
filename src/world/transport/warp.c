// warp.c - small pictures warped by the material (Ritschel, Engelhardt, Grosch, Seidel, Kautz,
// Dachsbacher 2009, "Micro-rendering for scalable, parallel final gathering", section 4.3)
//
// The paper inverts the marginal of the reflectance over the disc of directions, and its
// conditional, from tables of each material. Here the surface is asked itself, since each place may
// have another: on a coarse grid, and about the peak on a finer one. Columns hold equal shares of
// what that adds up to, and so do the rows of each; a part is spread evenly over the disc, so that
// all of it has its pixels. What is drawn counts by the reflectance at its place (the warp's own
// density), not by the part of the pixel that it covers.
#include "world/transport/warp.h"

#include "core/math/bilinear.h"

#include <math.h>
#include <string.h>

enum { COARSE = 7, AROUND = 3, FINE = 4, LINES = WARP_LINES };
_Static_assert(COARSE - AROUND + AROUND * FINE == LINES && COARSE * FINE == WARP_BINS, "lines");
static const float EVEN = 0.05f;  // of the pixels

// ---------------------------------------------------------------- the surface

// Over (u, t), where v = t sqrt(1 - u^2).
struct table {
    float *u, *t;                // [LINES + 1]
    float strip[LINES];          // areas of columns, per t
    float rgb[LINES][LINES][3];  // [column][row]: means
    float weight[LINES][LINES];  // how much of the pixels they are worth
    bool fine_column[LINES], fine_row[LINES];
};

static float height(float u)
{
    return sqrtf(fmaxf(1.0f - u * u, 0.0f));
}

// The area of a disc left of u, on one side.
static float left_of(float u)
{
    return 0.5f * (u * height(u) + asinf(u));
}

static vec3 towards(const struct cut_place *place, float u, float t)
{
    const float v = t * height(u);
    const struct cut_pixel pixel = {.direction = {u, v, sqrtf(fmaxf(1.0f - u * u - v * v, 0.0f))}};
    return cut_direction(place, &pixel);
}

static float ask(float rgb[3], const struct cut_place *place, float u, float t, warp_answer *answer,
                 const void *context)
{
    answer(rgb, context, towards(place, u, t));
    for (int c = 0; c < 3; c++)
        rgb[c] = isfinite(rgb[c]) ? fmaxf(rgb[c], 0.0f) : 0.0f;
    return rgb[0] + rgb[1] + rgb[2];
}

static float middle_of(int i)
{
    return (2.0f * (float)i + 1.0f) / COARSE - 1.0f;
}

static int block_of(float x)
{
    const int i = (int)((x + 1.0f) * (0.5f * COARSE)) - AROUND / 2;
    return i < 0 ? 0 : i > COARSE - AROUND ? COARSE - AROUND : i;
}

// Coarse lines, and fine ones from coarse cell `first` on.
static void put_lines(float line[LINES + 1], unsigned char piece[WARP_BINS], int coarse[LINES],
                      bool fine[LINES], int first)
{
    int n = 0;
    for (int bin = 0; bin < WARP_BINS; bin++) {
        const int i = bin / FINE;
        const bool is = i >= first && i < first + AROUND;
        if (is || bin % FINE == 0) {
            coarse[n] = i;
            fine[n] = is;
            line[n++] = (float)bin * (2.0f / WARP_BINS) - 1.0f;
        }
        piece[bin] = (unsigned char)(n - 1);
    }
    line[n] = 1.0f;
}

static void ask_all(struct table *out, struct warp *warp, const struct cut_place *place,
                    vec3 mirrored, warp_answer *answer, const void *context)
{
    float coarse[COARSE][COARSE][3], unused[3];
    int of_column[LINES], of_row[LINES], peak[2];
    const float up = (float)vec3_dot(mirrored, vec3_floats(place->frame[1]));
    float most = ask(unused, place, 0.0f, up, answer, context);
    peak[0] = block_of(0.0f), peak[1] = block_of(up);
    for (int i = 0; i < COARSE; i++)
        for (int j = 0; j < COARSE; j++) {
            const float u = middle_of(i), t = middle_of(j);
            const float found = ask(coarse[i][j], place, u, t, answer, context);
            if (found > most)
                most = found, peak[0] = block_of(u), peak[1] = block_of(t);
        }
    out->u = warp->line[0], out->t = warp->line[1];
    put_lines(out->u, warp->piece[0], of_column, out->fine_column, peak[0]);
    put_lines(out->t, warp->piece[1], of_row, out->fine_row, peak[1]);
    for (int k = 0; k < LINES; k++) {
        out->strip[k] = left_of(out->u[k + 1]) - left_of(out->u[k]);
        for (int l = 0; l < LINES; l++)
            if (out->fine_column[k] && out->fine_row[l])
                ask(out->rgb[k][l], place, 0.5f * (out->u[k] + out->u[k + 1]),
                    0.5f * (out->t[l] + out->t[l + 1]), answer, context);
            else
                memcpy(out->rgb[k][l], coarse[of_column[k]][of_row[l]], sizeof unused);
    }
}

// False: it returns nothing.
static bool weigh(struct table *table)
{
    float all = 0.0f;
    for (int k = 0; k < LINES; k++)
        for (int l = 0; l < LINES; l++) {
            const float *rgb = table->rgb[k][l];
            table->weight[k][l] =
                table->strip[k] * (table->t[l + 1] - table->t[l]) * (rgb[0] + rgb[1] + rgb[2]);
            all += table->weight[k][l];
        }
    if (!(all > 0.0f && all < INFINITY))
        return false;
    for (int k = 0; k < LINES; k++)
        for (int l = 0; l < LINES; l++) {
            const float part = table->strip[k] * (table->t[l + 1] - table->t[l]) / (float)M_PI;
            table->weight[k][l] = (1.0f - EVEN) * table->weight[k][l] / all + EVEN * part;
        }
    return true;
}

// ---------------------------------------------------------------- pixels

// Where `n` equal parts of the weights between lines end.
static void split(float *edge, int n, const float *line, const float *weight)
{
    float all = 0.0f, before = 0.0f;
    int k = 0;
    for (int i = 0; i < LINES; i++)
        all += weight[i];
    edge[0] = line[0];
    for (int i = 1; i < n; i++) {
        const float wanted = all * (float)i / (float)n;
        while (k < LINES - 1 && before + weight[k] < wanted)
            before += weight[k++];
        const float part = fminf((wanted - before) / weight[k], 1.0f);
        edge[i] = line[k] + part * (line[k + 1] - line[k]);
    }
    edge[n] = line[LINES];
}

// The part of what lies between two lines that lies between two edges.
static float overlap(const float *line, float begin, float end)
{
    const float from = fmaxf(line[0], begin), to = fminf(line[1], end);
    return to > from ? (to - from) / (line[1] - line[0]) : 0.0f;
}

static void put_axis(struct warp_axis *out, int n, const float *line, const float *weight)
{
    float all = 0.0f, before = 0.0f;
    for (int i = 0; i < LINES; i++)
        all += weight[i];
    for (int i = 0; i < LINES; i++) {
        out->before[i] = before;
        out->per[i] = (float)n * weight[i] / all / (line[i + 1] - line[i]);
        before += (float)n * weight[i] / all;
    }
}

// What the rows of a column are worth and return.
struct strip {
    float weight[LINES], rgb[LINES][3];
};

static void gather_strip(struct strip *out, const struct table *table, const float *edge)
{
    *out = (struct strip){.weight = {0.0f}};
    for (int k = 0; k < LINES; k++) {
        const float part = overlap(&table->u[k], edge[0], edge[2]);
        for (int l = 0; l < LINES && part > 0.0f; l++) {
            const float area = part * table->strip[k] * (table->t[l + 1] - table->t[l]);
            out->weight[l] += part * table->weight[k][l];
            for (int c = 0; c < 3; c++)
                out->rgb[l][c] += area * table->rgb[k][l][c] / (float)M_PI;
        }
    }
}

// Of edges, every other one is the middle of a pixel.
static void put_pixel(struct warp *out, int i, const struct table *table, const struct strip *strip,
                      const float *columns, const float *rows)
{
    const float u = columns[1], v = rows[1] * height(u);
    out->view.pixel[i] = (struct cut_pixel){
        .direction = {u, v, sqrtf(fmaxf(1.0f - u * u - v * v, 0.0f))},
        .inside = 1.0f,
        .share = (left_of(columns[2]) - left_of(columns[0])) * (rows[2] - rows[0]) / (float)M_PI};
    memset(out->answer[i], 0, sizeof out->answer[i]);
    for (int l = 0; l < LINES; l++) {
        const float part = overlap(&table->t[l], rows[0], rows[2]);
        for (int c = 0; c < 3; c++)
            out->answer[i][c] += part * strip->rgb[l][c];
    }
}

static void turn(struct cut_place *place, vec3 upwards)
{
    const vec3 normal = vec3_floats(place->frame[2]);
    const vec3 across = vec3_cross(upwards, normal);
    const double LEAST = 1e-6;
    if (!(vec3_length(across) > LEAST))
        return;
    const vec3 x = vec3_unit(across);
    vec3_store(place->frame[0], x);
    vec3_store(place->frame[1], vec3_cross(normal, x));
}

bool warp_create(struct warp *out, struct cut_place *place, int side, vec3 mirrored,
                 warp_answer *answer, const void *context)
{
    struct table table;
    struct strip strip;
    struct cut_place turned = *place;
    float weight[LINES], columns[2 * CUT_MOST + 1], rows[2 * CUT_MOST + 1];
    turn(&turned, mirrored);
    ask_all(&table, out, &turned, mirrored, answer, context);
    if (!weigh(&table))
        return false;
    for (int k = 0; k < LINES; k++) {
        weight[k] = 0.0f;
        for (int l = 0; l < LINES; l++)
            weight[k] += table.weight[k][l];
    }
    out->view.side = side;
    split(columns, 2 * side, table.u, weight);
    put_axis(&out->column, side, table.u, weight);
    for (int i = 0; i < side; i++) {
        gather_strip(&strip, &table, &columns[2 * i]);
        split(rows, 2 * side, table.t, strip.weight);
        put_axis(&out->row[i], side, table.t, strip.weight);
        out->middle[i] = columns[2 * i + 1];
        for (int j = 0; j < side; j++)
            put_pixel(out, j * side + i, &table, &strip, &columns[2 * i], &rows[2 * j]);
    }
    *place = turned;
    place->view = &out->view;
    place->warp = out;
    return true;
}

// ---------------------------------------------------------------- places

static const float LEAST = 1e-3f;  // height of the disc

static int piece_at(const struct warp *w, int axis, float x)
{
    return w->piece[axis][index_clamped((int)((x + 1.0f) * (0.5f * WARP_BINS)), WARP_BINS)];
}

static float along(const struct warp_axis *axis, const float *line, int piece, float x)
{
    return axis->before[piece] + axis->per[piece] * (x - line[piece]);
}

static float within(float v, float high)
{
    return v >= high ? 1.0f : v <= -high ? -1.0f : v / high;
}

void warp_parts(struct warp_parts *out, const struct warp *w, float u, float v)
{
    const int side = w->view.side;
    const float high = fmaxf(height(u), LEAST), t = within(v, high);
    const int k = piece_at(w, 0, u), l = piece_at(w, 1, t);
    const float x = along(&w->column, w->line[0], k, u) + 0.5f;
    const int column = (int)x;
    const float right = x - (float)column, area = w->column.per[k] / high;
    for (int n = 0; n < 2; n++) {
        const int i = index_clamped(column - 1 + n, side);
        const struct warp_axis *rows = &w->row[i];
        const float y = along(rows, w->line[1], l, t) + 0.5f;
        const int row = (int)y;
        const float down = y - (float)row, part = (n ? right : 1.0f - right) * area * rows->per[l];
        out->pixel[2 * n] = index_clamped(row - 1, side) * side + i;
        out->pixel[2 * n + 1] = index_clamped(row, side) * side + i;
        out->weight[2 * n] = part * (1.0f - down);
        out->weight[2 * n + 1] = part * down;
    }
}

static int column_at(const struct warp *w, float u)
{
    return index_clamped((int)along(&w->column, w->line[0], piece_at(w, 0, u), u), w->view.side);
}

static int row_at(const struct warp *w, int column, float t)
{
    return index_clamped((int)along(&w->row[column], w->line[1], piece_at(w, 1, t), t),
                         w->view.side);
}

float warp_area(const struct warp *w, float u, float v)
{
    const float high = fmaxf(height(u), LEAST), t = within(v, high);
    const float wide = 1.0f / w->column.per[piece_at(w, 0, u)];
    const float tall = high / w->row[column_at(w, u)].per[piece_at(w, 1, t)];
    return wide * tall;
}

void warp_columns(int out[2], const struct warp *w, float u, float reach)
{
    out[0] = column_at(w, fmaxf(u - reach, -1.0f));
    out[1] = column_at(w, fminf(u + reach, 1.0f));
}

void warp_rows(int out[2], const struct warp *w, int column, float v, float reach)
{
    const float high = fmaxf(height(w->middle[column]), LEAST);
    out[0] = row_at(w, column, within(v - reach, high));
    out[1] = row_at(w, column, within(v + reach, high));
}
