// page.c - the pages of a site
//
// Texts of people go through markup_text alone; names of files are those of names.h. Pages load
// nothing from elsewhere.
#include "site/publish/page.h"

#include "core/base/memory.h"
#include "core/math/markup.h"
#include "site/publish/assets.h"

#include <string.h>

static void put_meta(FILE *f, const char *kind, const char *key, const char *value)
{
    if (!value || !*value)
        return;
    fprintf(f, "<meta %s=\"%s\" content=\"", kind, key);
    markup_text(f, value);
    fputs("\">\n", f);
}

static void put_open_graph(FILE *f, const struct site *site, const char *page, const char *poster,
                           const struct details *d)
{
    put_meta(f, "name", "description", d->description);
    put_meta(f, "name", "author", d->maker);
    put_meta(f, "property", "og:type", "website");
    put_meta(f, "property", "og:title", d->title);
    put_meta(f, "property", "og:description", d->description);
    if (poster) {
        fputs("<meta property=\"og:image\" content=\"", f);
        site_put_address(f, site, poster);
        fputs("\">\n<meta name=\"twitter:card\" content=\"summary_large_image\">\n", f);
    }
    if (site->params->url) {
        fputs("<meta property=\"og:url\" content=\"", f);
        site_put_address(f, site, page);
        fputs("\">\n<link rel=\"canonical\" href=\"", f);
        site_put_address(f, site, page);
        fputs("\">\n", f);
    }
}

static void put_head(FILE *f, const struct site *site, const char *page, const char *poster,
                     const struct details *d, const char *script)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>",
          f);
    markup_text(f, d->title);
    fputs("</title>\n", f);
    put_open_graph(f, site, page, poster, d);
    fprintf(f, "<meta name=\"generator\" content=\"relume %s\">\n", RELUME_VERSION);
    fprintf(f,
            "<link rel=\"stylesheet\" href=\"relume/relume.css\">\n"
            "<link rel=\"stylesheet\" href=\"relume/site.css\">\n"
            "<script src=\"relume/%s\" defer></script>\n</head>\n<body>\n",
            script);
}

static void put_row(FILE *f, const char *term, const char *value)
{
    if (!value || !*value)
        return;
    fprintf(f, "<dt>%s</dt><dd>", term);
    markup_text(f, value);
    fputs("</dd>\n", f);
}

static bool is_link(const char *text)
{
    return text && (!strncmp(text, "https://", 8) || !strncmp(text, "http://", 7));
}

static void put_licence(FILE *f, const char *licence)
{
    if (!is_link(licence)) {
        put_row(f, "Licence", licence);
        return;
    }
    fputs("<dt>Licence</dt><dd><a rel=\"license\" href=\"", f);
    markup_text(f, licence);
    fputs("\">", f);
    markup_text(f, licence);
    fputs("</a></dd>\n", f);
}

static void put_description(FILE *f, const struct details *d)
{
    if (!d->description)
        return;
    fputs("<p>", f);
    markup_text(f, d->description);
    fputs("</p>\n", f);
}

static void put_details(FILE *f, const struct details *d)
{
    fputs("<dl>\n", f);
    put_row(f, "Maker", d->maker);
    put_row(f, "Object", d->object);
    put_licence(f, d->licence);
    fputs("</dl>\n", f);
}

static void put_poster(FILE *f, const struct page *p, const char *more)
{
    fprintf(f, "<img %ssrc=\"%s/poster.jpg\" width=\"%d\" height=\"%d\" alt=\"", more, p->name,
            p->poster_width, p->poster_height);
    markup_text(f, p->details.title);
    fputs(", in one light\">", f);
}

// The element that shows a file, and what it reads.
static const struct shown {
    const char *script, *element, *source;
} view = {"relume.js", "relume-view", "scene.json"},
  object = {ASSET_OBJECT, "relume-object", "object.json"};

static const struct shown *shown_by(const struct page *p)
{
    return p->object ? &object : &view;
}

// What another page needs to show the same: two lines of HTML.
static void put_embedding(FILE *f, const struct site *site, const struct page *p)
{
    const struct shown *shown = shown_by(p);
    char script[64];
    snprintf(script, sizeof script, "relume/%s", shown->script);
    fputs("<details>\n<summary>Show this in your own page</summary>\n"
          "<pre><code>&lt;script src=&quot;",
          f);
    site_put_address(f, site, script);
    fprintf(f, "&quot; defer&gt;&lt;/script&gt;\n&lt;%s src=&quot;", shown->element);
    site_put_address(f, site, p->name);
    fprintf(f, "/%s&quot;&gt;&lt;/%s&gt;</code></pre>\n</details>\n", shown->source,
            shown->element);
}

relume_status page_write(const struct site *site, const struct page *p, const char *site_title)
{
    struct text t;
    char name[128], poster[128];
    snprintf(name, sizeof name, "%s.html", p->name);
    snprintf(poster, sizeof poster, "%s/poster.jpg", p->name);
    const relume_status status = text_open(&t);
    if (status)
        return status;
    FILE *f = t.file;
    const struct shown *shown = shown_by(p);
    put_head(f, site, name, poster, &p->details, shown->script);
    fputs("<nav><a href=\"index.html\">", f);
    markup_text(f, site_title ? site_title : "All objects");
    fputs("</a></nav>\n<main>\n<h1>", f);
    markup_text(f, p->details.title);
    fprintf(f, "</h1>\n<%s src=\"%s/%s\" poster=\"%s\" title=\"", shown->element, p->name,
            shown->source, poster);
    markup_text(f, p->details.title);
    fputs("\"><noscript>", f);
    put_poster(f, p, "class=\"still\" ");
    fprintf(f, "<p>This page needs JavaScript to move the light.</p></noscript></%s>\n",
            shown->element);
    put_description(f, &p->details);
    put_details(f, &p->details);
    put_embedding(f, site, p);
    fprintf(f, "<p><a href=\"%s/manifest.json\">IIIF manifest</a></p>\n", p->name);
    fputs("</main>\n</body>\n</html>\n", f);
    return site_save_text(site, name, false, &t);
}

// Where visitors choose a file of their own, unless they drop it.
static void put_chooser(FILE *f)
{
    fputs("<p><label>Drop a relume file (.exr) of your own here, or choose it: "
          "<input type=\"file\" accept=\".exr\" data-relume-open></label><br>\n"
          "It is read by this browser and sent nowhere.</p>\n"
          "<p role=\"status\" data-relume-said></p>\n",
          f);
}

relume_status page_write_open(const struct site *site)
{
    const struct details d = {.title = "Open a relume file"};
    struct text t;
    const relume_status status = text_open(&t);
    if (status)
        return status;
    put_head(t.file, site, "open.html", NULL, &d, view.script);
    fputs("<nav><a href=\"index.html\">All objects</a></nav>\n<main>\n<h1>Open a relume "
          "file</h1>\n",
          t.file);
    put_chooser(t.file);
    fputs("<noscript><p>This page needs JavaScript.</p></noscript>\n</main>\n</body>\n</html>\n",
          t.file);
    return site_save_text(site, "open.html", false, &t);
}

relume_status page_write_index(const struct site *site, const struct page *pages, int count,
                               const struct details *details)
{
    struct details d = *details;
    struct text t;
    char poster[128];
    snprintf(poster, sizeof poster, "%s/poster.jpg", pages[0].name);
    d.title = d.title ? d.title : count == 1 ? pages[0].details.title : "Relightable objects";
    const relume_status status = text_open(&t);
    if (status)
        return status;
    FILE *f = t.file;
    put_head(f, site, "index.html", poster, &d, view.script);
    fputs("<main>\n<h1>", f);
    markup_text(f, d.title);
    fputs("</h1>\n", f);
    put_description(f, &d);
    fputs("<ul class=\"gallery\">\n", f);
    for (int i = 0; i < count; i++) {
        fprintf(f, "<li><a href=\"%s.html\">", pages[i].name);
        put_poster(f, &pages[i], i < 12 ? "" : "loading=\"lazy\" ");
        fputs("<span>", f);
        markup_text(f, pages[i].details.title);
        fputs("</span><span class=\"quiet\">", f);
        markup_text(f, pages[i].details.maker);
        fputs("</span></a></li>\n", f);
    }
    fputs("</ul>\n", f);
    put_details(f, &d);
    put_chooser(f);
    fputs("</main>\n</body>\n</html>\n", f);
    return site_save_text(site, "index.html", false, &t);
}
