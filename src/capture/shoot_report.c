// shoot_report.c - report.html: what was made, how good it is, and what to do better
#include "capture/shoot.h"

#include "base/memory.h"
#include "capture/ball.h"
#include "image/picture.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { THUMB = 168, PLATE = 420 };

struct report {
    const struct shoot *s;
    const char *dir;
    FILE *f;
    relume_status status;
};

static const char style[] =
    "body{font:14px/1.45 sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;color:#222}"
    "h1{font-size:22px}h2{font-size:17px;margin-top:1.6em}table{border-collapse:collapse}"
    "td,th{padding:2px 10px;text-align:right}th{border-bottom:1px solid #999}"
    "td:first-child,th:first-child{text-align:left}.row{display:flex;flex-wrap:wrap;gap:16px}"
    "figure{margin:0}figcaption{font-size:12px;color:#555}.warn{background:#fff3d6;border-left:4px "
    "solid #e0a000;padding:4px 10px;margin:4px 0}.good{color:#060}img{display:block}";

static void put_text(FILE *f, const char *text)
{
    for (; *text; text++)
        if (*text == '<')
            fputs("&lt;", f);
        else if (*text == '&')
            fputs("&amp;", f);
        else if (*text == '"')
            fputs("&quot;", f);
        else
            fputc(*text, f);
}

// ---------------------------------------------------------------- pictures

static void put_base64(FILE *f, const uint8_t *p, size_t n)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < n; i += 3) {
        const unsigned v = (unsigned)p[i] << 16 | (i + 1 < n ? (unsigned)p[i + 1] << 8 : 0u) |
                           (i + 2 < n ? p[i + 2] : 0u);
        fputc(digit[v >> 18], f);
        fputc(digit[v >> 12 & 63], f);
        fputc(i + 1 < n ? digit[v >> 6 & 63] : '=', f);
        fputc(i + 2 < n ? digit[v & 63] : '=', f);
    }
}

static relume_status put_file(FILE *f, const char *path)
{
    uint8_t block[3 * 4096];
    size_t n;
    FILE *from = fopen(path, "rb");
    if (!from)
        return RELUME_EIO;
    while ((n = fread(block, 1, sizeof block, from)) > 0)
        put_base64(f, block, n);
    fclose(from);
    return RELUME_OK;
}

// Coded bytes as a data: URL, through a file of the folder that does not stay.
static void put_bytes(struct report *r, int width, int height, const uint8_t *bytes)
{
    char *path = mem_format("%s/thumbnail.jpg", r->dir);
    relume_status status =
        path ? picture_write_bytes(path, width, height, 3, bytes, r->s->p.log) : RELUME_ENOMEM;
    fprintf(r->f, "<img width=\"%d\" height=\"%d\" src=\"data:image/jpeg;base64,", width, height);
    if (!status)
        status = put_file(r->f, path);
    fputs("\" alt=\"\">", r->f);
    if (path)
        unlink(path);
    free(path);
    r->status = r->status ? r->status : status;
}

enum look { LOOK_LIGHT, LOOK_NORMAL };

static float coded(float v, enum look look)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    if (look == LOOK_NORMAL)
        return 0.5f + 0.5f * v;
    return relume_transfer_encode(srgb, fminf(fmaxf(v, 0.0f), 1.0f));
}

// `image` made fit into a square of `side`, values times `gain`.
static void put_picture(struct report *r, const struct relume_image *image, int side, float gain,
                        enum look look)
{
    const int most = image->width > image->height ? image->width : image->height;
    const double step = most > side ? (double)most / side : 1.0;
    const int w = (int)fmax(image->width / step, 1.0), h = (int)fmax(image->height / step, 1.0);
    uint8_t *bytes = mem_array((size_t)w * (size_t)h, 3);
    for (int y = 0; bytes && y < h; y++)
        for (int x = 0; x < w; x++) {
            const int x0 = (int)(x * step), y0 = (int)(y * step);
            const int x1 = (int)fmin((x + 1) * step, image->width),
                      y1 = (int)fmin((y + 1) * step, image->height);
            for (int c = 0; c < 3; c++) {
                float sum = 0.0f;
                int n = 0;
                for (int v = y0; v < y1 || v == y0; v++)
                    for (int u = x0; u < x1 || u == x0; u++, n++)
                        sum += image->data[((size_t)v * (size_t)image->width + (size_t)u) *
                                               (size_t)image->channels +
                                           (size_t)(image->channels == 3 ? c : 0)];
                const float code = coded(gain * sum / (float)n, look);
                bytes[3 * ((size_t)y * (size_t)w + (size_t)x) + (size_t)c] =
                    (uint8_t)(255.0f * fminf(fmaxf(code, 0.0f), 1.0f) + 0.5f);
            }
        }
    if (bytes)
        put_bytes(r, w, h, bytes);
    else
        r->status = RELUME_ENOMEM;
    free(bytes);
}

// The gain that makes the brightest of the values about white.
static float gain_for(const struct relume_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += (double)image->data[i] * (double)image->data[i];
    const float rms = (float)sqrt(sum / (double)n);
    return rms > 0.0f ? 0.35f / rms : 1.0f;
}

// ---------------------------------------------------------------- parts

static void put_warnings(struct report *r)
{
    const struct relume_shoot *out = r->s->out;
    fputs("<h2>Warnings</h2>\n", r->f);
    if (!out->warnings)
        fputs("<p class=\"good\">none</p>\n", r->f);
    for (int i = 0; i < out->warnings; i++) {
        fputs("<div class=\"warn\">", r->f);
        put_text(r->f, out->warning[i]);
        fputs("</div>\n", r->f);
    }
}

static double mean_sigma(const struct relume_shoot *out)
{
    double sum = 0.0;
    for (int i = 0; i < out->lights; i++)
        sum += out->photo[i].sigma_deg / out->lights;
    return sum;
}

static void put_summary(struct report *r)
{
    const struct relume_shoot *out = r->s->out;
    FILE *f = r->f;
    fprintf(f, "<table><tr><td>pictures</td><td>%d of %d x %d pixels</td></tr>\n", out->lights,
            out->width, out->height);
    fprintf(f, "<tr><td>lights</td><td>%s</td></tr>\n", out->position ? "near" : "distant");
    if (mean_sigma(out) > 0.0)
        fprintf(f, "<tr><td>estimated error of directions</td><td>%.2f&#176; (mean)</td></tr>\n",
                mean_sigma(out));
    if (out->position_error > 0.0)
        fprintf(f,
                "<tr><td>estimated error of positions</td><td>%.1f %% of distance (mean)</td></tr>"
                "\n",
                100.0 * out->position_error);
    fprintf(f, "<tr><td>widest gap between lights</td><td>%.0f&#176;</td></tr>\n", out->gap_deg);
    if (out->photometric.normal.data)
        fprintf(f,
                "<tr><td>what a matte surface misses</td><td>%.1f %% of its albedo (median)</td>"
                "</tr>\n",
                100.0 * out->photometric.residual);
    fputs("</table>\n", f);
}

// The mean photograph of the balls with their outlines and all highlights.
static void put_balls(struct report *r)
{
    const struct relume_shoot *out = r->s->out;
    const struct relume_image *mean = &r->s->mean;
    if (!out->balls || !mean->data)
        return;
    const int most = mean->width > mean->height ? mean->width : mean->height;
    const double scale = most > PLATE ? (double)PLATE / most : 1.0;
    fputs("<figure><div style=\"position:relative\">", r->f);
    put_picture(r, mean, PLATE, 2.0f * gain_for(mean), LOOK_LIGHT);
    fprintf(r->f,
            "<svg style=\"position:absolute;left:0;top:0\" width=\"%.0f\" height=\"%.0f\" "
            "fill=\"none\">",
            mean->width * scale, mean->height * scale);
    for (int b = 0; b < out->balls; b++)
        fprintf(r->f, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" stroke=\"#3f3\"/>",
                out->ball[b].x * scale, out->ball[b].y * scale, out->ball[b].radius * scale);
    for (int i = 0; i < out->lights; i++)
        fprintf(r->f, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"2\" stroke=\"#f33\"/>",
                out->photo[i].light.x * scale, out->photo[i].light.y * scale);
    fprintf(r->f,
            "</svg></div><figcaption>ball at %.1f, %.1f, radius %.1f; %.0f %% of its outline "
            "seen</figcaption></figure>\n",
            out->ball[0].x, out->ball[0].y, out->ball[0].radius, 100.0 * out->ball[0].coverage);
}

static void put_sphere(struct report *r)
{
    char *svg = shoot_light_sphere(r->s->out);
    if (!svg) {
        r->status = RELUME_ENOMEM;
        return;
    }
    fputs("<figure>", r->f);
    fputs(svg, r->f);
    fputs("<figcaption>the lights as seen from the camera; pale discs: twice the estimated error; "
          "red: the widest gap</figcaption></figure>\n",
          r->f);
    free(svg);
}

static void put_surface(struct report *r)
{
    const struct relume_photometric *p = &r->s->out->photometric;
    if (!p->normal.data)
        return;
    fputs("<h2>Surface</h2>\n<div class=\"row\"><figure>", r->f);
    put_picture(r, &p->normal, 320, 1.0f, LOOK_NORMAL);
    fputs("<figcaption>normals</figcaption></figure><figure>", r->f);
    put_picture(r, &p->albedo, 320, gain_for(&p->albedo), LOOK_LIGHT);
    fputs("<figcaption>albedo</figcaption></figure><figure>", r->f);
    put_picture(r, &p->error, 320, 10.0f, LOOK_LIGHT);
    fputs("<figcaption>what Lambert's law misses (white: 10 % of the albedo)</figcaption></figure>"
          "</div>\n",
          r->f);
}

static void put_table(struct report *r)
{
    const struct relume_shoot *out = r->s->out;
    FILE *f = r->f;
    fputs("<h2>Lights</h2>\n<table><tr><th>photograph</th><th>x</th><th>y</th><th>z</th><th>error"
          "</th><th>lamp's width</th><th>misses</th><th>saturated</th></tr>\n",
          f);
    for (int i = 0; i < out->lights; i++) {
        const struct relume_shoot_photo *p = &out->photo[i];
        const vec3 d = out->position ? out->position[i] : out->direction[i];
        fprintf(f, "<tr><td>%d ", i);
        put_text(f, shoot_base_name(p->path));
        fprintf(f, "</td><td>%.3f</td><td>%.3f</td><td>%.3f</td>", d.x, d.y, d.z);
        fprintf(f, p->sigma_deg > 0.0 ? "<td>%.2f&#176;</td>" : "<td></td>", p->sigma_deg);
        fprintf(f, p->light.spread_deg > 0.0 ? "<td>%.1f&#176;</td>" : "<td></td>",
                p->light.spread_deg);
        fprintf(f, "<td>%.1f %%</td><td>%.2f %%</td></tr>\n",
                out->photometric.light_residual ? 100.0 * out->photometric.light_residual[i] : 0.0,
                100.0 * (double)p->saturated);
    }
    fputs("</table>\n", f);
}

static void put_thumbnails(struct report *r)
{
    fputs("<h2>Photographs</h2>\n<div class=\"row\">", r->f);
    for (int i = 0; i < r->s->shots && !r->status; i++) {
        fputs("<figure>", r->f);
        put_picture(r, &r->s->shot[i].small, THUMB, 1.0f, LOOK_LIGHT);
        fprintf(r->f, "<figcaption>%d ", i);
        put_text(r->f, shoot_base_name(r->s->shot[i].path));
        fputs("</figcaption></figure>\n", r->f);
    }
    fputs("</div>\n", r->f);
}

static relume_status write_sphere(const struct shoot *s, const char *dir)
{
    char *svg = shoot_light_sphere(s->out), *path = mem_format("%s/lights.svg", dir);
    const relume_status status =
        svg && path ? outfile_save(path, svg, strlen(svg), s->p.log) : RELUME_ENOMEM;
    free(svg);
    free(path);
    return status;
}

relume_status shoot_report(const struct shoot *s, const char *dir)
{
    char *text = NULL, *path = mem_format("%s/report.html", dir);
    size_t size = 0;
    struct report r = {.s = s, .dir = dir, .f = open_memstream(&text, &size)};
    if (!r.f || !path) {
        free(path);
        return RELUME_ENOMEM;
    }
    fprintf(r.f,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>capture"
            "</title><style>%s</style></head><body>\n<h1>Capture of %d photographs</h1>\n",
            style, s->shots);
    put_summary(&r);
    put_warnings(&r);
    fputs("<h2>Where the lights stood</h2>\n<div class=\"row\">", r.f);
    put_sphere(&r);
    put_balls(&r);
    fputs("</div>\n", r.f);
    put_surface(&r);
    put_table(&r);
    put_thumbnails(&r);
    fputs("</body></html>\n", r.f);
    if (fclose(r.f) && !r.status)
        r.status = RELUME_ENOMEM;
    if (!r.status)
        r.status = outfile_save(path, text, size, s->p.log);
    if (!r.status)
        r.status = write_sphere(s, dir);
    free(text);
    free(path);
    return r.status;
}
