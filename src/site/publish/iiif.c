// iiif.c - the same file for viewers of the International Image Interoperability Framework
#include "site/publish/iiif.h"

#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "site/publish/picture.h"
#include "site/publish/turn.h"

#include <string.h>

// Whole pictures are there up to MOST_WHOLE pixels a side, and at full size.
// Larger files are here reduced to MOST_SIDE, which lies in memory as floats.
enum { TILE = 512, MOST_WHOLE = 1024, MOST_SIDE = 8192, MOST_FACTOR = 1 << 16 };

// ---------------------------------------------------------------- the image service

static relume_status save_whole(const struct site *site, const char *name, const char *size,
                                const struct relume_image *picture)
{
    const struct relume_rect all = {0, 0, picture->width, picture->height};
    char *path = mem_format("%s/iiif/full/%s/0/default.jpg", name, size);
    const relume_status status =
        path ? picture_save_jpeg(site, path, picture, &all) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

// Tiles of a picture that is the full one, `width` x `height`, reduced by `factor`.
static relume_status save_tiles(const struct site *site, const char *name,
                                const struct relume_image *picture, int factor, int width,
                                int height)
{
    relume_status status = RELUME_OK;
    for (int top = 0; !status && top < picture->height; top += TILE)
        for (int left = 0; !status && left < picture->width; left += TILE) {
            const struct relume_rect at = {left, top, smaller_of(TILE, picture->width - left),
                                           smaller_of(TILE, picture->height - top)};
            const long x = (long)left * factor, y = (long)top * factor;
            const long w = (long)TILE * factor, h = w;
            char *path = mem_format("%s/iiif/%ld,%ld,%ld,%ld/%d,%d/0/default.jpg", name, x, y,
                                    w < width - x ? w : width - x, h < height - y ? h : height - y,
                                    at.width, at.height);
            status = path ? picture_save_jpeg(site, path, picture, &at) : RELUME_ENOMEM;
            mem_free(path);
        }
    return status;
}

static relume_status halve(struct relume_image *picture)
{
    struct relume_image half = {0};
    const relume_status status = relume_image_scale(&half, picture, (picture->width + 1) / 2,
                                                    (picture->height + 1) / 2, NULL);
    relume_image_destroy(picture);
    *picture = half;
    return status;
}

// All of the pyramid; `picture` is reduced on the way. sizes and factors for info.json.
static relume_status save_pyramid(const struct site *site, const char *name,
                                  struct relume_image *picture, FILE *sizes, FILE *factors)
{
    const int width = picture->width, height = picture->height;
    const char *between = "";
    relume_status status = save_whole(site, name, "max", picture);
    for (int factor = 1; !status && factor <= MOST_FACTOR; factor *= 2) {
        const bool whole = larger_of(picture->width, picture->height) <= MOST_WHOLE;
        char size[32];
        snprintf(size, sizeof size, "%d,%d", picture->width, picture->height);
        status = save_tiles(site, name, picture, factor, width, height);
        fprintf(factors, "%s%d", factor > 1 ? ", " : "", factor);
        if (!status && whole) {
            status = save_whole(site, name, size, picture);
            fprintf(sizes, "%s{\"width\": %d, \"height\": %d}", between, picture->width,
                    picture->height);
            between = ", ";
        }
        if (larger_of(picture->width, picture->height) <= TILE / 2)
            break;
        if (!status)
            status = halve(picture);
    }
    return status;
}

static relume_status write_service(const struct site *site, const char *name,
                                   struct relume_image *picture)
{
    const int width = picture->width, height = picture->height;
    struct text info = {0}, sizes = {0}, factors = {0};
    char path[128];
    relume_status status = text_open(&info);
    if (!status)
        status = text_open(&sizes);
    if (!status)
        status = text_open(&factors);
    if (!status)
        status = save_pyramid(site, name, picture, sizes.file, factors.file);
    if (!status)
        status = text_close(&sizes);
    if (!status)
        status = text_close(&factors);
    if (!status) {
        snprintf(path, sizeof path, "%s/iiif", name);
        fputs("{\n  \"@context\": \"http://iiif.io/api/image/3/context.json\",\n  \"id\": \"",
              info.file);
        site_put_address(info.file, site, path);
        fprintf(info.file,
                "\",\n  \"type\": \"ImageService3\",\n"
                "  \"protocol\": \"http://iiif.io/api/image\",\n  \"profile\": \"level0\",\n"
                "  \"width\": %d,\n  \"height\": %d,\n  \"sizes\": [%s],\n"
                "  \"tiles\": [{\"width\": %d, \"height\": %d, \"scaleFactors\": [%s]}]\n}\n",
                width, height, sizes.bytes, TILE, TILE, factors.bytes);
        snprintf(path, sizeof path, "%s/iiif/info.json", name);
        status = site_save_text(site, path, false, &info);
    }
    text_free(&info);
    text_free(&sizes);
    text_free(&factors);
    return status;
}

// ---------------------------------------------------------------- the manifest

// "id": "...", of something of the file.
static void put_id(FILE *f, const struct site *site, const char *name, const char *what)
{
    char path[192];
    snprintf(path, sizeof path, "%s%s", name, what);
    fputs("\"id\": \"", f);
    site_put_address(f, site, path);
    fputs("\", ", f);
}

static void put_words(FILE *f, const char *key, const char *value)
{
    fprintf(f, "\"%s\": {\"none\": [", key);
    text_json(f, value);
    fputs("]}", f);
}

static void put_pair(FILE *f, const char *label, const char *value, const char *between)
{
    fprintf(f, "%s{\"label\": {\"en\": [\"%s\"]}, ", between, label);
    put_words(f, "value", value);
    putc('}', f);
}

static void put_metadata(FILE *f, const struct details *d)
{
    const struct {
        const char *label, *value;
    } rows[] = {{"Maker", d->maker}, {"Object", d->object}, {"Licence", d->licence}};
    const char *between = "";
    fputs("  \"metadata\": [", f);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (!rows[i].value)
            continue;
        put_pair(f, rows[i].label, rows[i].value, between);
        between = ", ";
    }
    fputs("],\n", f);
    if (d->description) {
        fputs("  ", f);
        put_words(f, "summary", d->description);
        fputs(",\n", f);
    }
    if (!d->licence)
        return;
    fputs("  \"requiredStatement\": ", f);
    put_pair(f, "Licence", d->licence, "");
    fputs(",\n", f);
}

static void put_links(FILE *f, const struct site *site, const struct page *p)
{
    fputs("  \"thumbnail\": [{", f);
    put_id(f, site, p->name, "/poster.jpg");
    fprintf(f,
            "\"type\": \"Image\", \"format\": \"image/jpeg\", \"width\": %d, \"height\": %d}],\n",
            p->poster_width, p->poster_height);
    fputs("  \"homepage\": [{", f);
    put_id(f, site, p->name, ".html");
    fputs("\"type\": \"Text\", \"format\": \"text/html\", \"label\": {\"en\": [\"The page with the "
          "moving light\"]}}],\n  \"seeAlso\": [{",
          f);
    put_id(f, site, p->name, p->object ? "/object.json" : "/scene.json");
    fprintf(
        f, "\"type\": \"%s\", \"format\": \"application/json\", \"label\": {\"en\": [\"%s\"]}}],\n",
        p->object ? "Model" : "Dataset",
        p->object ? "The relightable object (relume-web-object 1)"
                  : "Coefficient layers of the relightable image (relume-web 1)");
    if (!p->object)
        return;
    fputs("  \"rendering\": [{", f);
    put_id(f, site, p->name, "/model.glb");
    fputs("\"type\": \"Model\", \"format\": \"model/gltf-binary\", \"label\": {\"en\": [\"The "
          "object in plain light (glTF)\"]}}],\n",
          f);
}

static void put_notes(FILE *f, const struct site *site, const struct page *p)
{
    fputs("\"annotations\": [{", f);
    put_id(f, site, p->name, "/iiif/notes.json");
    fputs("\"type\": \"AnnotationPage\"}]", f);
}

// What a canvas shows: a picture below the file's folder; `service`: the file's image service has
// it, too. Canvases are counted from 1.
struct canvas {
    int number, width, height;
    const char *picture, *label;
    bool service, notes;
    bool thumbnail;  // the picture itself serves as one
    bool model;      // it is no picture, but a mesh
};

static const char *body_of(const struct canvas *c)
{
    return c->model ? "\"type\": \"Model\", \"format\": \"model/gltf-binary\""
                    : "\"type\": \"Image\", \"format\": \"image/jpeg\"";
}

static void put_canvas(FILE *f, const struct site *site, const struct page *p,
                       const struct canvas *c)
{
    char id[32], below[64], whole[192];
    snprintf(id, sizeof id, "/canvas/%d", c->number);
    fprintf(f, "%s{", c->number > 1 ? ", " : "");
    put_id(f, site, p->name, id);
    fprintf(f, "\"type\": \"Canvas\", \"width\": %d, \"height\": %d,\n    ", c->width, c->height);
    put_words(f, "label", c->label);
    if (c->thumbnail) {
        fputs(",\n    \"thumbnail\": [{", f);
        put_id(f, site, p->name, c->model ? "/poster.jpg" : c->picture);
        fputs("\"type\": \"Image\", \"format\": \"image/jpeg\"}]", f);
    }
    fputs(",\n    \"items\": [{", f);
    snprintf(below, sizeof below, "%s/page", id);
    put_id(f, site, p->name, below);
    fputs("\"type\": \"AnnotationPage\", \"items\": [{", f);
    snprintf(below, sizeof below, "%s/picture", id);
    put_id(f, site, p->name, below);
    fputs("\"type\": \"Annotation\", \"motivation\": \"painting\",\n      \"target\": \"", f);
    snprintf(whole, sizeof whole, "%s%s", p->name, id);
    site_put_address(f, site, whole);
    fputs("\",\n      \"body\": {", f);
    put_id(f, site, p->name, c->picture);
    fputs(body_of(c), f);
    if (!c->model)
        fprintf(f, ", \"width\": %d, \"height\": %d", c->width, c->height);
    if (c->service) {
        fputs(",\n        \"service\": [{", f);
        put_id(f, site, p->name, "/iiif");
        fputs("\"type\": \"ImageService3\", \"profile\": \"level0\"}]", f);
    }
    fputs("}}]}]", f);
    if (c->notes) {
        fputs(",\n    ", f);
        put_notes(f, site, p);
    }
    fputs("\n  }", f);
}

// All of a manifest before its canvases.
static relume_status manifest_begin(struct text *t, const struct site *site, const struct page *p,
                                    const char *name)
{
    const relume_status status = text_open(t);
    if (status)
        return status;
    fputs("{\n  \"@context\": \"http://iiif.io/api/presentation/3/context.json\",\n  ", t->file);
    put_id(t->file, site, p->name, name);
    fputs("\"type\": \"Manifest\",\n  ", t->file);
    put_words(t->file, "label", p->details.title);
    fputs(",\n", t->file);
    put_metadata(t->file, &p->details);
    put_links(t->file, site, p);
    fputs("  \"items\": [", t->file);
    return RELUME_OK;
}

static relume_status manifest_end(struct text *t, const struct site *site, const struct page *p,
                                  const char *name)
{
    char path[128];
    fputs("\n}\n", t->file);
    snprintf(path, sizeof path, "%s%s", p->name, name);
    return site_save_text(site, path, false, t);
}

static relume_status write_manifest(const struct site *site, const struct page *p, int width,
                                    int height, bool notes)
{
    struct text t;
    const relume_status status = manifest_begin(&t, site, p, "/manifest.json");
    if (status)
        return status;
    put_canvas(t.file, site, p,
               &(struct canvas){.number = 1,
                                .width = width,
                                .height = height,
                                .picture = "/iiif/full/max/0/default.jpg",
                                .label = p->details.title,
                                .service = true,
                                .notes = notes});
    fputc(']', t.file);
    return manifest_end(&t, site, p, "/manifest.json");
}

// The mesh alone: viewers that show meshes look at the first canvas.
static relume_status write_model(const struct site *site, const struct page *p)
{
    struct text t;
    const relume_status status = manifest_begin(&t, site, p, "/iiif/model.json");
    if (status)
        return status;
    put_canvas(t.file, site, p,
               &(struct canvas){.number = 1,
                                .width = POSTER_WIDTH,
                                .height = POSTER_HEIGHT,
                                .picture = "/model.glb",
                                .label = p->details.title,
                                .thumbnail = true,
                                .model = true});
    fputc(']', t.file);
    return manifest_end(&t, site, p, "/iiif/model.json");
}

relume_status iiif_write_object(const struct site *site, const struct page *p, bool notes)
{
    struct text t;
    const relume_status status = manifest_begin(&t, site, p, "/manifest.json");
    if (status)
        return status;
    for (int step = 0; step < TURN_STEPS; step++) {
        char picture[32] = "/poster.jpg", label[64] = "From the front";
        if (step) {
            snprintf(picture, sizeof picture, "/iiif/turn-%d.jpg", step);
            snprintf(label, sizeof label, "From %d degrees to the right", step * 360 / TURN_STEPS);
        }
        put_canvas(t.file, site, p,
                   &(struct canvas){.number = step + 1,
                                    .width = step ? TURN_WIDTH : POSTER_WIDTH,
                                    .height = step ? TURN_HEIGHT : POSTER_HEIGHT,
                                    .picture = picture,
                                    .label = label,
                                    .thumbnail = true});
    }
    fputc(']', t.file);
    if (notes) {
        fputs(",\n  ", t.file);
        put_notes(t.file, site, p);
    }
    const relume_status written = manifest_end(&t, site, p, "/manifest.json");
    return written ? written : write_model(site, p);
}

char *iiif_target(const struct site *site, const struct page *page)
{
    struct text t;
    char path[128], *canvas = NULL;
    snprintf(path, sizeof path, "%s%s", page->name, page->object ? "/object.json" : "/canvas/1");
    if (!text_open(&t)) {
        site_put_address(t.file, site, path);
        canvas = text_close(&t) ? NULL : mem_text(t.bytes);
    }
    text_free(&t);
    return canvas;
}

relume_status iiif_write(const struct site *site, const struct page *page, relume_pack *pack,
                         bool notes)
{
    struct relume_image still = {0};
    const struct relume_pack_info *info = relume_pack_info(pack);
    const bool large = larger_of(info->width, info->height) > MOST_SIDE;
    relume_status status = picture_still(&still, pack, large ? MOST_SIDE : 0, false, site);
    const int width = still.width, height = still.height;
    if (!status)
        status = write_service(site, page->name, &still);
    if (!status)
        status = write_manifest(site, page, width, height, notes);
    relume_image_destroy(&still);
    return status;
}
