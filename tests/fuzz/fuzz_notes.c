// fuzz_notes.c - lists of notes made of noise; what is read comes back the same
#include "fuzz.h"

#include <math.h>
#include <relume/exchange/notes.h>

static const char *const words[] = {"AnnotationPage",
                                    "items",
                                    "target",
                                    "selector",
                                    "type",
                                    "value",
                                    "PointSelector",
                                    "SvgSelector",
                                    "FragmentSelector",
                                    "xywh=",
                                    "pixel:",
                                    "<path d='M1,2 L3,4 Z'/>",
                                    "<polygon ",
                                    "points='",
                                    "<circle ",
                                    "cx='",
                                    "transform",
                                    "relume:State",
                                    "relume:file",
                                    "relume:mmPerPixel",
                                    "WktSelector",
                                    "LINESTRING Z (",
                                    "body",
                                    "creator",
                                    "id",
                                    "1e300",
                                    "-0",
                                    "\\u0000",
                                    "nan",
                                    NULL};

static void look(const relume_notes *notes)
{
    for (int i = 0; i < relume_notes_count(notes); i++) {
        const struct relume_note *n = relume_notes_get(notes, i);
        const struct relume_note_measures m = relume_note_measure(n);
        for (int k = 0; k < n->places; k++)
            if (!isfinite(n->place[k][0]) || !isfinite(n->place[k][1]))
                abort();
        if (m.length < 0.0 || m.area < 0.0 || m.degrees < 0.0 || m.degrees > 180.0)
            abort();
    }
}

// The same text as one that the file holds itself; nothing lies beside it.
static void look_inside(const struct fuzz *f, struct bytes b)
{
    char *text = malloc(b.size + 1);
    relume_notes *notes;
    if (!text)
        return;
    if (b.size)
        memcpy(text, b.data, b.size);
    text[b.size] = 0;
    const struct relume_notes_file file = {
        .name = "a.exr", .width = 64, .height = 64, .views = 1, .inside = text};
    if (!relume_notes_open(&notes, f->path, &file, NULL))
        look(notes);
    relume_notes_destroy(&notes);
    free(text);
}

// What is written for others is read again, unless memory is short.
static void come_back(const struct fuzz *f, const relume_notes *notes,
                      const struct relume_notes_file *file)
{
    relume_notes *again = NULL;
    int added = 0;
    relume_status status = relume_notes_create(&again, file);
    if (!status)
        status = relume_notes_write(notes, f->path, RELUME_NOTES_IIIF, NULL, NULL);
    if (!status)
        status = relume_notes_import(again, f->path, &added, NULL);
    if (status != RELUME_ENOMEM && (status || added != relume_notes_count(notes)))
        abort();
    relume_notes_destroy(&again);
}

// On a picture, or on an object.
static bool import(struct fuzz *f, const struct relume_notes_file *file)
{
    relume_notes *notes;
    int added;
    relume_status status = relume_notes_create(&notes, file);
    if (status)
        return false;  // an allocation failed
    status = relume_notes_import(notes, f->path, &added, NULL);
    look(notes);
    if (!status && added)
        come_back(f, notes, file);
    relume_notes_destroy(&notes);
    return !status;
}

static bool one(struct fuzz *f, struct bytes b)
{
    const struct relume_notes_file file = {.name = "a.exr", .width = 64, .height = 64, .views = 1};
    const struct relume_notes_file object = {
        .name = "a.exr", .solid = true, .box = {{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}}};
    look_inside(f, b);
    fuzz_store(f->path, b);
    const bool picture = import(f, &file);
    fuzz_store(f->path, b);  // what came back lies there
    return import(f, &object) || picture;
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_notes", argc, argv);
    fuzz_add_text(
        &f, "{\"type\": \"AnnotationPage\", \"relume:file\": {\"width\": 64, \"height\": 64, "
            "\"views\": 1}, \"relume:mmPerPixel\": 0.5, \"items\": [{\"id\": \"n1\", \"creator\": "
            "{\"name\": \"Ann\"}, \"body\": [{\"value\": \"x\"}], \"target\": {\"selector\": "
            "{\"type\": \"PointSelector\", \"x\": 1, \"y\": 2}, \"state\": {\"type\": "
            "\"relume:State\", \"value\": \"light=dir,0,0,1\"}}}]}");
    fuzz_add_text(
        &f,
        "{\"type\": \"AnnotationPage\", \"relume:file\": {\"min\": [-1, -1, -1], \"max\": [1, 1, "
        "1]}, \"relume:mmPerUnit\": 0.5, \"items\": [{\"target\": {\"selector\": {\"type\": "
        "\"PointSelector\", \"x\": 1, \"y\": 0, \"z\": 0.5}}}, {\"target\": {\"selector\": "
        "{\"type\": "
        "\"WktSelector\", \"value\": \"POLYGON Z ((0 0 0, 1 0 0, 0 1 0, 0 0 0))\"}}}]}");
    fuzz_add_text(
        &f, "{\"type\": \"AnnotationPage\", \"items\": [{\"target\": {\"selector\": {\"type\": "
            "\"SvgSelector\", \"value\": \"<svg><path d='M1,2 l3,4 H5 v6 z'/></svg>\"}}}, "
            "{\"target\": \"c#xywh=1,2,3,4\"}, {\"target\": {\"selector\": {\"type\": "
            "\"SvgSelector\", \"value\": \"<svg><polygon points='1,2 3,4 5,6'/></svg>\"}}}]}");
    return fuzz_run(&f, argc, argv, one);
}
