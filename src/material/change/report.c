// report.c - report.html: what has changed, where, and how sure that is
//
// No script: the pictures before and after take turns by an animation of the style sheet, which
// stands still for people who have asked for less motion.
#include "material/change/report.h"

#include "core/math/markup.h"
#include "core/math/scalar.h"
#include "material/maps/folder.h"

#include <math.h>

static const char style[] =
    "body{font:15px/1.5 sans-serif;max-width:1200px}"
    "figure{flex:1 1 340px}figcaption{font-size:13px;color:#444}"
    "img{display:block;width:100%;height:auto;image-rendering:auto}"
    ".over>svg,.over>.top{position:absolute;left:0;top:0;width:100%;height:100%}"
    "@keyframes blink{0%,49%{opacity:0}50%,100%{opacity:1}}"
    ".top{animation:blink 1.6s steps(1) infinite}.over:hover .top{animation-play-state:paused}"
    "@media(prefers-reduced-motion:reduce){.top{animation:none;opacity:.5}}"
    ".ramp{display:inline-block;width:120px;height:10px;background:linear-gradient(to right,"
    "#000005,#570f6e,#ba3654,#fa8c0a,#fcffbf)}";

static double share(const struct relume_change *c, size_t area)
{
    return c->known ? 100.0 * (double)area / (double)c->known : 0.0;
}

static void put_summary(FILE *f, const struct relume_change *c)
{
    if (c->places)
        fprintf(f,
                "<p class=\"warn\"><b>%d place%s changed</b>: %.3g %% of the surface (shape %.3g "
                "%%, colour %.3g %%, gloss alone %.3g %%).</p>\n",
                c->places, c->places == 1 ? " has" : "s have", share(c, c->area),
                share(c, c->shape), share(c, c->colour), share(c, c->gloss_area));
    else
        fputs("<p class=\"good\"><b>Nothing has changed</b> that is more than chance.</p>\n", f);
    fprintf(f, "<table><tr><td>pixels compared</td><td>%zu of %d x %d</td></tr>\n", c->known,
            c->width, c->height);
    fprintf(f,
            "<tr><td>similarity of the pictures that were laid on each other</td><td>%.2f</td></tr>"
            "<tr><td>longest step of the smooth flow</td><td>%.1f pixels</td></tr>"
            "<tr><td>places are off by about</td><td>%.2f pixels</td></tr>\n",
            c->registered.correlation, c->flow, c->misplaced);
    fprintf(
        f,
        "<tr><td>uncertainty of a normal (median)</td><td>%.2f&#176;</td></tr>"
        "<tr><td>uncertainty of a colour (median)</td><td>about %.1f deltaE</td></tr>"
        "<tr><td>uncertainty of gloss (median; compared where enough lamps stand near the mirror "
        "direction: %.0f %%)</td><td>%.3f of white</td></tr>"
        "<tr><td>smooth bend that was taken away</td><td>%.1f&#176;</td></tr>"
        "<tr><td>gain of the second's colours</td><td>%.3f %.3f %.3f</td></tr></table>\n",
        c->noise_deg, c->noise_de, share(c, c->gloss_known), c->noise_gloss, c->bend_deg,
        c->gain[0], c->gain[1], c->gain[2]);
}

static void put_boxes(FILE *f, const struct relume_change *c, int places)
{
    const double line = fmax(c->width, c->height) / 400.0;
    fprintf(f, "<svg viewBox=\"0 0 %d %d\" fill=\"none\" stroke=\"#fd0\" stroke-width=\"%.2f\">",
            c->width, c->height, line);
    for (int i = 0; i < places; i++) {
        const struct relume_rect *b = &c->place[i].box;
        fprintf(f, "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\"/>", b->left - 2 * line,
                b->top - 2 * line, b->width + 4 * line, b->height + 4 * line);
        fprintf(f,
                "<text x=\"%g\" y=\"%g\" font-size=\"%.1f\" fill=\"#fd0\" "
                "stroke=\"none\">%d</text>",
                b->left + b->width + 3 * line, b->top + 2 * line, 9 * line, i + 1);
    }
    fputs("</svg>", f);
}

static void put_picture(FILE *f, const char *file, const char *says, double most)
{
    fprintf(f, "<figure><img src=\"%s\" alt=\"%s\"><figcaption>%s", file, says, says);
    if (most > 0.0)
        fprintf(f, " <span class=\"ramp\"></span> 0 to %g", most);
    fputs("</figcaption></figure>\n", f);
}

static void put_pictures(FILE *f, const struct relume_change *c, int places)
{
    fputs("<h2>Where</h2>\n<div class=\"row\"><figure><div class=\"over\"><img src=\"changed.png\" "
          "alt=\"what has changed\">",
          f);
    put_boxes(f, c, places);
    fputs("</div><figcaption>orange: the shape has changed, blue: the colour, pink: "
          "both, green: the gloss alone</figcaption></figure>\n<figure><div class=\"over\"><img "
          "src=\"before.png\" "
          "alt=\"before\"><img class=\"top\" src=\"after.png\" alt=\"after\"></div>"
          "<figcaption>before and after take turns (point at the picture to hold it), under the "
          "same light from the upper left; <a href=\"before.png\">before.png</a>, <a "
          "href=\"after.png\">after.png</a></figcaption></figure></div>\n",
          f);
    fputs("<h2>How much, and how surely</h2>\n<div class=\"row\">", f);
    put_picture(f, "shape.png", "turn of the normals, degrees", RAMP_DEGREES);
    put_picture(f, "colour.png", "difference of colour, deltaE (CIEDE2000)", RAMP_DELTA_E);
    put_picture(f, "gloss.png", "difference of highlights, parts of white", RAMP_GLOSS);
    put_picture(f, "significance.png", "significance: -log10 of the probability of chance",
                RAMP_SIGNIFICANCE);
    fputs("</div>\n", f);
}

static void put_places(FILE *f, const struct relume_change *c, int places)
{
    if (!places)
        return;
    fprintf(f, "<h2>Places</h2>\n<table><tr><th>place</th><th>x</th><th>y</th><th>width</th>"
               "<th>height</th><th>pixels</th><th>of shape</th><th>of colour</th><th>of "
               "gloss</th><th>turn</th><th>deltaE</th><th>highlights</th><th>chance</th></tr>\n");
    for (int i = 0; i < places; i++) {
        const struct relume_change_place *p = &c->place[i];
        fprintf(f,
                "<tr><td>%d</td><td>%d</td><td>%d</td><td>%d</td><td>%d</td><td>%d</td><td>%d</td>"
                "<td>%d</td><td>%d</td><td>%.1f&#176;</td><td>%.1f</td><td>%+.2f</"
                "td><td>10<sup>-%.0f</sup></td></tr>\n",
                i + 1, p->box.left, p->box.top, p->box.width, p->box.height, p->area, p->shape,
                p->colour, p->gloss, p->deg, p->delta_e, p->gloss_by, p->significance);
    }
    fputs("</table>\n", f);
    if (places < c->places)
        fprintf(f, "<p>and %d smaller ones.</p>\n", c->places - places);
}

static void put_page(const void *context, FILE *f)
{
    const struct writing *w = context;
    const struct relume_change *c = w->change;
    const int places = smaller_of(c->places, w->params->places);
    fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta "
          "name=\"viewport\" content=\"width=device-width\"><title>change over "
          "time</title><style>",
          f);
    fputs(markup_style, f);
    fputs(style, f);
    fputs("</style></head><body>\n<h1>What has changed from ", f);
    markup_text(f, w->params->name[0]);
    fputs(" to ", f);
    markup_text(f, w->params->name[1]);
    fputs("</h1>\n", f);
    put_summary(f, c);
    put_pictures(f, c, places);
    put_places(f, c, places);
    fputs("</body></html>\n", f);
}

relume_status report_write(const struct writing *w)
{
    return folder_print(w->folder, "report.html", put_page, w, w->params->log);
}
