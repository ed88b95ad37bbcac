// acquire_report.c - report.html: what was made, how good it is, and what to do better
#include "core/base/tree.h"
#include "capture/acquire/acquire.h"

#include "capture/acquire/report_picture.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/math/markup.h"

#include <stdio.h>
#include <string.h>

enum { THUMB = 168, PLATE = 420 };

struct report {
    const struct acquisition *s;
    const char *dir;
    FILE *f;
    relume_status status;
};

static const char style[] =
    "body{font:14px/1.5 sans-serif;max-width:1100px}"
    "img,svg{display:block;max-width:100%;height:auto}"
    "figcaption{font-size:12px;color:#555;max-width:420px}"
    ".over svg{position:absolute;left:0;top:0;width:100%}"
    ".wide{overflow-x:auto}.wide td,.wide th{white-space:nowrap}"
    ".warn{margin:4px 0;overflow-wrap:anywhere}.off td,.off figcaption{color:#b00}"
    ".patches td{padding:2px;width:92px;text-align:center!important;line-height:1.1}"
    ".sun{position:absolute;right:3px;top:3px;width:34px!important;left:auto!important}"
    "@media print{body{margin:0}}";

static void put_picture(struct report *r, const struct relume_image *image, int side, float gain,
                        enum report_look look)
{
    if (!r->status)
        r->status = report_picture(r->f, r->dir, image, side, gain, look, r->s->p.log);
}

// ---------------------------------------------------------------- parts

static void put_warnings(struct report *r)
{
    const struct relume_acquisition *out = r->s->out;
    fputs("<h2>Warnings</h2>\n", r->f);
    if (!out->warnings)
        fputs("<p class=\"good\">none</p>\n", r->f);
    for (int i = 0; i < out->warnings; i++) {
        fputs("<div class=\"warn\">", r->f);
        markup_text(r->f, out->warning[i]);
        fputs("</div>\n", r->f);
    }
}

// The patches as photographed and as they are.
static void put_patch(FILE *f, const float photographed[3], const struct relume_chart_patch *p)
{
    const float *const rgb[] = {photographed, p->is};
    fputs("<td>", f);
    for (int k = 0; k < 2; k++) {
        int code[3];
        for (int c = 0; c < 3; c++)
            code[c] = (int)(255.0f * relume_transfer_encode(
                                         (struct relume_transfer){.curve = RELUME_CURVE_SRGB},
                                         fminf(fmaxf(rgb[k][c], 0.0f), 1.0f)) +
                            0.5f);
        fprintf(f,
                "<span style=\"display:inline-block;width:34px;height:%dpx;background:"
                "rgb(%d,%d,%d)\"></span>",
                34, code[0], code[1], code[2]);
    }
    fprintf(f, p->used ? "<br><small>%s %.1f</small></td>" : "<br><small>%s not used</small></td>",
            p->name, p->delta_e);
}

static void put_chart(struct report *r)
{
    const struct relume_chart *c = &r->s->out->chart;
    FILE *f = r->f;
    if (!r->s->out->target)
        return;
    fputs("<h2>Colour</h2>\n<p>Corrected by a colour target in ", f);
    markup_text(f, path_name(r->s->out->target));
    fprintf(f,
            ", %d of 24 patches used. Colour difference (CIEDE2000, mean and largest): %.1f and "
            "%.1f as photographed, %.1f and %.1f with white balance, <b>%.1f and %.1f</b> as "
            "written.</p>\n<table class=\"patches\"><caption>left: as photographed, "
            "right: what the patch is</caption>",
            c->used, c->before[0], c->before[1], c->balanced[0], c->balanced[1], c->after[0],
            c->after[1]);
    for (int i = 0; i < RELUME_CHART_PATCHES; i++) {
        float shown[3];
        for (int k = 0; k < 3; k++)
            shown[k] = (float)c->exposure * c->patch[i].found[k];
        fputs(i % RELUME_CHART_COLUMNS ? "" : i ? "</tr>\n<tr>" : "<tr>", f);
        put_patch(f, shown, &c->patch[i]);
    }
    fputs("</tr></table>\n", f);
}

static double mean_sigma(const struct relume_acquisition *out)
{
    double sum = 0.0;
    for (int i = 0; i < out->lights; i++)
        sum += out->photo[i].sigma_deg / out->lights;
    return sum;
}

static void put_summary(struct report *r)
{
    const struct relume_acquisition *out = r->s->out;
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
                "<tr><td>brightness error, if the surface were matte</td><td>%.1f %% (median)</td>"
                "</tr>\n",
                100.0 * out->photometric.residual);
    fputs("</table>\n", f);
}

// The mean photograph of the balls with their outlines and all highlights.
static void put_balls(struct report *r)
{
    const struct relume_acquisition *out = r->s->out;
    const struct relume_image *mean = &r->s->mean;
    if (!out->balls || !mean->data)
        return;
    const int most = mean->width > mean->height ? mean->width : mean->height;
    const double scale = most > PLATE ? (double)PLATE / most : 1.0;
    fputs("<figure><div class=\"over\">", r->f);
    put_picture(r, mean, PLATE, 2.0f * report_gain(mean), LOOK_LIGHT);
    fprintf(r->f, "<svg viewBox=\"0 0 %.0f %.0f\" fill=\"none\">", mean->width * scale,
            mean->height * scale);
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
    char *svg = acquire_light_sphere(r->s->out);
    if (!svg) {
        r->status = RELUME_ENOMEM;
        return;
    }
    fputs("<figure>", r->f);
    fputs(svg, r->f);
    fputs("<figcaption>the lights as seen from the camera; pale discs: twice the estimated error; "
          "red: the widest gap, and where lights should be added",
          r->f);
    if (r->s->witnessed)
        fputs("; the list of lights agrees with the ball in the photographs", r->f);
    else if (r->s->p.lights)
        fputs(
            "; no ball confirms the list of lights: if x and y are both negated in it, the relief "
            "is inverted, and the photographs cannot tell",
            r->f);
    fputs("</figcaption></figure>\n", r->f);
    mem_free(svg);
}

static void put_surface(struct report *r)
{
    const struct relume_photometric *p = &r->s->out->photometric;
    if (!p->normal.data)
        return;
    fputs("<h2>Surface</h2>\n<div class=\"row\"><figure>", r->f);
    put_picture(r, &p->normal, 320, 1.0f, LOOK_NORMAL);
    fputs("<figcaption>normals</figcaption></figure><figure>", r->f);
    put_picture(r, &p->albedo, 320, report_gain(&p->albedo), LOOK_LIGHT);
    fputs("<figcaption>albedo</figcaption></figure><figure>", r->f);
    put_picture(r, &p->error, 320, 10.0f, LOOK_LIGHT);
    fputs("<figcaption>difference from a matte surface (white: 10 % of its "
          "brightness)</figcaption></figure>"
          "</div>\n",
          r->f);
}

static double miss_of(const struct relume_acquisition *out, int i)
{
    return out->photometric.light_residual ? out->photometric.light_residual[i] : 0.0;
}

static void put_row(FILE *f, const struct relume_acquisition *out, int i, double most)
{
    const struct relume_acquired_photo *p = &out->photo[i];
    const vec3 d = out->position ? out->position[i] : out->direction[i];
    fprintf(f, "<tr%s><td>%d ", p->outlier ? " class=\"off\"" : "", i);
    markup_text(f, path_name(p->path));
    fprintf(f, "</td><td>%.3f</td><td>%.3f</td><td>%.3f</td>", d.x, d.y, d.z);
    fprintf(f, p->sigma_deg > 0.0 ? "<td>%.2f&#176;</td>" : "<td></td>", p->sigma_deg);
    fprintf(f, p->light.spread_deg > 0.0 ? "<td>%.1f&#176;</td>" : "<td></td>",
            p->light.spread_deg);
    // The share of 100 % as a bar behind the number.
    fprintf(f, "<td style=\"background:linear-gradient(to left,#cde %.0f%%,#fff 0)\">%.1f %%</td>",
            most > 0.0 ? 100.0 * miss_of(out, i) / most : 0.0, 100.0 * miss_of(out, i));
    fprintf(f, "<td>%.2f %%</td></tr>\n", 100.0 * (double)p->saturated);
}

static void put_table(struct report *r)
{
    const struct relume_acquisition *out = r->s->out;
    double most = 0.0;
    for (int i = 0; i < out->lights; i++)
        most = fmax(most, miss_of(out, i));
    fputs("<h2>Lights</h2>\n<div class=\"wide\"><table><tr><th>photograph</th><th>x</th><th>y</th>"
          "<th>z</th><th>error</th><th>lamp's width</th><th>brightness "
          "error</th><th>overexposed</th></tr>\n",
          r->f);
    for (int i = 0; i < out->lights; i++)
        put_row(r->f, out, i, most);
    fputs("</table></div>\n", r->f);
}

// All of one gain: which photograph is darker shows.
static float common_gain(const struct acquisition *s)
{
    float least = INFINITY;
    for (int i = 0; i < s->shots; i++)
        least = fminf(least, report_gain(&s->shot[i].small));
    return fmaxf(0.6f * least, 1.0f);  // mostly a small thing before black
}

static void put_thumbnails(struct report *r)
{
    const struct acquisition *s = r->s;
    const float gain = common_gain(s);
    fputs("<h2>Photographs and their lights</h2>\n<div class=\"row\">", r->f);
    for (int i = 0; i < s->shots && !r->status; i++) {
        fprintf(r->f, "<figure%s><div class=\"over\">",
                s->out->photo[i].outlier ? " class=\"off\"" : "");
        put_picture(r, &s->shot[i].small, THUMB, gain, LOOK_LIGHT);
        // Where the light of a photograph stood, for the corner of its thumbnail.
        fprintf(r->f,
                "<svg class=\"sun\" viewBox=\"-10 -10 20 20\"><circle r=\"9\" fill=\"#222\" "
                "stroke=\"#aaa\"/><circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.6\" fill=\"#fd4\"/></svg>",
                8.0 * s->out->direction[i].x, -8.0 * s->out->direction[i].y);
        fprintf(r->f, "</div><figcaption>%d ", i);
        markup_text(r->f, path_name(s->shot[i].path));
        fputs("</figcaption></figure>\n", r->f);
    }
    fputs("</div>\n", r->f);
}

static void put_exposure(FILE *f, const struct relume_exif *e)
{
    if (e->time_s > 0.0 && e->time_s < 0.4)
        fprintf(f, "1/%.0f s ", 1.0 / e->time_s);
    else if (e->time_s > 0.0)
        fprintf(f, "%.3g s ", e->time_s);
    if (e->f_number > 0.0)
        fprintf(f, "f/%.3g ", e->f_number);
    if (e->iso > 0.0)
        fprintf(f, "ISO %.0f", e->iso);
}

// What an archive asks of a photograph.
static void put_provenance(struct report *r)
{
    const struct acquisition *s = r->s;
    FILE *f = r->f;
    fputs("<h2>Files</h2>\n<div class=\"wide\"><table><tr><th>photograph</th><th>camera</th>"
          "<th>exposure</th><th>sharpness</th><th>bytes</th><th>SHA-256</th></tr>\n",
          f);
    for (int i = 0; i < s->shots; i++) {
        const struct shot *shot = &s->shot[i];
        fprintf(f, "<tr><td>%d ", i);
        markup_text(f, path_name(shot->path));
        fputs("</td><td>", f);
        markup_text(f, shot->notes.camera);
        fputs("</td><td>", f);
        put_exposure(f, &shot->notes);
        if (isfinite(shot->sharpness))
            fprintf(f, "</td><td>%.0f %%", 100.0 * (double)shot->sharpness);
        else
            fputs("</td><td>", f);
        fprintf(f, "</td><td>%llu</td><td><code>%s</code></td></tr>\n",
                (unsigned long long)shot->bytes, shot->sha256);
    }
    fputs("</table></div>\n<p>Made by relume " RELUME_VERSION ".</p>\n", f);
}

static relume_status write_sphere(const struct acquisition *s, const char *dir)
{
    char *svg = acquire_light_sphere(s->out), *path = mem_format("%s/lights.svg", dir);
    const relume_status status =
        svg && path ? outfile_save(path, svg, strlen(svg), s->p.log) : RELUME_ENOMEM;
    mem_free(svg);
    mem_free(path);
    return status;
}

relume_status acquire_report(const struct acquisition *s, const char *dir)
{
    char *text = NULL, *path = mem_format("%s/report.html", dir);
    size_t size = 0;
    struct report r = {.s = s, .dir = dir, .f = path ? open_memstream(&text, &size) : NULL};
    if (!r.f) {
        mem_free(path);
        return RELUME_ENOMEM;
    }
    fprintf(r.f,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta "
            "name=\"viewport\" content=\"width=device-width\"><title>capture"
            "</title><style>%s%s</style></head><body>\n<h1>Capture of %d photographs</h1>\n",
            markup_style, style, s->shots);
    put_warnings(&r);
    put_summary(&r);
    put_chart(&r);
    fputs("<h2>Where the lights stood</h2>\n<div class=\"row\">", r.f);
    put_sphere(&r);
    put_balls(&r);
    fputs("</div>\n", r.f);
    put_surface(&r);
    put_table(&r);
    put_thumbnails(&r);
    put_provenance(&r);
    fputs("</body></html>\n", r.f);
    if (fclose(r.f) && !r.status)
        r.status = RELUME_ENOMEM;
    if (!r.status)
        r.status = outfile_save(path, text, size, s->p.log);
    if (!r.status)
        r.status = write_sphere(s, dir);
    mem_free_libc(text);
    mem_free(path);
    return r.status;
}
