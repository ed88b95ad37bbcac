// jpeg.c - the one file that knows libjpeg
#include "image/image/jpeg.h"

#include "core/base/infile.h"
#include "core/base/inputs.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"

#include <errno.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include <jpeglib.h>

#include <jerror.h>

// libjpeg's errors end here; its warnings (a truncated file, say) are errors too.
struct trap {
    struct jpeg_error_mgr manager;
    jmp_buf jump;
    char text[JMSG_LENGTH_MAX];
    relume_status status;  // when something ended here
    bool only_damage;      // only warnings of damage end here: cameras leave much that is odd
};

static void on_error(j_common_ptr info)
{
    struct trap *trap = (struct trap *)info->err;
    trap->manager.format_message(info, trap->text);
    trap->status = trap->manager.msg_code == JERR_OUT_OF_MEMORY ? RELUME_ENOMEM : RELUME_EDAMAGED;
    longjmp(trap->jump, 1);
}

// What libjpeg repairs with grey or with rows out of place. Bytes that nothing asked for are not
// among them: some cameras pad their pictures.
static bool is_damage(int code)
{
    return code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE || code == JWRN_ARITH_BAD_CODE ||
           code == JWRN_MUST_RESYNC || code == JWRN_JPEG_EOF;
}

static void on_message(j_common_ptr info, int level)
{
    const struct trap *trap = (struct trap *)info->err;
    if (level < 0 && (!trap->only_damage || is_damage(trap->manager.msg_code)))
        on_error(info);
}

static struct jpeg_error_mgr *trap_init(struct trap *trap)
{
    jpeg_std_error(&trap->manager);
    trap->manager.error_exit = on_error;
    trap->manager.emit_message = on_message;
    trap->text[0] = '\0';
    return &trap->manager;
}

// ---------------------------------------------------------------- reading pictures

struct jpeg_picture_reader {
    picture_reader reader;  // first
    struct jpeg_decompress_struct info;
    struct trap trap;
    FILE *file;
    struct infile *in;  // what it reads; belongs to it
    char *path;
    JOCTET *profile;
    unsigned profile_size;
    uint8_t *cmyk;  // a row of it, for pictures of four components
    char why[JMSG_LENGTH_MAX + 32];
};

// What Adobe's programs write, and with them everybody: 255 is no ink.
static void turn_to_rgb(uint8_t *out, const uint8_t *cmyk, size_t width)
{
    for (size_t x = 0; x < width; x++, cmyk += 4, out += 3)
        for (int c = 0; c < 3; c++)
            out[c] = (uint8_t)((cmyk[c] * cmyk[3] + 127) / 255);
}

static relume_status read_bytes(picture_reader *reader, int row, int rows, uint8_t *out)
{
    struct jpeg_picture_reader *p = (struct jpeg_picture_reader *)reader;
    const size_t width = (size_t)reader->info.width, step = width * (size_t)reader->info.channels;
    if (setjmp(p->trap.jump)) {
        snprintf(p->why, sizeof p->why, "truncated or damaged; %s", p->trap.text);
        return p->trap.status;
    }
    if (row == 0)
        jpeg_start_decompress(&p->info);
    for (int y = 0; y < rows; y++) {
        JSAMPROW to = p->cmyk ? p->cmyk : out + (size_t)y * step;
        jpeg_read_scanlines(&p->info, &to, 1);
        if (p->cmyk)
            turn_to_rgb(out + (size_t)y * step, p->cmyk, width);
    }
    if (p->info.output_scanline == p->info.output_height)
        jpeg_finish_decompress(&p->info);  // the end marker, too
    return RELUME_OK;
}

static const void *profile(const picture_reader *reader, size_t *size)
{
    const struct jpeg_picture_reader *p = (const struct jpeg_picture_reader *)reader;
    *size = p->profile_size;
    return p->profile;
}

static const char *error(const picture_reader *reader)
{
    return ((const struct jpeg_picture_reader *)reader)->why;
}

static void close(picture_reader *reader)
{
    struct jpeg_picture_reader *p = (struct jpeg_picture_reader *)reader;
    if (p->info.mem)
        jpeg_destroy_decompress(&p->info);
    if (p->file)
        fclose(p->file);
    mem_free_libc(p->profile);  // of libjpeg's own malloc
    mem_free(p->cmyk);
    mem_free(p->path);
    mem_free(p);
}

static const struct picture_format format = {
    .read_bytes = read_bytes, .profile = profile, .error = error, .close = close};

static bool has_exif(const struct jpeg_decompress_struct *info)
{
    for (const struct jpeg_marker_struct *m = info->marker_list; m; m = m->next)
        if (m->marker == JPEG_APP0 + 1 && m->data_length >= 6 && !memcmp(m->data, "Exif\0", 6))
            return true;
    return false;
}

static bool read_header(struct jpeg_picture_reader *p)
{
    struct jpeg_decompress_struct *i = &p->info;
    i->err = trap_init(&p->trap);
    p->trap.only_damage = true;
    if (setjmp(p->trap.jump))
        return false;
    jpeg_create_decompress(i);
    jpeg_stdio_src(i, p->file);
    jpeg_save_markers(i, JPEG_APP0 + 1, 6);
    jpeg_save_markers(i, JPEG_APP0 + 2, 0xffff);
    jpeg_read_header(i, TRUE);
    (void)jpeg_read_icc_profile(i, &p->profile, &p->profile_size);
    const int planes = i->num_components == 1 ? 1 : 3, last = planes - 1;
    i->out_color_space = planes == 1 ? JCS_GRAYSCALE : i->num_components == 4 ? JCS_CMYK : JCS_RGB;
    i->dct_method = JDCT_ISLOW;
    p->reader = (picture_reader){.format = &format,
                                 .info = {.width = (int)i->image_width,
                                          .height = (int)i->image_height,
                                          .channels = planes,
                                          .rgb = {0, last / 2, last},
                                          .bytes = true},
                                 .exif = !p->in->from.read && has_exif(i) ? p->in : NULL,
                                 .path = p->path};
    return true;
}

relume_status jpeg_picture_open(picture_reader **out, const char *path,
                                const struct relume_reader *from,
                                const struct relume_limits *limits, const struct relume_log *log)
{
    struct jpeg_picture_reader *p = mem_zeroed(1, sizeof *p);
    *out = NULL;
    if (!p || !(p->path = mem_text(path))) {
        mem_free(p);
        return RELUME_ENOMEM;
    }
    const struct picture_info *info = &p->reader.info;
    relume_status status = RELUME_OK;
    p->file = infile_stream(&p->in, path, from, log);
    if (!p->file)
        status = relume_input_fail(log, path, "cannot be opened", errno);
    else if (!read_header(p))
        status = p->trap.status == RELUME_ENOMEM
                     ? RELUME_ENOMEM
                     : log_fail(log, RELUME_EDAMAGED, "%s: not a readable image; %s", path,
                                p->trap.text);
    else
        status = limits_picture(limits, path, info->width, info->height, log);
    if (!status && p->info.num_components == 4 && !(p->cmyk = mem_array((size_t)info->width, 4)))
        status = RELUME_ENOMEM;
    if (status)
        close(&p->reader);
    else
        *out = &p->reader;
    return status;
}

// ---------------------------------------------------------------- reading codes

struct reader {
    struct jpeg_decompress_struct info;
    struct trap trap;
    struct jpeg_codes *out;
    uint8_t *row;
    const struct relume_limits *limits;
    char why[JMSG_LENGTH_MAX];
};

static bool refuse(struct reader *r, const char *why)
{
    snprintf(r->why, sizeof r->why, "%s", why);
    return false;
}

static bool check_header(struct reader *r)
{
    struct jpeg_decompress_struct *i = &r->info;
    const struct relume_limits limits = limits_or_default(r->limits);
    if (!limits_allow(&limits, i->image_width, i->image_height))
        return refuse(r, "larger than the limits");
    if (i->num_components != 1 && i->num_components != 3)
        return refuse(r, "expected 1 or 3 components");
    i->out_color_space = i->num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    i->dct_method = JDCT_ISLOW;
    i->mem->max_memory_to_use = 1L << 30;
    return true;
}

static void read_rows(struct reader *r)
{
    struct jpeg_codes *out = r->out;
    const size_t width = (size_t)out->width, planes = (size_t)out->planes;
    const size_t size = width * (size_t)out->height;
    while (r->info.output_scanline < r->info.output_height) {
        uint8_t *to = out->data + (size_t)r->info.output_scanline * width;
        JSAMPROW row = r->row;
        jpeg_read_scanlines(&r->info, &row, 1);
        for (size_t x = 0; x < width; x++)
            for (size_t p = 0; p < planes; p++)
                to[p * size + x] = row[planes * x + p];
    }
}

// Everything that lives across the jump is in `r`.
static bool read_all(struct reader *r, const void *bytes, size_t size)
{
    r->info.err = trap_init(&r->trap);
    if (setjmp(r->trap.jump))
        return refuse(r, r->trap.status == RELUME_ENOMEM ? "" : r->trap.text);
    jpeg_create_decompress(&r->info);
    jpeg_mem_src(&r->info, bytes, (unsigned long)size);
    jpeg_read_header(&r->info, TRUE);
    if (!check_header(r))
        return false;
    jpeg_start_decompress(&r->info);
    r->out->width = (int)r->info.output_width;
    r->out->height = (int)r->info.output_height;
    r->out->planes = r->info.output_components;
    const size_t row = (size_t)r->out->width * (size_t)r->out->planes;
    r->row = mem_array(row, 1);
    r->out->data = mem_array((size_t)r->out->height, row);
    if (!r->row || !r->out->data)
        return refuse(r, "");
    read_rows(r);
    jpeg_finish_decompress(&r->info);
    return true;
}

relume_status jpeg_decode(struct jpeg_codes *out, const void *bytes, size_t size, const char *name,
                          const struct relume_limits *limits, const struct relume_log *log)
{
    *out = (struct jpeg_codes){0};
    if (size == 0)
        return log_fail(log, RELUME_EFORMAT, "%s: empty; expected a JPEG file", name);
    struct reader *r = mem_zeroed(1, sizeof *r);
    if (!r)
        return RELUME_ENOMEM;
    r->out = out;
    r->limits = limits;
    const bool good = read_all(r, bytes, size);
    if (r->info.mem)
        jpeg_destroy_decompress(&r->info);
    mem_free(r->row);
    relume_status status = RELUME_OK;
    if (!good) {
        jpeg_codes_free(out);
        status = r->why[0]
                     ? log_fail(log, RELUME_EDAMAGED,
                                "%s: not a whole JPEG file of 1 or 3 components; %s", name, r->why)
                     : RELUME_ENOMEM;
    }
    mem_free(r);
    return status;
}

relume_status jpeg_read(struct jpeg_codes *out, const char *path,
                        const struct relume_limits *limits, const struct relume_log *log)
{
    char *bytes;
    size_t size;
    *out = (struct jpeg_codes){0};
    relume_status status = input_load(&bytes, &size, path, UINT64_MAX, "a JPEG file", log);
    if (!status)
        status = jpeg_decode(out, (const uint8_t *)bytes, size, path, limits, log);
    mem_free(bytes);
    return status;
}

void jpeg_codes_free(struct jpeg_codes *codes)
{
    mem_free(codes->data);
    *codes = (struct jpeg_codes){0};
}

// ---------------------------------------------------------------- writing

// Which zigzag positions a component's AC scans hold; the DC of all components comes first.
struct script {
    int scans;
    int first[3], last[3];
};
static const struct script scripts[] = {
    {1, {1}, {63}},
    {2, {1, 6}, {5, 63}},
    {2, {1, 3}, {2, 63}},
    {2, {1, 10}, {9, 63}},
};
enum { SCRIPTS = sizeof scripts / sizeof *scripts, MOST_SCANS = 1 + 3 * 3 };

struct writer {
    struct jpeg_compress_struct info;
    struct trap trap;
    const struct jpeg_picture *picture;
    const struct script *script;
    jpeg_scan_info scan[MOST_SCANS];
    jvirt_barray_ptr array[3];
    struct jpeg_destination_mgr destination;
    uint8_t *out;
    size_t capacity, size;
};

static void grow(j_compress_ptr info)
{
    struct writer *w = info->client_data;
    const size_t capacity = w->capacity ? 2 * w->capacity : 1 << 16;
    uint8_t *out = mem_resize(w->out, capacity, 1);
    if (!out)
        longjmp(w->trap.jump, 1);
    w->destination.next_output_byte = out + w->capacity;
    w->destination.free_in_buffer = capacity - w->capacity;
    w->out = out;
    w->capacity = capacity;
}

static boolean on_full(j_compress_ptr info)
{
    grow(info);
    return TRUE;
}

static void on_end(j_compress_ptr info)
{
    struct writer *w = info->client_data;
    w->size = w->capacity - w->destination.free_in_buffer;
}

static int add_scan(struct writer *w, int at, int components, int first_component, int first,
                    int last)
{
    jpeg_scan_info *s = &w->scan[at];
    *s = (jpeg_scan_info){.comps_in_scan = components, .Ss = first, .Se = last};
    for (int i = 0; i < components; i++)
        s->component_index[i] = first_component + i;
    return at + 1;
}

static void describe_scans(struct writer *w)
{
    const int planes = w->picture->planes;
    int n = add_scan(w, 0, planes, 0, 0, 0);
    for (int c = 0; c < planes; c++)
        for (int s = 0; s < w->script->scans; s++)
            n = add_scan(w, n, 1, c, w->script->first[s], w->script->last[s]);
    w->info.scan_info = w->scan;
    w->info.num_scans = n;
}

static void describe(struct writer *w)
{
    struct jpeg_compress_struct *i = &w->info;
    const struct jpeg_picture *p = w->picture;
    i->image_width = (JDIMENSION)p->width;
    i->image_height = (JDIMENSION)p->height;
    i->input_components = p->planes;
    i->in_color_space = p->planes == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(i);
    jpeg_set_colorspace(i, p->planes == 1             ? JCS_GRAYSCALE
                           : p->colour == JPEG_PLANES ? JCS_RGB
                                                      : JCS_YCbCr);
    if (p->colour == JPEG_PLANES && !p->baseline)
        i->write_JFIF_header = FALSE;
    i->optimize_coding = TRUE;
    for (int c = 0; c < p->planes; c++) {
        unsigned table[64];
        int same = 0;  // an equal step needs no table of its own
        while (p->step[same] != p->step[c])
            same++;
        for (int k = 0; k < 64; k++)
            table[k] = (unsigned)p->step[c];
        jpeg_add_quant_table(i, same, table, 100, TRUE);
        i->comp_info[c].quant_tbl_no = same;
        i->comp_info[c].dc_tbl_no = c;
        i->comp_info[c].ac_tbl_no = c;
        i->comp_info[c].h_samp_factor = i->comp_info[c].v_samp_factor = 1;
    }
    if (!p->baseline)
        describe_scans(w);
}

static void fill(struct writer *w, int plane)
{
    // zigzag position -> row * 8 + column
    static const uint8_t natural[64] = {
        0,  1,  8,  16, 9,  2,  3,  10, 17, 24, 32, 25, 18, 11, 4,  5,  12, 19, 26, 33, 40, 48,
        41, 34, 27, 20, 13, 6,  7,  14, 21, 28, 35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23,
        30, 37, 44, 51, 58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63};
    const int across = (w->picture->width + 7) / 8, down = (w->picture->height + 7) / 8;
    const int16_t *from = w->picture->coefficients[plane];
    for (int y = 0; y < down; y++) {
        JBLOCKARRAY row = w->info.mem->access_virt_barray((j_common_ptr)&w->info, w->array[plane],
                                                          (JDIMENSION)y, 1, TRUE);
        for (int x = 0; x < across; x++, from += 64)
            for (int k = 0; k < 64; k++)
                row[0][x][natural[k]] = from[k];
    }
}

static bool write_all(struct writer *w)
{
    const struct jpeg_picture *p = w->picture;
    w->info.err = trap_init(&w->trap);
    if (setjmp(w->trap.jump))
        return false;
    jpeg_create_compress(&w->info);
    w->info.client_data = w;
    w->destination = (struct jpeg_destination_mgr){
        .init_destination = grow, .empty_output_buffer = on_full, .term_destination = on_end};
    w->info.dest = &w->destination;
    describe(w);
    for (int c = 0; c < p->planes; c++)
        w->array[c] = w->info.mem->request_virt_barray((j_common_ptr)&w->info, JPOOL_IMAGE, FALSE,
                                                       (JDIMENSION)(p->width + 7) / 8,
                                                       (JDIMENSION)(p->height + 7) / 8, 1);
    jpeg_write_coefficients(&w->info, w->array);
    for (int c = 0; c < p->planes; c++)
        fill(w, c);
    jpeg_finish_compress(&w->info);
    return true;
}

relume_status jpeg_encode(uint8_t **out, size_t *size, const struct jpeg_picture *picture)
{
    struct writer *w = mem_zeroed(1, sizeof *w);
    *out = NULL;
    *size = 0;
    bool good = w != NULL;
    for (int s = 0; good && s < (picture->baseline ? 1 : SCRIPTS); s++) {
        *w = (struct writer){.picture = picture, .script = &scripts[s]};
        good = write_all(w);
        if (w->info.mem)
            jpeg_destroy_compress(&w->info);
        if (good && (!*out || w->size < *size)) {
            mem_free(*out);
            *out = w->out;
            *size = w->size;
        } else {
            mem_free(w->out);
        }
    }
    mem_free(w);
    if (good)
        return RELUME_OK;
    mem_free(*out);
    *out = NULL;
    return RELUME_ENOMEM;
}
