// fuzz_pack.c - relume files made of noise: opened, read, relit, looked at from everywhere
#include "format/coder/coding.h"
#include "format/pack/views.h"
#include "relight/light/refit.h"

#include "fuzz.h"

static const struct relume_limits limits = {
    .max_side = 256, .max_pixels = 1 << 14, .max_lights = 200, .max_views = 16};

static const char *const words[] = {"relume.format",
                                    "relume.version",
                                    "relume.domain",
                                    "relume.display",
                                    "relume.storage",
                                    "relume.projection",
                                    "relume.views",
                                    "relume.uv",
                                    "relume.window",
                                    "relume.slab",
                                    "relume.pose",
                                    "relume.member",
                                    "relume.basis",
                                    "relume.coefficients",
                                    "relume.hemispherical",
                                    "relume.ridge",
                                    "relume.lights",
                                    "relume.transform",
                                    "relume.mean",
                                    "relume.colour",
                                    "relume.interpolant",
                                    "relume.parameter",
                                    "relume.scale",
                                    "relume.offset",
                                    "relume.coding",
                                    "relume.books",
                                    "relume.book",
                                    "relume.first",
                                    "relume.last",
                                    "book0",
                                    "view0000.book0",
                                    "av1",
                                    "chroma",
                                    "luma",
                                    "channels",
                                    "dataWindow",
                                    "displayWindow",
                                    "chunkCount",
                                    "compression",
                                    "view0000",
                                    "view0001.depth",
                                    "view0000.shadows",
                                    "view0000.highlights",
                                    "type",
                                    "lineOrder",
                                    "floatvector",
                                    "planar",
                                    "slab",
                                    "cube",
                                    "spherical",
                                    "display",
                                    "linear",
                                    "table",
                                    "ptm",
                                    "hsh",
                                    "dct",
                                    "pca",
                                    "eigen",
                                    "luminance",
                                    "chord",
                                    "natural",
                                    "octahedral",
                                    "colour.R",
                                    "scanlineimage",
                                    "c0000.R",
                                    NULL};

static void use(relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_light lights[2] = {{.direction = {0.1, 0.2, -0.9}, .rgb = {1, 1, 1}},
                                           {.direction = {0, 1, 0}, .rgb = {1, 0, 2}}};
    const struct relume_camera cameras[] = {
        {.framing = RELUME_FRAME_DEFAULT},
        {.framing = RELUME_FRAME_EYE, .eye = {0.5, 0.1, 3.0}, .width = 7, .height = 5},
        {.framing = RELUME_FRAME_EYE,
         .eye = {0.5, 0.1, 3.0},
         .look_at = {.field_of_view_deg = 40.0},
         .width = 7,
         .height = 5},
        {.framing = RELUME_FRAME_LOOK, .width = 9, .height = 4, .look = {30.0, 20.0, 1.5}},
    };
    for (int v = 0; v < info->views; v++) {
        struct relume_image plane;
        if (!relume_pack_depth(&plane, pack, v))
            relume_image_destroy(&plane);
        if (!relume_pack_mask(&plane, pack, v))
            relume_image_destroy(&plane);
        if (!relume_pack_shadow(&plane, pack, v))
            relume_image_destroy(&plane);
        if (!relume_pack_gloss(&plane, pack, v))
            relume_image_destroy(&plane);
        const struct relume_codes *codes;
        double rgb[3];
        if (!relume_pack_codes(&codes, pack, v))
            relume_relight_pixel(rgb, codes, codes->width - 1, codes->height - 1, lights, 2);
    }
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        struct relume_image frame;
        if (!relume_frame(&frame, pack, &cameras[i], lights, 2, relume_frame_params(.threads = 1)))
            relume_image_destroy(&frame);
    }
    struct relume_rect all = {0};
    struct relume_codes_part part;
    struct relume_image depth;
    relume_pack_level_size(&all.width, &all.height, pack, info->levels);
    if (!relume_pack_codes_level(&part, pack, 0, info->levels, &all))
        relume_codes_part_destroy(&part);
    if (!relume_pack_depth_level(&depth, pack, 0, info->levels))
        relume_image_destroy(&depth);
    float rgb[3];
    (void)!relume_query(rgb, pack, (struct relume_vec3){0.2, 0.1, 3.0},
                        (struct relume_vec3){0.0, 0.1, -1.0}, lights, 1, NULL);
}

static bool one(struct fuzz *f, struct bytes b)
{
    const struct relume_reader reader = relume_memory_reader(b.data, b.size);
    relume_pack *pack;
#ifndef RELUME_LIBFUZZER  // which keeps what fails itself
    fuzz_store(f->path, b);
#endif
    if (relume_pack_open(&pack, f->path,
                         relume_pack_params(.limits = &limits, .threads = 1, .reader = &reader)))
        return false;
    use(pack);
    relume_pack_destroy(&pack);
    return true;
}

static void add_with(struct fuzz *f, const struct fixture *fixture,
                     const struct relume_basis *basis, const struct relume_coder_params *how,
                     enum relume_storage storage, enum relume_compression compression)
{
    fixture_write(fixture, f->folder);
    fixture_must(fixture_encode_with(
                     f->folder, f->path, basis, how,
                     relume_pack_encode_params(.storage = storage, .compression = compression)),
                 "encode");
    fuzz_add(f, fuzz_load(f->path));
}

static void add_books(struct fuzz *f, const struct fixture *fixture, bool share,
                      const struct relume_books_params *books, enum relume_storage storage)
{
    fixture_write(fixture, f->folder);
    fixture_must(
        fixture_encode(f->folder, f->path, &relume_basis_sh, 4,
                       relume_pack_encode_params(.storage = storage, .books = books, .share = share,
                                                 .compression = RELUME_COMPRESS_NONE)),
        "encode");
    fuzz_add(f, fuzz_load(f->path));
}

static void add_coded(struct fuzz *f, const struct fixture *fixture,
                      const struct relume_basis *basis, int coefficients)
{
    fixture_write(fixture, f->folder);
    fixture_must(fixture_encode(f->folder, f->path, basis, coefficients,
                                relume_pack_encode_params(.psnr_db = 25.0, .threads = 1)),
                 "encode");
    fuzz_add(f, fuzz_load(f->path));
}

// Shadows that move where there is depth, else highlights; with loss, or without.
static void add_moving(struct fuzz *f, const struct fixture *fixture, double psnr_db)
{
    struct relume_image gloss;
    fixture_must(
        relume_image_create(&gloss, fixture->width, fixture->height, RELUME_GLOSS_CHANNELS),
        "gloss");
    for (int i = 0; i < fixture->width * fixture->height; i++)
        for (int c = 0; c < RELUME_GLOSS_CHANNELS; c++)
            gloss.data[RELUME_GLOSS_CHANNELS * i + c] = (float)(i % 7 + c) / 20.0f;
    fixture_write(fixture, f->folder);
    fixture_must(fixture_encode(f->folder, f->path, &relume_basis_table, 0,
                                relume_pack_encode_params(.psnr_db = psnr_db, .threads = 1,
                                                          .shadows = fixture->depth,
                                                          .gloss = fixture->depth ? NULL : &gloss)),
                 "encode");
    fuzz_add(f, fuzz_load(f->path));
    relume_image_destroy(&gloss);
}

static void add_pyramid(struct fuzz *f, const struct fixture *fixture,
                        const struct relume_basis *basis, enum relume_compression compression)
{
    fixture_write(fixture, f->folder);
    fixture_must(fixture_encode(f->folder, f->path, basis, 4,
                                relume_pack_encode_params(.pyramid = RELUME_PYRAMID_YES,
                                                          .compression = compression)),
                 "encode");
    fuzz_add(f, fuzz_load(f->path));
}

static void add(struct fuzz *f, const struct fixture *fixture, const struct relume_basis *basis,
                int coefficients, enum relume_storage storage, enum relume_compression compression)
{
    add_with(f, fixture, basis, relume_coder_params(.coefficients = coefficients), storage,
             compression);
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    const struct fixture plain = {.width = 9, .height = 40, .lights = 6, .views = 1};
    const struct fixture slab = {.width = 8,
                                 .height = 5,
                                 .lights = 5,
                                 .views = 3,
                                 .hemisphere = true,
                                 .depth = true,
                                 .mask = true};
    const struct fixture tall = {
        .width = 3, .height = 141, .lights = 5, .views = 1, .depth = true, .mask = true};
    const struct fixture around = {
        .width = 8, .height = 5, .lights = 5, .views = 6, .slabs = 3, .depth = true};
    fuzz_begin(&f, "fuzz_pack", argc, argv);
    add(&f, &around, &relume_basis_sh, 4, RELUME_STORE_8, RELUME_COMPRESS_NONE);
    add(&f, &plain, &relume_basis_sh, 4, RELUME_STORE_8, RELUME_COMPRESS_PIZ);
    add(&f, &plain, &relume_basis_table, 0, RELUME_STORE_16, RELUME_COMPRESS_ZIP);
    add(&f, &slab, &relume_basis_sh, 4, RELUME_STORE_HALF, RELUME_COMPRESS_RLE);
    add(&f, &slab, &relume_basis_table, 0, RELUME_STORE_8, RELUME_COMPRESS_NONE);
    add(&f, &plain, &relume_basis_pca, 4, RELUME_STORE_10, RELUME_COMPRESS_NONE);
    add(&f, &slab, &relume_basis_hsh, 4, RELUME_STORE_12, RELUME_COMPRESS_NONE);
    add(&f, &plain, &relume_basis_dct, 5, RELUME_STORE_8, RELUME_COMPRESS_NONE);
    add_with(&f, &slab, &relume_basis_ptm, relume_coder_params(.luminance = true), RELUME_STORE_8,
             RELUME_COMPRESS_NONE);
    add_with(&f, &slab, &relume_basis_table,
             relume_coder_params(.interpolant = relume_interpolant_find("natural")), RELUME_STORE_8,
             RELUME_COMPRESS_NONE);
    add_books(&f, &plain, false, relume_books_params(.codes = 5, .stages = 2), RELUME_STORE_8);
    add_books(&f, &slab, true, relume_books_params(.codes = 7, .split = RELUME_SPLIT_LUMA),
              RELUME_STORE_12);
    add_books(&f, &slab, false, relume_books_params(.codes = 3, .split = RELUME_SPLIT_PRODUCT),
              RELUME_STORE_HALF);
    add_pyramid(&f, &tall, &relume_basis_pca, RELUME_COMPRESS_NONE);
    add_pyramid(&f, &tall, &relume_basis_sh, RELUME_COMPRESS_PIZ);
    add_coded(&f, &plain, &relume_basis_table, 0);
    add_coded(&f, &slab, &relume_basis_pca, 4);
    add_moving(&f, &plain, 0.0);
    add_moving(&f, &plain, 25.0);
    add_moving(&f, &slab, 0.0);
    add_moving(&f, &slab, 25.0);
    return fuzz_run(&f, argc, argv, one);
}
