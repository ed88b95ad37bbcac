// fuzz_parts.c - parts of relume files made of noise: read, checked, joined alone and with sound
// ones
#include "fuzz.h"
#include "without_sums.h"

static const struct relume_limits limits = {
    .max_side = 1024, .max_pixels = 1 << 14, .max_lights = 200, .max_views = 16};

static const char *const words[] = {"relume.format",
                                    "relume.version",
                                    "relume.views",
                                    "relume.report",
                                    "relume.creator",
                                    "relume.part",
                                    "relume.part.capture",
                                    "relume.part.options",
                                    "relume.part.step",
                                    "relume.part.exact",
                                    "relume.part.measured",
                                    "relume.part.bands",
                                    "relume.part.errors",
                                    "relume.part.tiles",
                                    "relume.coding",
                                    "relume.group",
                                    "group0000",
                                    "group0001",
                                    "0 9 9 ",
                                    "relume part",
                                    "preview",
                                    "view0000",
                                    "view0000.mask",
                                    "view0001.depth",
                                    "0x1p+1 ",
                                    "floatvector",
                                    "dataWindow",
                                    "compression",
                                    "scanlineimage",
                                    NULL};

// The second part of rows, of views, of groups of views with loss, and of their tiles.
static char second[4][96];

static const char *second_of(const struct relume_pack_part *part)
{
    return second[part->tiles < part->all_tiles ? 3 : part->coded ? 2 : part->rows == 0];
}

static void join(const char *const *parts, int count)
{
    struct relume_buffer file = {0};
    const struct relume_writer writer = relume_buffer_writer(&file);
    struct relume_fidelity report;
    if (!relume_pack_join(parts, count, NULL, &report,
                          relume_pack_params(.limits = &limits, .threads = 1, .writer = &writer)) &&
        !file.size)
        abort();
    relume_buffer_destroy(&file);
}

static bool one(struct fuzz *f, struct bytes b)
{
    const struct relume_reader reader = relume_memory_reader(b.data, b.size);
    struct relume_pack_part part;
    fuzz_store(f->path, b);
    (void)!relume_pack_check(f->path, relume_pack_check_params(.limits = &limits, .threads = 1));
    if (relume_pack_part_read(&part, NULL,
                              relume_pack_params(.limits = &limits, .reader = &reader)))
        return false;
    join((const char *const[]){f->path}, 1);
    join((const char *const[]){f->path, second_of(&part)}, 2);
    return true;
}

static void add(struct fuzz *f, const struct fixture *fixture, const struct relume_basis *basis,
                int coefficients, int part, int parts, enum relume_storage storage, double psnr_db)
{
    fixture_write(fixture, f->folder);
    fixture_must(fixture_encode(f->folder, f->path, basis, coefficients,
                                relume_pack_encode_params(.storage = storage, .part = part,
                                                          .parts = parts, .psnr_db = psnr_db,
                                                          .compression = RELUME_COMPRESS_NONE)),
                 "encode");
    // what is behind a header is not looked at where its check sum says that it has changed
    struct relume_buffer old = {0};
    fixture_must(without_sums(&old, f->path), "without check sums");
    fuzz_add(f, (struct bytes){old.data, old.size});
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
    const struct fixture wide = {.width = 520, .height = 4, .lights = 5, .views = 1, .mask = true};
    struct fixture large = slab;
    large.views = 9;
    fuzz_begin(&f, "fuzz_parts", argc, argv);
    add(&f, &plain, &relume_basis_sh, 4, 2, 2, RELUME_STORE_8, 0.0);
    snprintf(second[0], sizeof second[0], "%s/rows.part", f.folder);
    fuzz_store(second[0], f.seed[0]);
    add(&f, &slab, &relume_basis_sh, 4, 2, 2, RELUME_STORE_8, 0.0);
    snprintf(second[1], sizeof second[1], "%s/views.part", f.folder);
    fuzz_store(second[1], f.seed[1]);
    add(&f, &plain, &relume_basis_sh, 4, 1, 2, RELUME_STORE_8, 0.0);
    add(&f, &slab, &relume_basis_sh, 4, 1, 2, RELUME_STORE_8, 0.0);
    add(&f, &slab, &relume_basis_table, 0, 1, 1, RELUME_STORE_HALF, 0.0);
    add(&f, &plain, &relume_basis_pca, 3, 1, 2, RELUME_STORE_12, 0.0);
    add(&f, &large, &relume_basis_sh, 4, 2, 2, RELUME_STORE_DEFAULT, 25.0);
    snprintf(second[2], sizeof second[2], "%s/groups.part", f.folder);
    fuzz_store(second[2], f.seed[f.seeds - 1]);
    add(&f, &large, &relume_basis_sh, 4, 1, 2, RELUME_STORE_DEFAULT, 25.0);
    add(&f, &wide, &relume_basis_sh, 1, 2, 2, RELUME_STORE_DEFAULT, 25.0);
    snprintf(second[3], sizeof second[3], "%s/tiles.part", f.folder);
    fuzz_store(second[3], f.seed[f.seeds - 1]);
    add(&f, &wide, &relume_basis_sh, 1, 1, 2, RELUME_STORE_DEFAULT, 25.0);
    fuzz_add(&f, fuzz_load(f.path));
    return fuzz_run(&f, argc, argv, one);
}
