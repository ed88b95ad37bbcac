// plot.c - diagrams by Cairo: SVG for a page, PNG at twice the size for a screen
#include "plot.h"

#include <cairo-svg.h>
#include <cairo.h>
#include <math.h>
#include <relume/context.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double WIDTH = 900.0, HEIGHT = 560.0;
static const double LEFT = 72.0, TOP = 64.0, BOTTOM = 58.0, LEGEND = 190.0;
static const double TEXT = 12.0, SMALL = 10.0, RADIUS = 4.0;

// Tol's muted colours and dark grey: apart for every kind of sight, and on paper.
static const unsigned colours[] = {0x332288, 0xcc6677, 0x117733, 0xddaa33, 0x88ccee,
                                   0x882255, 0x44aa99, 0x999933, 0xaa4499, 0x555555};
enum { COLOURS = sizeof colours / sizeof *colours, SHAPES = 5 };

struct box {
    double x0, y0, x1, y1;
};

struct line {
    double x0, y0, x1, y1;
};

struct drawing {
    const struct plot *plot;
    cairo_t *c;
    struct box frame;  // on the page
    double x0, x1;     // the axis' ends, as place_of has them
    double y0, y1, y_step;
    struct box *taken;  // where labels may not go
    int taken_count;
    struct line *line;  // of all series, on the page
    int lines;
};

static double place_of(const struct plot *plot, double x)
{
    return plot->linear ? x : log10(x);
}

static double page_x(const struct drawing *d, double x)
{
    return d->frame.x0 +
           (place_of(d->plot, x) - d->x0) / (d->x1 - d->x0) * (d->frame.x1 - d->frame.x0);
}

static double page_y(const struct drawing *d, double y)
{
    return d->frame.y1 - (y - d->y0) / (d->y1 - d->y0) * (d->frame.y1 - d->frame.y0);
}

static void set_colour(cairo_t *c, unsigned rgb)
{
    cairo_set_source_rgb(c, (rgb >> 16) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0);
}

static void set_font(cairo_t *c, double size, bool bold)
{
    cairo_select_font_face(c, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c, size);
}

static double text_width(cairo_t *c, const char *text)
{
    cairo_text_extents_t e;
    cairo_text_extents(c, text, &e);
    return e.x_advance;
}

// `align` 0: begins at x; 0.5: centred; 1: ends there.
static void put_text(cairo_t *c, double x, double y, double align, const char *text)
{
    cairo_move_to(c, x - align * text_width(c, text), y);
    cairo_show_text(c, text);
}

// ---------------------------------------------------------------- axes

// 1, 2 or 5 times a power of ten, for about `count` steps over `range`.
static double nice_step(double range, int count)
{
    const double rough = range / count, power = pow(10.0, floor(log10(rough)));
    const double part = rough / power;
    return power * (part <= 1.0 ? 1.0 : part <= 2.0 ? 2.0 : part <= 5.0 ? 5.0 : 10.0);
}

static void choose_axes(struct drawing *d)
{
    const struct plot *p = d->plot;
    double x0 = HUGE_VAL, x1 = -HUGE_VAL, y0 = HUGE_VAL, y1 = -HUGE_VAL;
    for (int i = 0; i < p->points; i++) {
        x0 = fmin(x0, place_of(p, p->point[i].x));
        x1 = fmax(x1, place_of(p, p->point[i].x));
        y0 = fmin(y0, p->point[i].y);
        y1 = fmax(y1, p->point[i].y);
    }
    const double margin = p->curves ? 0.0 : fmax(0.06 * (x1 - x0), 0.05);
    d->x0 = x0 - margin;
    d->x1 = x1 + margin;
    d->y_step = nice_step(fmax(y1 - y0, 0.5), 9);
    d->y0 = floor((y0 - 0.1 * d->y_step) / d->y_step) * d->y_step;
    d->y1 = ceil((y1 + 0.35 * d->y_step) / d->y_step) * d->y_step;
}

enum { AXIS_TEXT = 0x333333 };

static void draw_grid_line(struct drawing *d, double x0, double y0, double x1, double y1,
                           bool strong)
{
    set_colour(d->c, strong ? 0xd0d0d0 : 0xebebeb);
    cairo_set_line_width(d->c, 1.0);
    cairo_move_to(d->c, x0, y0);
    cairo_line_to(d->c, x1, y1);
    cairo_stroke(d->c);
}

static void draw_x_tick(struct drawing *d, double value, bool named)
{
    const double x = page_x(d, value);
    char text[32];
    draw_grid_line(d, x, d->frame.y0, x, d->frame.y1, named);
    if (!named)
        return;
    snprintf(text, sizeof text, "%.6g", value);
    set_colour(d->c, AXIS_TEXT);
    put_text(d->c, x, d->frame.y1 + 18.0, 0.5, text);
}

static void draw_x_axis(struct drawing *d)
{
    const bool linear = d->plot->linear;
    const double decades = d->x1 - d->x0;
    const double low = linear ? d->x0 : pow(10.0, d->x0), high = linear ? d->x1 : pow(10.0, d->x1);
    set_font(d->c, TEXT, false);
    if (linear || decades < 0.4) {
        const double step = nice_step(high - low, 6);
        for (double v = ceil(low / step) * step; v <= high; v += step)
            draw_x_tick(d, v, true);
    } else {
        for (int e = relume_whole(floor(d->x0)); e <= relume_whole(ceil(d->x1)); e++)
            for (int digit = 1; digit < 10; digit++) {
                const double v = digit * pow(10.0, e);
                if (v >= low && v <= high)
                    draw_x_tick(d, v, decades < 0.8 || digit == 1 || digit == 2 || digit == 5);
            }
    }
    set_colour(d->c, AXIS_TEXT);
    put_text(d->c, 0.5 * (d->frame.x0 + d->frame.x1), d->frame.y1 + 42.0, 0.5, d->plot->x_label);
}

static void draw_y_axis(struct drawing *d)
{
    const int decimals = d->y_step >= 1.0 ? 0 : d->y_step >= 0.1 ? 1 : 2;
    const int steps = (int)lround((d->y1 - d->y0) / d->y_step);
    set_font(d->c, TEXT, false);
    for (int i = 0; i <= steps; i++) {
        const double v = d->y0 + i * d->y_step, y = page_y(d, v);
        char text[32];
        draw_grid_line(d, d->frame.x0, y, d->frame.x1, y, true);
        snprintf(text, sizeof text, "%.*f", decimals, v);
        set_colour(d->c, AXIS_TEXT);
        put_text(d->c, d->frame.x0 - 8.0, y + 4.0, 1.0, text);
    }
    set_colour(d->c, AXIS_TEXT);
    cairo_save(d->c);
    cairo_translate(d->c, 22.0, 0.5 * (d->frame.y0 + d->frame.y1));
    cairo_rotate(d->c, -M_PI / 2.0);
    put_text(d->c, 0.0, 0.0, 0.5, d->plot->y_label);
    cairo_restore(d->c);
}

// ---------------------------------------------------------------- points

static unsigned colour_of(const struct drawing *d, int series)
{
    return colours[d->plot->series[series].colour % COLOURS];
}

static void draw_mark(const struct drawing *d, double x, double y, int series)
{
    cairo_t *c = d->c;
    const double r = RADIUS;
    static const double angle[SHAPES] = {0.0, M_PI / 4.0, -M_PI / 2.0, 0.0, M_PI / 2.0};
    static const int corners[SHAPES] = {0, 4, 3, 4, 3};
    const int shape = d->plot->series[series].mark % SHAPES;
    cairo_new_path(c);
    if (!corners[shape])
        cairo_arc(c, x, y, r, 0.0, 2.0 * M_PI);
    for (int i = 0; i < corners[shape]; i++) {
        const double a = angle[shape] + 2.0 * M_PI * i / corners[shape];
        cairo_line_to(c, x + 1.3 * r * cos(a), y + 1.3 * r * sin(a));
    }
    cairo_close_path(c);
    set_colour(c, colour_of(d, series));
    cairo_fill_preserve(c);
    set_colour(c, 0xffffff);
    cairo_set_line_width(c, 0.8);
    cairo_stroke(c);
}

static int by_place(const void *a, const void *b)
{
    const struct plot_point *p = *(const struct plot_point *const *)a;
    const struct plot_point *q = *(const struct plot_point *const *)b;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return (p->y > q->y) - (p->y < q->y);
}

static void draw_path(struct drawing *d, const struct plot_point *const *sorted, int series)
{
    cairo_new_path(d->c);
    for (int i = 0; i < d->plot->points; i++)
        if (series < 0 ? sorted[i]->on_hull : sorted[i]->series == series)
            cairo_line_to(d->c, page_x(d, sorted[i]->x), page_y(d, sorted[i]->y));
}

static void draw_hull(struct drawing *d, const struct plot_point *const *sorted)
{
    draw_path(d, sorted, -1);
    cairo_set_line_join(d->c, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(d->c, CAIRO_LINE_CAP_ROUND);
    cairo_set_source_rgba(d->c, 1.0, 0.83, 0.25, 0.55);
    cairo_set_line_width(d->c, 9.0);
    cairo_stroke(d->c);
}

static void take_rectangle(struct drawing *d, double x0, double y0, double x1, double y1)
{
    d->taken[d->taken_count++] = (struct box){x0, y0, x1, y1};
}

static bool is_free(const struct drawing *d, struct box b)
{
    if (b.x0 < d->frame.x0 || b.x1 > d->frame.x1 || b.y0 < d->frame.y0 || b.y1 > d->frame.y1)
        return false;
    for (int i = 0; i < d->taken_count; i++) {
        const struct box *t = &d->taken[i];
        if (b.x0 < t->x1 && t->x0 < b.x1 && b.y0 < t->y1 && t->y0 < b.y1)
            return false;
    }
    return true;
}

// Keep of [*from, *to] what satisfies p + t q >= 0.
static void cut(double p, double q, double *from, double *to)
{
    if (q > 0.0)
        *from = fmax(*from, -p / q);
    else if (q < 0.0)
        *to = fmin(*to, -p / q);
    else if (p < 0.0)
        *to = -1.0;
}

static bool is_crossed(const struct drawing *d, struct box b)
{
    for (int i = 0; i < d->lines; i++) {
        const struct line *l = &d->line[i];
        const double dx = l->x1 - l->x0, dy = l->y1 - l->y0;
        double from = 0.0, to = 1.0;
        cut(l->x0 - b.x0, dx, &from, &to);
        cut(b.x1 - l->x0, -dx, &from, &to);
        cut(l->y0 - b.y0, dy, &from, &to);
        cut(b.y1 - l->y0, -dy, &from, &to);
        if (from <= to)
            return true;
    }
    return false;
}

// In the colour of its series, darker, on a white edge that parts it from lines.
static void draw_label(cairo_t *c, double x, double y, const char *text, unsigned rgb)
{
    cairo_move_to(c, x, y);
    cairo_text_path(c, text);
    cairo_set_source_rgba(c, 1.0, 1.0, 1.0, 0.8);
    cairo_set_line_width(c, 2.5);
    cairo_stroke_preserve(c);
    cairo_set_source_rgb(c, 0.7 * (rgb >> 16) / 255.0, 0.7 * (rgb >> 8 & 255) / 255.0,
                         0.7 * (rgb & 255) / 255.0);
    cairo_fill(c);
}

// Above, right, below, left of its point, then between these; on a line only where nothing better
// is free, and nowhere when all are taken.
static void put_label(struct drawing *d, const struct plot_point *p)
{
    static const double side[8][2] = {{0, -1},     {1, 0},     {0, 1},      {-1, 0},
                                      {0.8, -0.8}, {0.8, 0.8}, {-0.8, 0.8}, {-0.8, -0.8}};
    const double x = page_x(d, p->x), y = page_y(d, p->y), w = text_width(d->c, p->label);
    const double h = 0.75 * SMALL;
    for (int i = 0; i < 16; i++) {
        const double cx = x + side[i % 8][0] * (0.5 * w + RADIUS + 4.0);
        const double cy = y + side[i % 8][1] * (0.5 * h + RADIUS + 4.0);
        const struct box b = {cx - 0.5 * w - 1.0, cy - 0.5 * h - 1.0, cx + 0.5 * w + 1.0,
                              cy + 0.5 * h + 1.0};
        if (!is_free(d, b) || (i < 8 && is_crossed(d, b)))
            continue;
        draw_label(d->c, cx - 0.5 * w, cy + 0.5 * h, p->label, colour_of(d, p->series));
        take_rectangle(d, b.x0, b.y0, b.x1, b.y1);
        return;
    }
}

static void find_lines(struct drawing *d, const struct plot_point *const *sorted)
{
    for (int i = 0; i < d->plot->points; i++)
        for (int j = i + 1; j < d->plot->points; j++)
            if (sorted[i]->series == sorted[j]->series) {
                d->line[d->lines++] =
                    (struct line){page_x(d, sorted[i]->x), page_y(d, sorted[i]->y),
                                  page_x(d, sorted[j]->x), page_y(d, sorted[j]->y)};
                break;
            }
}

// Of points in one place that say the same one label is enough.
static bool is_said(const struct drawing *d, const struct plot_point *const *sorted, int i)
{
    for (int j = 0; j < i; j++)
        if (!strcmp(sorted[j]->label, sorted[i]->label) &&
            hypot(page_x(d, sorted[j]->x) - page_x(d, sorted[i]->x),
                  page_y(d, sorted[j]->y) - page_y(d, sorted[i]->y)) < RADIUS)
            return true;
    return false;
}

// Points on the hull are labelled first: they matter most.
static void put_labels(struct drawing *d, const struct plot_point *const *sorted)
{
    set_font(d->c, SMALL, false);
    find_lines(d, sorted);
    for (int i = 0; i < d->plot->points; i++) {
        const double x = page_x(d, sorted[i]->x), y = page_y(d, sorted[i]->y);
        take_rectangle(d, x - RADIUS - 1.0, y - RADIUS - 1.0, x + RADIUS + 1.0, y + RADIUS + 1.0);
    }
    for (int turn = 0; turn < 2; turn++)
        for (int i = 0; i < d->plot->points; i++)
            if (sorted[i]->on_hull == !turn && !is_said(d, sorted, i))
                put_label(d, sorted[i]);
}

static void draw_points(struct drawing *d, const struct plot_point *const *sorted)
{
    if (!d->plot->curves)
        draw_hull(d, sorted);
    cairo_set_line_width(d->c, 1.4);
    for (int s = 0; s < d->plot->series_count; s++) {
        draw_path(d, sorted, s);
        set_colour(d->c, colour_of(d, s));
        cairo_stroke(d->c);
    }
    if (d->plot->curves)
        return;
    for (int i = 0; i < d->plot->points; i++)
        draw_mark(d, page_x(d, sorted[i]->x), page_y(d, sorted[i]->y), sorted[i]->series);
    put_labels(d, sorted);
}

// ---------------------------------------------------------------- the page

// Margin right of the frame for the longest name, up to half of the page.
static double legend_width(const struct drawing *d)
{
    double width = 0.0;
    set_font(d->c, TEXT, false);
    for (int s = 0; s < d->plot->series_count; s++)
        width = fmax(width, text_width(d->c, d->plot->series[s].name));
    return fmin(fmax(width + 64.0, LEGEND), 0.5 * WIDTH);
}

static void draw_legend(struct drawing *d)
{
    const double x = d->frame.x1 + 20.0;
    const double share = (d->frame.y1 - d->frame.y0) / (d->plot->series_count + 1);
    const double step = share < 20.0 ? share : 20.0;
    double y = d->frame.y0 + 8.0;
    set_font(d->c, step < 14.0 ? SMALL : TEXT, false);
    for (int s = 0; s < d->plot->series_count; s++, y += step) {
        set_colour(d->c, colour_of(d, s));
        cairo_set_line_width(d->c, 1.4);
        cairo_move_to(d->c, x, y);
        cairo_line_to(d->c, x + 24.0, y);
        cairo_stroke(d->c);
        if (!d->plot->curves)
            draw_mark(d, x + 12.0, y, s);
        set_colour(d->c, 0x222222);
        put_text(d->c, x + 32.0, y + 4.0, 0.0, d->plot->series[s].name);
    }
    if (d->plot->curves)
        return;
    y += 4.0;
    cairo_set_source_rgba(d->c, 1.0, 0.83, 0.25, 0.55);
    cairo_set_line_width(d->c, 9.0);
    cairo_move_to(d->c, x + 4.0, y);
    cairo_line_to(d->c, x + 20.0, y);
    cairo_stroke(d->c);
    set_colour(d->c, 0x222222);
    put_text(d->c, x + 32.0, y + 4.0, 0.0, "convex hull");
}

static void draw_page(struct drawing *d, const struct plot_point *const *sorted)
{
    d->frame.x1 = WIDTH - legend_width(d);
    set_colour(d->c, 0xffffff);
    cairo_paint(d->c);
    set_colour(d->c, 0x111111);
    set_font(d->c, 15.0, true);
    put_text(d->c, LEFT, 26.0, 0.0, d->plot->title);
    set_font(d->c, TEXT, false);
    set_colour(d->c, 0x555555);
    put_text(d->c, LEFT, 46.0, 0.0, d->plot->subtitle);
    draw_x_axis(d);
    draw_y_axis(d);
    draw_points(d, sorted);
    set_colour(d->c, 0x777777);
    cairo_set_line_width(d->c, 1.0);
    cairo_rectangle(d->c, d->frame.x0, d->frame.y0, d->frame.x1 - d->frame.x0,
                    d->frame.y1 - d->frame.y0);
    cairo_stroke(d->c);
    draw_legend(d);
}

static cairo_status_t add_bytes(void *file, const unsigned char *data, unsigned length)
{
    return fwrite(data, 1, length, file) == length ? CAIRO_STATUS_SUCCESS
                                                   : CAIRO_STATUS_WRITE_ERROR;
}

static bool draw_to_file(struct drawing *d, const struct plot_point *const *sorted, bool png,
                         FILE *file)
{
    cairo_surface_t *surface =
        png ? cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)(2.0 * WIDTH),
                                         (int)(2.0 * HEIGHT))
            : cairo_svg_surface_create_for_stream(add_bytes, file, WIDTH, HEIGHT);
    d->c = cairo_create(surface);
    if (png)
        cairo_scale(d->c, 2.0, 2.0);
    draw_page(d, sorted);
    bool good = cairo_status(d->c) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(d->c);
    if (png)
        good &= cairo_surface_write_to_png_stream(surface, add_bytes, file) == CAIRO_STATUS_SUCCESS;
    cairo_surface_finish(surface);
    good &= cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS;
    cairo_surface_destroy(surface);
    return good;
}

static relume_status save(const struct plot *plot, const struct plot_point *const *sorted, bool png,
                          const char *stem, const struct relume_log *log)
{
    struct drawing d = {
        .plot = plot,
        .frame = {LEFT, TOP, WIDTH, HEIGHT - BOTTOM},
        .taken = calloc((size_t)plot->points, 2 * sizeof *d.taken),
        .line = calloc((size_t)plot->points, sizeof *d.line),
    };
    char *bytes = NULL, path[4200];
    size_t size = 0;
    FILE *memory = open_memstream(&bytes, &size);
    snprintf(path, sizeof path, "%.4096s.%s", stem, png ? "png" : "svg");
    bool good = d.taken && d.line && memory;
    if (good) {
        choose_axes(&d);
        good = draw_to_file(&d, sorted, png, memory);
    }
    if (memory && fclose(memory))
        good = false;
    const relume_status status = good ? relume_file_save(path, bytes, size, log) : RELUME_ENOMEM;
    free(bytes);
    free(d.taken);
    free(d.line);
    return status;
}

relume_status plot_save(const struct plot *plot, const char *stem, const struct relume_log *log)
{
    if (plot->points < 1)
        return RELUME_EINVAL;
    const struct plot_point **sorted = calloc((size_t)plot->points, sizeof *sorted);
    if (!sorted)
        return RELUME_ENOMEM;
    for (int i = 0; i < plot->points; i++)
        sorted[i] = &plot->point[i];
    qsort(sorted, (size_t)plot->points, sizeof *sorted, by_place);
    relume_status status = save(plot, sorted, false, stem, log);
    if (!status)
        status = save(plot, sorted, true, stem, log);
    free(sorted);
    return status;
}
