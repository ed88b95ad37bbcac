// ptm_write.c - .ptm files, raw
#include "exchange/formats/ptm.h"

#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "exchange/formats/ptm_parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct ptm_quantiser ptm_quantiser(double min, double max)
{
    min = fmin(min, 0.0);
    max = fmax(max, 0.0);
    if (!(max - min > 1e-6))
        return (struct ptm_quantiser){1.0, 0};
    // one code of margin, since the bias is whole
    struct ptm_quantiser q = {(max - min) / 254.0, 0};
    q.bias = relume_whole(ceil(-min / q.scale - 1e-9));
    return q;
}

// As few digits as are read back as the same number.
static void print_scale(FILE *f, float scale)
{
    char text[32];
    for (int digits = 6; digits <= 12; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, 255.0 * (double)scale);
        if ((float)(strtod(text, NULL) / 255.0) == scale)
            break;
    }
    fprintf(f, "%s ", text);
}

void ptm_print_header(const struct foreign *f, bool jpeg, FILE *out)
{
    const int copies = f->form == FOREIGN_LUMINANCE ? 1 : 3;
    fprintf(out, "PTM_1.2\nPTM_FORMAT_%s%s\n%d\n%d\n", jpeg ? "JPEG_" : "",
            copies == 1 ? "LRGB" : "RGB", f->width, f->height);
    for (int i = 0; i < PTM_TERMS; i++)
        print_scale(out, f->scale[ptm_term_of_place[i] * copies]);
    fputs("\n", out);
    for (int i = 0; i < PTM_TERMS; i++) {
        const int p = ptm_term_of_place[i] * copies;
        const double scale = (double)f->scale[p];  // 0: the term says nothing, and has no bias
        fprintf(out, "%ld ", scale != 0.0 ? lround(-(double)f->offset[p] / scale) : 0L);
    }
    fputs("\n", out);
}

static void gather(const struct foreign *f, int row, uint8_t *to, int count, const int *planes)
{
    for (int i = 0; i < count; i++) {
        const uint8_t *from = ptm_row(f, planes[i], row);
        for (size_t x = 0; x < (size_t)f->width; x++)
            to[x * (size_t)count + (size_t)i] = from[x];
    }
}

static void gather_all(const struct foreign *f, uint8_t *to)
{
    static const int colours[3] = {PTM_TERMS, PTM_TERMS + 1, PTM_TERMS + 2};
    const size_t width = (size_t)f->width;
    const bool luminance = f->form == FOREIGN_LUMINANCE;
    for (int c = 0; c < (luminance ? 1 : 3); c++) {
        int planes[PTM_TERMS];
        for (int i = 0; i < PTM_TERMS; i++)
            planes[i] = luminance ? ptm_term_of_place[i] : 3 * ptm_term_of_place[i] + c;
        for (int y = 0; y < f->height; y++, to += width * PTM_TERMS)
            gather(f, y, to, PTM_TERMS, planes);
    }
    for (int y = 0; luminance && y < f->height; y++, to += width * 3)
        gather(f, y, to, 3, colours);
}

relume_status ptm_write(const struct foreign *f, const char *path,
                        const struct relume_writer *writer, const struct relume_log *log)
{
    char *text = NULL;
    size_t text_size = 0;
    const size_t body = foreign_pixels(f) * (size_t)f->planes;
    FILE *header = open_memstream(&text, &text_size);
    if (!header)
        return RELUME_ENOMEM;
    ptm_print_header(f, false, header);
    const bool failed = fclose(header) != 0;
    uint8_t *bytes = failed ? NULL : mem_array(text_size + body, 1);
    relume_status status = RELUME_ENOMEM;
    if (bytes) {
        memcpy(bytes, text, text_size);
        gather_all(f, bytes + text_size);
        status = outfile_save_to(path, writer, bytes, text_size + body, log);
    }
    mem_free_libc(text);
    mem_free(bytes);
    return status;
}
