// fuzz_volume.c - volumes made of noise (NRRD, NIfTI-1, raw samples, slices; packed or not); of
// what is accepted a surface is made, whose numbers must be finite
#include "fuzz.h"

#include "core/base/memory.h"

#include <math.h>
#include <relume/shape/volume.h>
#include <sys/stat.h>
#include <zlib.h>

// Beyond this memory there is none: scratch files would be as large as their sizes say.
static const struct relume_limits limits = {
    .max_side = 64, .max_pixels = 4096, .max_memory = 1 << 20};

static const char *const words[] = {"NRRD0004\n",
                                    "type: ",
                                    "uchar",
                                    "short",
                                    "ushort",
                                    "float",
                                    "double",
                                    "int",
                                    "dimension: ",
                                    "sizes: ",
                                    "spacings: ",
                                    "endian: ",
                                    "big",
                                    "little",
                                    "encoding: ",
                                    "raw",
                                    "gzip",
                                    "byte skip: ",
                                    "-1",
                                    "line skip: ",
                                    "data file: ",
                                    "samples.raw",
                                    "3 4 2",
                                    "65536",
                                    "18446744073709551615",
                                    "nan",
                                    "space directions: ",
                                    "(1,0,0)",
                                    "n+1",
                                    "ni1",
                                    "\x1f\x8b",
                                    "\n\n",
                                    NULL};

enum { NRRD, NIFTI, RAW, SLICE, BARE, KINDS };
static const char *const names[KINDS] = {"input.nrrd", "input.nii", "input.raw", "slices/b.png",
                                         "input.hdr"};
enum { COUNT = 3 * 4 * 2 };

static void look(const relume_volume *v)
{
    struct relume_mesh mesh;
    const struct relume_volume_info info = relume_volume_info(v);
    if (!isfinite(info.min) || !isfinite(info.max) || !(info.min < info.max))
        abort();
    for (int c = 0; c < 3; c++)
        if (info.size[c] < 2 || !(info.spacing[c] > 0.0 && isfinite(info.spacing[c])))
            abort();
    // thresholds go to 1e38, samples as far as floats do
    const double middle = fmin(fmax(0.5 * (double)info.min + 0.5 * (double)info.max, -1e38), 1e38);
    mem_fail_after(0);
    if (relume_isosurface(&mesh, NULL, v, middle,
                          relume_isosurface_params(.threads = 1, .blocks = {2})))
        abort();
    for (size_t i = 0; i < mesh.vertex_count; i++)
        for (int c = 0; c < 3; c++)
            if (!isfinite(mesh.position[i][c]) || !isfinite(mesh.normal[i][c]))
                abort();
    relume_mesh_free(&mesh);
}

// The first byte says what the input is, and how it is read.
static bool one(struct fuzz *f, struct bytes b)
{
    char path[128], scratch[128];
    const size_t kind = b.data[0] % KINDS, type = b.data[0] / KINDS % 14;
    relume_volume *v;
    snprintf(path, sizeof path, "%s/%s", f->folder, names[kind]);
    snprintf(scratch, sizeof scratch, "%s/none", f->folder);
    fuzz_store(path, (struct bytes){b.data + 1, b.size - 1});
    if (kind == SLICE)
        snprintf(path, sizeof path, "%s/slices", f->folder);
    const relume_status status = relume_volume_open(
        &v, path,
        relume_volume_params(.limits = &limits, .size = {3, 4, 2},
                             .type = relume_volume_types[type], .skip = b.data[0] / 128,
                             .own_spacing = true, .scratch = scratch));
    if (!status)
        look(v);
    relume_volume_destroy(&v);
    return !status;
}

static void add(struct fuzz *f, size_t kind, const void *bytes, size_t size)
{
    struct bytes b = {malloc(size + 1), size + 1};
    if (!b.data)
        abort();
    b.data[0] = (uint8_t)kind;
    memcpy(b.data + 1, bytes, size);
    fuzz_add(f, b);
}

// As gzip packs it.
static struct bytes packed(const void *bytes, size_t size)
{
    z_stream z = {.next_in = (uint8_t *)(uintptr_t)bytes, .avail_in = (unsigned)size};
    struct bytes b = {malloc(size + 128), size + 128};
    if (!b.data || deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        abort();
    z.next_out = b.data;
    z.avail_out = (unsigned)b.size;
    if (deflate(&z, Z_FINISH) != Z_STREAM_END)
        abort();
    b.size = z.total_out;
    deflateEnd(&z);
    return b;
}

static void add_packed(struct fuzz *f, size_t kind, const void *bytes, size_t size)
{
    const struct bytes b = packed(bytes, size);
    add(f, kind, b.data, b.size);
    free(b.data);
}

static void add_nrrd(struct fuzz *f, const char *header, const void *samples, size_t size)
{
    uint8_t file[1024];
    const size_t length = strlen(header);
    memcpy(file, header, length);
    memcpy(file + length, samples, size);
    add(f, NRRD, file, length + size);
}

static void add_nrrds(struct fuzz *f, const float samples[COUNT])
{
    const struct bytes b = packed(samples, COUNT * sizeof *samples);
    add_nrrd(f,
             "NRRD0004\n# made\ntype: float\ndimension: 3\nsizes: 3 4 2\nspacings: 1 2 0.5\n"
             "endian: little\nencoding: raw\n\n",
             samples, COUNT * sizeof *samples);
    add_nrrd(f,
             "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 4 2\nencoding: gzip\nendian: little\n"
             "space directions: (1,0,0) (0,2,0) (0,0,3)\n\n",
             b.data, b.size);
    add_nrrd(f,
             "NRRD0004\ntype: ushort\ndimension: 3\nsizes: 3 4 2\nendian: big\nencoding: raw\n"
             "byte skip: -1\ndata file: samples.raw\n",
             "", 0);
    add_nrrd(f,
             "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 4 2\nencoding: raw\nbyte skip: 7\n"
             "data file: samples.raw\n",
             "", 0);
    free(b.data);
}

// Little-endian, of 3 x 4 x 2 shorts or floats.
static void nifti_header(uint8_t h[352], int type, const char *magic)
{
    static const float one = 1.0f;
    const float offset = strcmp(magic, "n+1") ? 0.0f : 352.0f;  // a pair has its samples apart
    const int size = 348, dim[4] = {3, 3, 4, 2};
    memset(h, 0, 352);
    memcpy(h, &size, 4);
    for (int i = 0; i < 4; i++)
        h[40 + 2 * i] = (uint8_t)dim[i];
    h[70] = (uint8_t)type;
    for (int i = 1; i < 4; i++)
        memcpy(h + 76 + 4 * i, &one, 4);
    memcpy(h + 108, &offset, 4);
    memcpy(h + 112, &one, 4);
    memcpy(h + 344, magic, 4);
}

static void add_niftis(struct fuzz *f, const float samples[COUNT])
{
    uint8_t file[352 + COUNT * sizeof *samples];
    memcpy(file + 352, samples, COUNT * sizeof *samples);
    nifti_header(file, 16, "n+1");
    add(f, NIFTI, file, sizeof file);
    add_packed(f, NIFTI, file, sizeof file);
    nifti_header(file, 4, "n+1");
    file[112] = 0x10;  // a slope that is not 1
    add(f, NIFTI, file, sizeof file);
    nifti_header(file, 4, "ni1");
    add(f, BARE, file, 348);
}

// Two slices of 8 bits; the second is what becomes noise.
static void add_slices(struct fuzz *f)
{
    static const float value[2] = {0.25f, 0.75f};
    char path[128];
    struct relume_image image;
    snprintf(path, sizeof path, "%s/slices", f->folder);
    if (mkdir(path, 0700) || relume_image_create(&image, 3, 4, 1))
        abort();
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 12; i++)
            image.data[i] = value[k] + 0.01f * (float)i;
        snprintf(path, sizeof path, "%s/slices/%c.png", f->folder, 'a' + k);
        if (relume_image_save(&image, path, NULL))
            abort();
    }
    const struct bytes b = fuzz_load(path);
    add(f, SLICE, b.data, b.size);
    free(b.data);
    relume_image_destroy(&image);
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    float samples[COUNT];
    char path[128];
    for (int i = 0; i < COUNT; i++)
        samples[i] = (float)(i * 7 % 11) - 2.5f;
    const struct bytes all = {(uint8_t *)samples, sizeof samples};
    fuzz_begin(&f, "fuzz_volume", argc, argv);
    snprintf(path, sizeof path, "%s/samples.raw", f.folder);
    fuzz_store(path, all);
    snprintf(path, sizeof path, "%s/input.img", f.folder);
    fuzz_store(path, all);
    add_nrrds(&f, samples);
    add_niftis(&f, samples);
    add(&f, RAW, samples, COUNT);
    add(&f, RAW + KINDS * 10, samples, sizeof samples);
    add_packed(&f, RAW + KINDS * 4, samples, 2 * COUNT);
    add_slices(&f);
    return fuzz_run(&f, argc, argv, one);
}
