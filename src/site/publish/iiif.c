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

// ---------------------------------------------------------------- addresses and words

// Returns the address of a file of the site, to be freed; NULL when memory is short.
static char *address_of(const struct site *site, const char *name, const char *what)
{
    struct text t;
    char path[192], *address = NULL;
    snprintf(path, sizeof path, "%s%s", name, what);
    if (!text_open(&t)) {
        site_put_address(t.file, site, path);
        address = text_close(&t) ? NULL : mem_text(t.bytes);
    }
    text_free(&t);
    return address;
}

static void put_address(struct jwriter *w, const char *key, const struct site *site,
                        const char *name, const char *what)
{
    char *address = address_of(site, name, what);
    if (!address)
        jfail(w, RELUME_ENOMEM);
    jput_text(w, key, address);
    mem_free(address);
}

// "id", "type" and, unless it is NULL, "format".
static void put_resource(struct jwriter *w, const struct site *site, const char *name,
                         const char *what, const char *type, const char *format)
{
    put_address(w, "id", site, name, what);
    jput_text(w, "type", type);
    if (format)
        jput_text(w, "format", format);
}

static void put_words(struct jwriter *w, const char *key, const char *language, const char *value)
{
    jopen_object(w, key);
    jopen_array(w, language);
    text_put(w, NULL, value);
    jclose_levels(w, 2);
}

// A list of one object, which is left open.
static void open_only(struct jwriter *w, const char *space, const char *key)
{
    jgap(w, space);
    jopen_array(w, key);
    jopen_object(w, NULL);
}

static void put_size(struct jwriter *w, int width, int height)
{
    jput_integer(w, "width", width);
    jput_integer(w, "height", height);
}

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
                                  struct relume_image *picture, struct jwriter *sizes,
                                  struct jwriter *factors)
{
    const int width = picture->width, height = picture->height;
    relume_status status = save_whole(site, name, "max", picture);
    for (int factor = 1; !status && factor <= MOST_FACTOR; factor *= 2) {
        const bool whole = larger_of(picture->width, picture->height) <= MOST_WHOLE;
        char size[32];
        snprintf(size, sizeof size, "%d,%d", picture->width, picture->height);
        status = save_tiles(site, name, picture, factor, width, height);
        jput_integer(factors, NULL, factor);
        if (!status && whole) {
            status = save_whole(site, name, size, picture);
            jopen_object(sizes, NULL);
            jput_integer(sizes, "width", picture->width);
            jput_integer(sizes, "height", picture->height);
            jclose(sizes);
        }
        if (larger_of(picture->width, picture->height) <= TILE / 2)
            break;
        if (!status)
            status = halve(picture);
    }
    return status;
}

static void put_tiles(struct jwriter *w, const char *factors)
{
    open_only(w, "\n  ", "tiles");
    put_size(w, TILE, TILE);
    jput_raw(w, "scaleFactors", factors);
    jclose_levels(w, 2);
}

static relume_status write_service(const struct site *site, const char *name,
                                   struct relume_image *picture)
{
    const int width = picture->width, height = picture->height;
    struct jwriter w = {.style = JSON_MARKUP}, size_list = {0}, factor_list = {0};
    jopen_array(&size_list, NULL);
    jopen_array(&factor_list, NULL);
    const relume_status status = save_pyramid(site, name, picture, &size_list, &factor_list);
    char *sizes = jtake(&size_list, NULL), *factors = jtake(&factor_list, NULL);
    if (!sizes || !factors)
        jfail(&w, RELUME_ENOMEM);
    jopen_object(&w, NULL);
    jgap(&w, "\n  ");
    jput_text(&w, "@context", "http://iiif.io/api/image/3/context.json");
    jgap(&w, "\n  ");
    put_address(&w, "id", site, name, "/iiif");
    jgap(&w, "\n  ");
    jput_text(&w, "type", "ImageService3");
    jgap(&w, "\n  ");
    jput_text(&w, "protocol", "http://iiif.io/api/image");
    jgap(&w, "\n  ");
    jput_text(&w, "profile", "level0");
    jgap(&w, "\n  ");
    jput_integer(&w, "width", width);
    jgap(&w, "\n  ");
    jput_integer(&w, "height", height);
    jgap(&w, "\n  ");
    jput_raw(&w, "sizes", sizes);
    put_tiles(&w, factors);
    jgap(&w, "\n");
    mem_free(sizes);
    mem_free(factors);
    if (!status)
        return site_save_json(site, name, "iiif/info.json", false, &w);
    jdrop(&w);
    return status;
}

// ---------------------------------------------------------------- the manifest

static void put_pair(struct jwriter *w, const char *key, const char *label, const char *value)
{
    jopen_object(w, key);
    put_words(w, "label", "en", label);
    put_words(w, "value", "none", value);
    jclose(w);
}

static void put_metadata(struct jwriter *w, const struct details *d)
{
    const struct {
        const char *label, *value;
    } rows[] = {{"Maker", d->maker}, {"Object", d->object}, {"Licence", d->licence}};
    jgap(w, "\n  ");
    jopen_array(w, "metadata");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].value)
            put_pair(w, NULL, rows[i].label, rows[i].value);
    jclose(w);
    if (d->description) {
        jgap(w, "\n  ");
        put_words(w, "summary", "none", d->description);
    }
    if (d->licence) {
        jgap(w, "\n  ");
        put_pair(w, "requiredStatement", "Licence", d->licence);
    }
}

static void put_links(struct jwriter *w, const struct site *site, const struct page *p)
{
    open_only(w, "\n  ", "thumbnail");
    put_resource(w, site, p->name, "/poster.jpg", "Image", "image/jpeg");
    put_size(w, p->poster_width, p->poster_height);
    jclose_levels(w, 2);
    open_only(w, "\n  ", "homepage");
    put_resource(w, site, p->name, ".html", "Text", "text/html");
    put_words(w, "label", "en", "The page with the moving light");
    jclose_levels(w, 2);
    open_only(w, "\n  ", "seeAlso");
    put_resource(w, site, p->name, p->object ? "/object.json" : "/scene.json",
                 p->object ? "Model" : "Dataset", "application/json");
    put_words(w, "label", "en",
              p->object ? "The relightable object (relume-web-object 1)"
                        : "Coefficient layers of the relightable image (relume-web 1)");
    jclose_levels(w, 2);
    if (!p->object)
        return;
    open_only(w, "\n  ", "rendering");
    put_resource(w, site, p->name, "/model.glb", "Model", "model/gltf-binary");
    put_words(w, "label", "en", "The object in plain light (glTF)");
    jclose_levels(w, 2);
}

static void put_notes(struct jwriter *w, const char *space, const struct site *site,
                      const struct page *p)
{
    open_only(w, space, "annotations");
    put_resource(w, site, p->name, "/iiif/notes.json", "AnnotationPage", NULL);
    jclose_levels(w, 2);
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

static void put_body(struct jwriter *w, const struct site *site, const struct page *p,
                     const struct canvas *c)
{
    jgap(w, "\n      ");
    jopen_object(w, "body");
    put_resource(w, site, p->name, c->picture, c->model ? "Model" : "Image",
                 c->model ? "model/gltf-binary" : "image/jpeg");
    if (!c->model)
        put_size(w, c->width, c->height);
    if (c->service) {
        open_only(w, "\n        ", "service");
        put_resource(w, site, p->name, "/iiif", "ImageService3", NULL);
        jput_text(w, "profile", "level0");
        jclose_levels(w, 2);
    }
    jclose(w);
}

static void put_painting(struct jwriter *w, const struct site *site, const struct page *p,
                         const struct canvas *c, const char *id)
{
    char below[64];
    open_only(w, "\n    ", "items");
    snprintf(below, sizeof below, "%s/page", id);
    put_resource(w, site, p->name, below, "AnnotationPage", NULL);
    open_only(w, NULL, "items");
    snprintf(below, sizeof below, "%s/picture", id);
    put_resource(w, site, p->name, below, "Annotation", NULL);
    jput_text(w, "motivation", "painting");
    jgap(w, "\n      ");
    put_address(w, "target", site, p->name, id);
    put_body(w, site, p, c);
    jclose_levels(w, 4);
}

static void put_canvas(struct jwriter *w, const struct site *site, const struct page *p,
                       const struct canvas *c)
{
    char id[32];
    snprintf(id, sizeof id, "/canvas/%d", c->number);
    jopen_object(w, NULL);
    put_resource(w, site, p->name, id, "Canvas", NULL);
    put_size(w, c->width, c->height);
    jgap(w, "\n    ");
    put_words(w, "label", "none", c->label);
    if (c->thumbnail) {
        open_only(w, "\n    ", "thumbnail");
        put_resource(w, site, p->name, c->model ? "/poster.jpg" : c->picture, "Image",
                     "image/jpeg");
        jclose_levels(w, 2);
    }
    put_painting(w, site, p, c, id);
    if (c->notes)
        put_notes(w, "\n    ", site, p);
    jgap(w, "\n  ");
    jclose(w);
}

// All of a manifest before its canvases.
static void begin_manifest(struct jwriter *w, const struct site *site, const struct page *p,
                           const char *name)
{
    *w = (struct jwriter){.style = JSON_MARKUP};
    jopen_object(w, NULL);
    jgap(w, "\n  ");
    jput_text(w, "@context", "http://iiif.io/api/presentation/3/context.json");
    jgap(w, "\n  ");
    put_resource(w, site, p->name, name, "Manifest", NULL);
    jgap(w, "\n  ");
    put_words(w, "label", "none", p->details.title);
    put_metadata(w, &p->details);
    put_links(w, site, p);
    jgap(w, "\n  ");
    jopen_array(w, "items");
}

// Saves the manifest below the folder of the page: `name` begins with a slash.
static relume_status end_manifest(struct jwriter *w, const struct site *site, const struct page *p,
                                  const char *name)
{
    jgap(w, "\n");
    return site_save_json(site, p->name, name + 1, false, w);
}

static relume_status write_manifest(const struct site *site, const struct page *p, int width,
                                    int height, bool notes)
{
    struct jwriter w;
    begin_manifest(&w, site, p, "/manifest.json");
    put_canvas(&w, site, p,
               &(struct canvas){.number = 1,
                                .width = width,
                                .height = height,
                                .picture = "/iiif/full/max/0/default.jpg",
                                .label = p->details.title,
                                .service = true,
                                .notes = notes});
    jclose(&w);
    return end_manifest(&w, site, p, "/manifest.json");
}

// The mesh alone: viewers that show meshes look at the first canvas.
static relume_status write_model(const struct site *site, const struct page *p)
{
    struct jwriter w;
    begin_manifest(&w, site, p, "/iiif/model.json");
    put_canvas(&w, site, p,
               &(struct canvas){.number = 1,
                                .width = POSTER_WIDTH,
                                .height = POSTER_HEIGHT,
                                .picture = "/model.glb",
                                .label = p->details.title,
                                .thumbnail = true,
                                .model = true});
    jclose(&w);
    return end_manifest(&w, site, p, "/iiif/model.json");
}

relume_status iiif_write_object(const struct site *site, const struct page *p, bool notes)
{
    struct jwriter w;
    begin_manifest(&w, site, p, "/manifest.json");
    for (int step = 0; step < TURN_STEPS; step++) {
        char picture[32] = "/poster.jpg", label[64] = "From the front";
        if (step) {
            snprintf(picture, sizeof picture, "/iiif/turn-%d.jpg", step);
            snprintf(label, sizeof label, "From %d degrees to the right", step * 360 / TURN_STEPS);
        }
        put_canvas(&w, site, p,
                   &(struct canvas){.number = step + 1,
                                    .width = step ? TURN_WIDTH : POSTER_WIDTH,
                                    .height = step ? TURN_HEIGHT : POSTER_HEIGHT,
                                    .picture = picture,
                                    .label = label,
                                    .thumbnail = true});
    }
    jclose(&w);
    if (notes)
        put_notes(&w, "\n  ", site, p);
    const relume_status written = end_manifest(&w, site, p, "/manifest.json");
    return written ? written : write_model(site, p);
}

char *iiif_target(const struct site *site, const struct page *page)
{
    return address_of(site, page->name, page->object ? "/object.json" : "/canvas/1");
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
