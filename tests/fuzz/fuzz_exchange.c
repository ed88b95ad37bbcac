// fuzz_exchange.c - .ptm, .rti and relight folders made of noise
#include "fuzz.h"
#include "foreign_pixel.h"

#include "exchange/formats/ptm.h"
#include "exchange/formats/rti.h"
#include "exchange/formats/web.h"
#include "image/image/jpeg.h"
#include "image/image/trellis.h"

#include <relume/exchange.h>
#include <string.h>
#include <sys/stat.h>

static const struct relume_limits limits = {
    .max_side = 64, .max_pixels = 1 << 12, .max_lights = 64};

static const char *const words[] = {"PTM_1.2",
                                    "PTM_1.1",
                                    "PTM_FORMAT_RGB",
                                    "PTM_FORMAT_LRGB",
                                    "PTM_FORMAT_JPEG_RGB",
                                    "JPEG_LRGB",
                                    "\n8\n",
                                    "\n5\n",
                                    "#HSH1.2",
                                    "width",
                                    "height",
                                    "format",
                                    "type",
                                    "resolution",
                                    "colorspace",
                                    "lights",
                                    "sigma",
                                    "nplanes",
                                    "yccplanes",
                                    "basis",
                                    "materials",
                                    "scale",
                                    "bias",
                                    "range",
                                    "colorprofile",
                                    "ptm",
                                    "hsh",
                                    "sh",
                                    "rbf",
                                    "bilinear",
                                    "rgb",
                                    "lrgb",
                                    "ycc",
                                    "mrgb",
                                    "mycc",
                                    "[",
                                    "]",
                                    "{",
                                    "}",
                                    ",",
                                    "-1",
                                    "1e308",
                                    "nan",
                                    "0",
                                    NULL};

enum { W = 8, H = 5 };

static bool view(struct foreign *f, relume_status status)
{
    if (!status) {
        double *w = calloc(3 * (size_t)f->terms, sizeof *w), constant[3], rgb[3];
        const struct relume_vec3 l = {0.6, 0.0, 0.8};
        foreign_weights(f, l, w, constant);
        for (size_t i = 0; i < foreign_pixels(f); i++)
            foreign_pixel(f, i, w, constant, rgb);
        free(w);
    }
    foreign_free(f);
    return !status;
}

// What is read of a .ptm is written as JPEG planes, which read back as the writer says.
static void write_again(struct fuzz *f, const struct foreign *picture)
{
    struct ptm_jpeg file;
    struct foreign back;
    char path[128];
    snprintf(path, sizeof path, "%s/again.ptm", f->folder);
    relume_status status =
        ptm_encode_jpeg(&file, picture, 0.002 * (double)(1 + fuzz_random(f) % 200), 80, 1);
    if (status == RELUME_ENOMEM)
        return;
    fuzz_store(path, (struct bytes){file.bytes, file.size});
    status = ptm_read(&back, path, &limits, NULL);
    const size_t size = (size_t)picture->planes * foreign_pixels(picture);
    if (status != RELUME_ENOMEM && (status || memcmp(back.codes, file.codes, size) != 0))
        abort();
    foreign_free(&back);
    ptm_jpeg_free(&file);
}

static bool view_ptm(struct fuzz *f, const char *path)
{
    struct foreign picture;
    const relume_status status = ptm_read(&picture, path, &limits, NULL);
    if (!status && fuzz_random(f) % 4 == 0)
        write_again(f, &picture);
    return view(&picture, status);
}

// Every fourth input goes all the way to a relume file.
static bool import(struct fuzz *f, const char *path)
{
    char out[128];
    snprintf(out, sizeof out, "%s/out.exr", f->folder);
    return !relume_import(path, out, relume_import_params(.limits = &limits, .threads = 1));
}

static bool one(struct fuzz *f, struct bytes b)
{
    char path[128];
    struct foreign picture;
    const bool whole = fuzz_random(f) % 4 == 0;
    const uint8_t first = b.data[0];
    fuzz_store(f->path, b);
    const char *name = first == '{'    ? "web/info.json"
                       : first == 0xff ? "web/plane_0.jpg"
                       : first == '#'  ? "input.rti"
                                       : "input.ptm";
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    struct bytes before = {0};
    if (first == 0xff)
        before = fuzz_load(path);
    fuzz_store(path, b);
    if (first == 0xff)
        snprintf(path, sizeof path, "%s/web", f->folder);
    const bool accepted =
        whole                           ? import(f, path)
        : first == '{' || first == 0xff ? view(&picture, web_read(&picture, path, &limits, NULL))
        : first == '#' ? view(&picture, rti_read(&picture, path, b.size % 2, &limits, NULL))
                       : view_ptm(f, path);
    if (first == 0xff) {
        snprintf(path, sizeof path, "%s/web/plane_0.jpg", f->folder);
        fuzz_store(path, before);
        free(before.data);
    }
    return accepted;
}

static struct bytes jpeg(int planes)
{
    float plane[W * H], dct[64];
    int16_t codes[64];
    struct bytes b;
    struct jpeg_picture p = {.width = W, .height = H, .planes = planes};
    for (int i = 0; i < W * H; i++)
        plane[i] = (float)(i * 7 % 50);
    trellis_transform(plane, W, H, dct);
    trellis_quantise(dct, 1, 3.0, 0.1, codes);
    for (int c = 0; c < planes; c++) {
        p.step[c] = 3;
        p.coefficients[c] = codes;
    }
    if (jpeg_encode(&b.data, &b.size, &p))
        abort();
    return b;
}

static struct bytes text(FILE *f, struct bytes *b)
{
    fclose(f);
    return *b;
}

static struct bytes ptm(const char *format, int bytes, bool crlf)
{
    struct bytes b;
    FILE *f = open_memstream((char **)&b.data, &b.size);
    const char *end = crlf ? "\r\n" : "\n";
    fprintf(f, "PTM_1.2%sPTM_FORMAT_%s%s%d%s%d%s", end, format, end, W, end, H, end);
    fprintf(f, "1 2 0.5 1 1 1%s10 20 30 40 50 60%s", end, end);
    for (int i = 0; i < bytes * W * H; i++)
        fputc(i % 256, f);
    return text(f, &b);
}

static struct bytes jpeg_ptm(int planes)
{
    struct bytes b;
    const struct bytes one_plane = jpeg(1);
    FILE *f = open_memstream((char **)&b.data, &b.size);
    fprintf(f, "PTM_1.2\nPTM_FORMAT_JPEG_%s\n%d %d\n1 2 0.5 1 1 1\n1 2 3 4 5 6\n75\n",
            planes == 9 ? "LRGB" : "RGB", W, H);
    for (int field = 0; field < 7; field++) {
        for (int i = 0; i < planes; i++)
            fprintf(f, "%d ",
                    field == 0   ? i % 3
                    : field == 3 ? i
                    : field == 4 ? (i == 3) - 1
                    : field == 5 ? (int)one_plane.size
                    : field == 6 ? 5 * (i == 3)
                                 : 0);
        fputs("\n", f);
    }
    for (int i = 0; i < planes; i++) {
        fwrite(one_plane.data, 1, one_plane.size, f);
        if (i == 3)
            fwrite("\0\0\0\7\1", 1, 5, f);
    }
    free(one_plane.data);
    return text(f, &b);
}

static struct bytes rti(int terms)
{
    struct bytes b;
    FILE *f = open_memstream((char **)&b.data, &b.size);
    fprintf(f, "#HSH1.2\n3\n%d %d 3\n%d 2 1\n", W, H, terms);
    for (int i = 0; i < 2 * terms; i++)
        fwrite(&(float){(float)i - 2.0f}, 1, 4, f);
    for (int i = 0; i < 3 * terms * W * H; i++)
        fputc(i % 256, f);
    return text(f, &b);
}

static void column(FILE *f, const char *name, int n, const char *rest)
{
    fprintf(f, "\"%s\":[", name);
    for (int i = 0; i < n; i++)
        fprintf(f, "%s1.5", i ? "," : "");
    fprintf(f, "]%s", rest);
}

static struct bytes info(const char *type, const char *space, const char *more, int planes,
                         int basis)
{
    struct bytes b;
    FILE *f = open_memstream((char **)&b.data, &b.size);
    fprintf(
        f,
        "{\"width\":%d,\"height\":%d,\"format\":\"jpg\",\"type\":\"%s\",\"colorspace\":\"%s\",%s",
        W, H, type, space, more);
    if (basis) {
        fputs("\"basis\":[", f);
        for (int i = 0; i < (planes + 1) * basis * 3; i++)
            fprintf(f, "%s%d", i ? "," : "", i * 13 % 256);
        fputs("],", f);
    }
    fputs("\"materials\":[{", f);
    column(f, "scale", planes, ",");
    column(f, "range", planes, ",");
    column(f, "bias", planes, "}]}");
    return text(f, &b);
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    char path[128];
    fuzz_begin(&f, "fuzz_exchange", argc, argv);
    snprintf(path, sizeof path, "%s/web", f.folder);
    mkdir(path, 0777);
    for (int i = 0; i < 6; i++) {
        snprintf(path, sizeof path, "%s/web/plane_%d.jpg", f.folder, i);
        struct bytes b = jpeg(3);
        fuzz_store(path, b);
        if (i == 0)
            fuzz_add(&f, b);
        else
            free(b.data);
    }
    fuzz_add(&f, ptm("RGB", 18, false));
    fuzz_add(&f, ptm("LRGB", 9, true));
    fuzz_add(&f, jpeg_ptm(9));
    fuzz_add(&f, jpeg_ptm(18));
    fuzz_add(&f, rti(4));
    fuzz_add(&f, rti(16));
    fuzz_add(&f, info("ptm", "rgb", "\"nplanes\":18,", 18, 0));
    fuzz_add(&f, info("hsh", "lrgb", "\"nplanes\":7,\"colorprofile\":\"RGB\",", 7, 0));
    fuzz_add(&f, info("sh", "ycc", "\"nplanes\":12,", 12, 0));
    fuzz_add(&f, info("bilinear", "mrgb", "\"nplanes\":6,\"resolution\":3,", 6, 9));
    fuzz_add(&f, info("rbf", "mycc",
                      "\"yccplanes\":[2,1,1],\"sigma\":0.5,"
                      "\"lights\":[0,0,1,1,0,0,0,1,0.5],",
                      4, 3));
    // last, so that info.json is there for mutated pictures
    snprintf(path, sizeof path, "%s/web/info.json", f.folder);
    fuzz_store(path, f.seed[10]);
    return fuzz_run(&f, argc, argv, one);
}
