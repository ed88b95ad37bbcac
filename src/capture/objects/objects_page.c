// objects_page.c - report.html of many objects: an entry for each, and why some failed
#include "capture/objects/objects.h"

#include "capture/acquire/report_picture.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/math/markup.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    PICTURE = 200,  // pixels
    WARNINGS = 4,   // in an entry; the object's own report has all
};

// By this line a page is known as one that may be replaced.
static const char generator[] = "<meta name=\"generator\" content=\"relume objects\">";

static const char style[] =
    "body{font:14px/1.5 sans-serif;max-width:1100px}"
    ".objects{display:grid;gap:16px;"
    "grid-template-columns:repeat(auto-fill,minmax(min(100%,500px),1fr))}"
    ".object{display:flex;border:1px solid #ddd;border-radius:6px;overflow:hidden;"
    "break-inside:avoid}"
    ".photo{flex:0 0 38%;max-width:200px;background:#f3f3f3}"
    ".photo img{display:block;width:100%;height:auto}"
    ".about{flex:1;min-width:0;padding:10px 14px}"
    ".about svg{float:right;width:52px;margin-left:8px}"
    ".name{font-size:16px;overflow-wrap:anywhere}.about p{margin:2px 0 8px}"
    "a{color:#06c;text-decoration:none}a:hover{text-decoration:underline}"
    ".facts,.from{color:#555;font-size:13px}"
    ".warn,.fail{margin:4px 0;font-size:13px;line-height:1.4;overflow-wrap:anywhere}"
    ".fail{background:#fbe3e0;border-left:4px solid #c0392b;padding:4px 10px}"
    ".sum{font-size:16px}.bad{color:#b00}"
    "@media print{body{margin:0}}";

// ---------------------------------------------------------------- parts of an entry

// A name as a relative address.
static void put_address(FILE *f, const char *name)
{
    fputs("./", f);
    for (; *name; name++)
        if (isalnum((unsigned char)*name) || strchr("-._~", *name))
            putc(*name, f);
        else
            fprintf(f, "%%%02X", (unsigned char)*name);
    fputs("/report.html", f);
}

// The photograph whose light comes from the upper left, as in catalogues.
static int choose_photograph(const struct relume_acquisition *a)
{
    const vec3 wanted = {-0.5, 0.5, 0.7};
    int best = 0;
    for (int i = 1; i < a->lights; i++)
        if (vec3_dot(a->direction[i], wanted) > vec3_dot(a->direction[best], wanted))
            best = i;
    return best;
}

static relume_status put_photograph(FILE *f, const struct relume_captured_object *o,
                                    const char *scratch, const struct relume_log *log)
{
    const struct relume_log quiet = {.context = log ? log->context : NULL, .leave_unnoted = true};
    struct relume_image image = {0};
    relume_capture *capture;
    relume_status status =
        relume_capture_open(&capture, o->path, relume_capture_params(.log = &quiet));
    if (!status)
        status = relume_capture_image(&image, capture, 0, choose_photograph(&o->capture), &quiet);
    if (!status)
        status = report_picture(f, scratch, &image, PICTURE, report_gain(&image), LOOK_LIGHT, log);
    relume_image_destroy(&image);
    relume_capture_destroy(&capture);
    return status;
}

// The lights as they would shine in a ball, seen from the camera.
static void put_lights(FILE *f, const struct relume_acquisition *a)
{
    fputs("<svg viewBox=\"-26 -26 52 52\"><title>the lights as seen from the camera</title>"
          "<circle r=\"25\" fill=\"#f6f6f6\" stroke=\"#bbb\"/>",
          f);
    for (int i = 0; i < a->lights; i++)
        fprintf(f, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"1.7\" fill=\"#036\"/>",
                24.0 * a->direction[i].x, -24.0 * a->direction[i].y);
    fputs("</svg>", f);
}

static void put_facts(FILE *f, const struct relume_acquisition *a)
{
    fprintf(f, "<p class=\"facts\">%d %slights", a->lights, a->position ? "near " : "");
    if (a->direction_error_deg > 0.0)
        fprintf(f, ", directions to about %.2f&#176;", a->direction_error_deg);
    if (a->position_error > 0.0)
        fprintf(f, ", positions to about %.1f %%", 100.0 * a->position_error);
    fprintf(f, "<br>%d x %d pixels", a->width, a->height);
    if (a->left_out)
        fprintf(f, "<br><span class=\"bad\">%d photograph%s left out</span>", a->left_out,
                relume_plural(a->left_out));
    fputs("</p>", f);
}

// A sentence, in which files of the object go without their folder.
static void put_sentence(FILE *f, const struct relume_captured_object *o, const char *text)
{
    char *folder = *o->photographs ? mem_format("%s/", o->photographs) : NULL;
    for (const char *at; folder && (at = strstr(text, folder)); text = at + strlen(folder)) {
        char *before = mem_format("%.*s", (int)(at - text), text);
        markup_text(f, before);
        mem_free(before);
    }
    markup_text(f, text);
    mem_free(folder);
}

// Compares texts without their numbers.
static bool is_alike(const char *a, const char *b)
{
    static const char numbers[] = "0123456789.";
    do {
        a += strspn(a, numbers);
        b += strspn(b, numbers);
        if (*a != *b)
            return false;
    } while (*a++ && *b++);
    return true;
}

// Returns the number of warnings from `i` on that differ from it by numbers alone; 0: an earlier
// one does.
static int count_alike(const struct relume_acquisition *a, int i)
{
    int count = 0;
    for (int k = 0; k < a->warnings; k++)
        if (is_alike(a->warning[k], a->warning[i])) {
            if (k < i)
                return 0;
            count++;
        }
    return count;
}

static void put_more(FILE *f, const struct relume_captured_object *o, int more)
{
    fputs("<div class=\"warn\"><a href=\"", f);
    put_address(f, o->name);
    fprintf(f, "\">and %d more</a></div>", more);
}

static void put_warnings(FILE *f, const struct relume_captured_object *o)
{
    const struct relume_acquisition *a = &o->capture;
    int shown = 0, said = 0;
    if (!a->warnings && !o->reason)
        fputs("<div class=\"good\">no warnings</div>", f);
    for (int i = 0; i < a->warnings && shown < WARNINGS; i++) {
        const int alike = count_alike(a, i);
        if (!alike)
            continue;
        fputs("<div class=\"warn\">", f);
        put_sentence(f, o, a->warning[i]);
        if (alike > 1)
            fprintf(f, " <b>(%d like this)</b>", alike);
        fputs("</div>", f);
        shown++;
        said += alike;
    }
    if (a->warnings > said)
        put_more(f, o, a->warnings - said);
}

// ---------------------------------------------------------------- entries

static void put_link(FILE *f, const char *name)
{
    fputs("<b class=\"name\"><a href=\"", f);
    put_address(f, name);
    fputs("\">", f);
    markup_text(f, name);
    fputs("</a></b>", f);
}

static relume_status put_entry(FILE *f, const struct relume_captured_object *o, const char *scratch,
                               const struct relume_log *log)
{
    fputs("<section class=\"object\"><a class=\"photo\" href=\"", f);
    put_address(f, o->name);
    fputs("\">", f);
    const relume_status status = put_photograph(f, o, scratch, log);
    fputs("</a>\n<div class=\"about\">", f);
    put_lights(f, &o->capture);
    put_link(f, o->name);
    put_facts(f, &o->capture);
    if (o->reason) {
        fputs("<div class=\"fail\">", f);
        put_sentence(f, o, o->reason);
        fputs("</div>", f);
    }
    put_warnings(f, o);
    fputs("</div></section>\n", f);
    return status;
}

static void put_failure(FILE *f, const struct relume_captured_object *o)
{
    fputs("<div class=\"fail\"><b class=\"name\">", f);
    markup_text(f, o->name);
    fputs("</b> <span class=\"from\">", f);
    markup_text(f, o->photographs);
    fputs("</span><br>", f);
    put_sentence(f, o, o->reason);
    fputs("</div>\n", f);
}

// An entry may lack its picture.
char *object_entry(const struct relume_captured_object *object, const char *scratch,
                   const struct relume_log *log)
{
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    relume_status status = RELUME_OK;
    if (!f)
        return NULL;
    if (object->capture.lights)
        status = put_entry(f, object, scratch, log);
    else
        put_failure(f, object);
    if (!fclose(f) && status != RELUME_ENOMEM)
        return mem_take(text);
    mem_free_libc(text);
    return NULL;
}

// ---------------------------------------------------------------- the page

struct counts {
    int there, failed, waiting, warned;
};

static struct counts count(const struct relume_captured_objects *objects)
{
    struct counts c = {0};
    for (int i = 0; i < objects->count; i++) {
        const struct relume_captured_object *o = &objects->object[i];
        c.there += o->status == RELUME_OK;
        c.waiting += o->status == RELUME_ECANCEL;
        c.failed += o->status != RELUME_OK && o->status != RELUME_ECANCEL;
        c.warned += o->capture.warnings > 0;
    }
    return c;
}

static void put_counts(FILE *f, const struct relume_captured_objects *objects)
{
    const struct counts c = count(objects);
    fprintf(f, "<h1>Captures of %d object%s</h1>\n<p class=\"sum\">", objects->count,
            relume_plural(objects->count));
    fprintf(f, c.there == objects->count ? "<span class=\"good\">all are made</span>" : "%d made",
            c.there);
    if (c.failed)
        fprintf(f, ", <span class=\"bad\">%d failed</span>", c.failed);
    if (c.waiting)
        fprintf(f, ", %d not yet: the same command makes them", c.waiting);
    if (c.warned)
        fprintf(f, ", %d with warnings", c.warned);
    fputs("</p>\n", f);
}

// Puts the entries of objects with captures, or without them, under a title.
static void put_entries(FILE *f, const struct relume_captured_objects *objects, char *const *entry,
                        bool captured, const char *title)
{
    int n = 0;
    for (int i = 0; i < objects->count; i++) {
        if (!entry[i] || (objects->object[i].capture.lights > 0) != captured)
            continue;
        if (!n++)
            fprintf(f, "<h2>%s</h2>\n", title);
        if (n == 1 && captured)
            fputs("<div class=\"objects\">\n", f);
        fputs(entry[i], f);
    }
    if (n && captured)
        fputs("</div>\n", f);
}

static void print_page(const void *context, FILE *f)
{
    const struct objects_page *page = context;
    char **const earlier = page->entry + page->objects->count;
    fprintf(f,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">%s<meta "
            "name=\"viewport\" content=\"width=device-width\"><title>captures of %d object%s"
            "</title><style>%s%s</style></head><body>\n",
            generator, page->objects->count, relume_plural(page->objects->count), markup_style,
            style);
    put_counts(f, page->objects);
    put_entries(f, page->objects, page->entry, false, "Not made");
    put_entries(f, page->objects, page->entry, true, "Objects");
    put_entries(f, page->earlier, earlier, true, "Made earlier in this folder");
    fputs("<p class=\"from\">Made by relume " RELUME_VERSION ".</p>\n</body></html>\n", f);
}

relume_status objects_page_write(const struct objects_page *page, const struct relume_log *log)
{
    char *path = mem_format("%s/report.html", page->dir);
    const relume_status status =
        path ? relume_file_print(path, print_page, page, log) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

relume_status objects_page_check(const char *dir, const struct relume_log *log)
{
    const struct relume_log quiet = {.context = log ? log->context : NULL, .leave_unnoted = true};
    char *path = mem_format("%s/report.html", dir), start[512] = "";
    if (!path)
        return RELUME_ENOMEM;
    FILE *f = input_open(path, &quiet);
    const bool absent = !f && errno == ENOENT;
    const size_t n = f ? fread(start, 1, sizeof start - 1, f) : 0;
    start[n] = '\0';
    if (f)
        fclose(f);
    const relume_status status =
        absent || strstr(start, generator)
            ? RELUME_OK
            : log_fail(log, RELUME_EINVAL,
                       "%s: is no page of relume's captures, and would be replaced; expected "
                       "another folder",
                       path);
    mem_free(path);
    return status;
}
