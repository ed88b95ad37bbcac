// picture_kind.c - what a file is by its first bytes, and which pictures are read at all
#include "image/image/picture_kind.h"

#include <string.h>
#include <strings.h>

// Each format is recognised by bytes at a place; a second place where one is not enough.
struct magic {
    struct {
        size_t at, size;
        const char *bytes;
    } part[2];
    struct picture_kind kind;
};

#define AT(place, text)                                                                            \
    {                                                                                              \
        {                                                                                          \
            place, sizeof text - 1, text                                                           \
        }                                                                                          \
    }
#define AND(at, a, place, b)                                                                       \
    {                                                                                              \
        {at, sizeof a - 1, a},                                                                     \
        {                                                                                          \
            place, sizeof b - 1, b                                                                 \
        }                                                                                          \
    }
#define OURS(what, reader, ratio)                                                                  \
    {                                                                                              \
        what, reader, true, true, ratio, NULL                                                      \
    }
#define LISTED(what, reader, ratio)                                                                \
    {                                                                                              \
        what, reader, false, true, ratio, NULL                                                     \
    }
#define OTHER(what, reader)                                                                        \
    {                                                                                              \
        what, reader, false, false, 1024, "convert it to TIFF or PNG, or try --any-format"         \
    }
#define VIDEO(what)                                                                                \
    {                                                                                              \
        what, "ffmpeg", false, false, 1024, "save its frames as PNG or TIFF"                       \
    }
#define NONE(what, advice)                                                                         \
    {                                                                                              \
        what, NULL, false, false, 1, advice                                                        \
    }
#define FTYP(brand, kind)                                                                          \
    {                                                                                              \
        AND(4, "ftyp", 8, brand), kind                                                             \
    }

// The ratios, samples counted as they are delivered: bytes, or floats of 4. JPEG: one colour takes
// 6 bits for 16 x 16 pixels of 3 channels. PNG: deflate's 1032, 16 bits become floats. TIFF: also
// LZW and fax, which do better on blank paper. Radiance, BMP, TGA: runs of at most 128 or 255. PNM:
// a bit a pixel. Wavelets, DWA in EXR and predicting coders have no bound; a picture of one colour
// comes to about 20000.
static const struct magic list[] = {
    // what relume reads itself, where plain
    {AT(0, "\x76\x2f\x31\x01"), OURS("an OpenEXR image", "openexr", 20000)},
    {AT(0, "\x89PNG\r\n\x1a\n"), OURS("a PNG image", "png", 2100)},
    {AT(0, "\xff\xd8\xff"), OURS("a JPEG image", "jpeg", 1100)},

    // what OpenImageIO reads, in a process of its own
    {AND(0, "II*\0", 8, "CR"), LISTED("a Canon RAW photograph", "raw", 200)},
    {AT(0, "II*\0"), LISTED("a TIFF image", "tiff", 5000)},
    {AT(0, "MM\0*"), LISTED("a TIFF image", "tiff", 5000)},
    {AT(0, "II+\0"), LISTED("a BigTIFF image", "tiff", 5000)},
    {AT(0, "MM\0+"), LISTED("a BigTIFF image", "tiff", 5000)},
    {AT(0, "#?RADIANCE"), LISTED("a Radiance HDR image", "hdr", 256)},
    {AT(0, "#?RGBE"), LISTED("a Radiance HDR image", "hdr", 256)},
    {AT(0, "RIFF"), LISTED("a WebP image", "webp", 20000)},  // "WEBP" is looked for, below
    {AT(0, "\0\0\0\x0cjP  \r\n\x87\n"), LISTED("a JPEG 2000 image", "jpeg2000", 20000)},
    {AT(0, "\xff\x4f\xff\x51"), LISTED("a JPEG 2000 image", "jpeg2000", 20000)},
    FTYP("avif", LISTED("an AVIF image", "heif", 20000)),
    FTYP("avis", LISTED("an AVIF image", "heif", 20000)),
    FTYP("heic", LISTED("a HEIF image", "heif", 20000)),
    FTYP("heix", LISTED("a HEIF image", "heif", 20000)),
    FTYP("heim", LISTED("a HEIF image", "heif", 20000)),
    FTYP("heis", LISTED("a HEIF image", "heif", 20000)),
    FTYP("mif1", LISTED("a HEIF image", "heif", 20000)),
    FTYP("crx ", LISTED("a Canon RAW photograph", "raw", 200)),
    {AT(0, "FUJIFILMCCD-RAW"), LISTED("a Fujifilm RAW photograph", "raw", 200)},
    {AT(0, "IIU\0"), LISTED("a Panasonic RAW photograph", "raw", 200)},
    {AT(0, "IIRO"), LISTED("an Olympus RAW photograph", "raw", 200)},
    {AT(0, "IIRS"), LISTED("an Olympus RAW photograph", "raw", 200)},
    {AT(0, "MMOR"), LISTED("an Olympus RAW photograph", "raw", 200)},
    {AND(0, "II\x1a\0", 6, "HEAPCCDR"), LISTED("a Canon RAW photograph", "raw", 200)},

    // pictures, by formats that nobody photographs in
    {AT(0, "GIF8"), OTHER("a GIF image", "gif")},
    {AT(0, "8BPS"), OTHER("a Photoshop document", "psd")},
    {AT(0, "SDPX"), OTHER("a DPX frame", "dpx")},
    {AT(0, "XPDS"), OTHER("a DPX frame", "dpx")},
    {AT(0, "\x80\x2a\x5f\xd7"), OTHER("a Cineon frame", "cineon")},
    {AT(0, "SIMPLE  ="), OTHER("a FITS file", "fits")},
    {AT(0, "FOR4"), OTHER("an IFF image", "iff")},
    {AT(0, "FORM"), OTHER("an IFF file", "iff")},
    {AT(0, "\x01\xda"), OTHER("an SGI image", "sgi")},
    {AT(0, "\x53\x80\xf6\x34"), OTHER("a Softimage picture", "softimage")},
    {AT(0, "DDS "), OTHER("a DDS texture", "dds")},
    {AT(0, "\0\0\1\0"), OTHER("an icon", "ico")},
    {AT(128, "DICM"), OTHER("a DICOM image", "dicom")},
    {AT(0, "\0\0\0\x0cJXL "), NONE("a JPEG XL image", "convert it to PNG or TIFF")},
    {AT(0, "\xff\x0a"), NONE("a JPEG XL image", "convert it to PNG or TIFF")},

    // no pictures
    {AT(4, "ftyp"), VIDEO("a video")},
    {AT(4, "moov"), VIDEO("a video")},
    {AT(4, "mdat"), VIDEO("a video")},
    {AT(0, "\x1a\x45\xdf\xa3"), VIDEO("a video")},
    {AT(0, "\0\0\1\xba"), VIDEO("a video")},
    {AT(0, "\0\0\1\xb3"), VIDEO("a video")},
    {AT(0, "FLV\1"), VIDEO("a video")},
    {AT(0, "OggS"), VIDEO("a sound or video")},
    {AT(0, "\x30\x26\xb2\x75\x8e\x66\xcf\x11"), VIDEO("a video")},
    {AT(0, "DKIF"), VIDEO("a video")},
    {AT(0, "ID3"), NONE("a sound", "give a photograph")},
    {AT(0, "fLaC"), NONE("a sound", "give a photograph")},
    {AT(0, "%PDF"), NONE("a PDF document", "save its page as PNG or TIFF")},
    {AT(0, "%!PS"), NONE("a PostScript document", "save its page as PNG or TIFF")},
    {AT(0, "PK\3\4"), NONE("a ZIP archive or an Office document", "unpack it first")},
    {AT(0, "\x1f\x8b"), NONE("a gzip archive", "unpack it first")},
    {AT(0, "7z\xbc\xaf\x27\x1c"), NONE("a 7-Zip archive", "unpack it first")},
    {AT(0, "Rar!"), NONE("a RAR archive", "unpack it first")},
    {AT(0, "\xfd"
           "7zXZ"),
     NONE("an XZ archive", "unpack it first")},
    {AT(0, "BZh"), NONE("a bzip2 archive", "unpack it first")},
    {AT(257, "ustar"), NONE("a tar archive", "unpack it first")},
    {AT(0, "\x7f"
           "ELF"),
     NONE("a program", "give a photograph")},
    {AT(0, "MZ"), NONE("a program", "give a photograph")},
    {AT(0, "glTF"), NONE("a 3D model", "give a photograph")},
    {AT(0, "PTM_"), NONE("a PTM file", "use 'relume import'")},
    {AT(0, "#HSH"), NONE("an RTI file", "use 'relume import'")},
    {AT(0, "<svg"), NONE("an SVG drawing", "save it as PNG")},
    {AT(0, "<?xml"), NONE("an XML or SVG text", "give a photograph")},
    {AT(0, "<!DOCTYPE"), NONE("a web page", "was the download refused?")},
    {AT(0, "<html"), NONE("a web page", "was the download refused?")},
};

static const struct picture_kind avi = VIDEO("a video");
static const struct picture_kind sound = NONE("a sound", "give a photograph");
static const struct picture_kind raw = LISTED("a RAW photograph", "raw", 200);
static const struct picture_kind pnm = LISTED("a PNM image", "pnm", 8);
static const struct picture_kind pfm = LISTED("a PFM image", "pnm", 8);
static const struct picture_kind bmp = LISTED("a BMP image", "bmp", 512);
static const struct picture_kind tga = LISTED("a TGA image", "targa", 256);
static const struct picture_kind unknown = {
    NULL, "", false, false, 1024, "--any-format tries all that OpenImageIO knows"};

bool picture_has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, extension) == 0;
}

static bool has(const struct picture_look *l, size_t at, size_t size, const char *bytes)
{
    return !size || (at + size <= PICTURE_HEAD && !memcmp(l->head + at, bytes, size));
}

static unsigned little(const uint8_t *b)
{
    return b[0] | (unsigned)b[1] << 8;
}

static bool is_space(uint8_t c)
{
    return c == ' ' || (c >= '\t' && c <= '\r') || c == '#';
}

// Two letters of text are little: the size of the header must be one that there is.
static bool is_bmp(const struct picture_look *l)
{
    static const uint8_t sizes[] = {12, 16, 40, 52, 56, 64, 108, 124};
    return has(l, 0, 2, "BM") && memchr(sizes, l->head[14], sizeof sizes) &&
           has(l, 15, 3, "\0\0\0");
}

// There is no magic number: the mark at the end, or a header without a wrong bit under the name.
static bool is_tga(const struct picture_look *l, const char *path)
{
    static const char mark[] = "TRUEVISION-XFILE.";
    const uint8_t *h = l->head;
    const bool map = h[1] == 1, is_map_type = h[2] == 1 || h[2] == 9;
    const bool type = (h[2] >= 1 && h[2] <= 3) || (h[2] >= 9 && h[2] <= 11);
    const uint8_t bits = h[16];
    const bool sane = h[1] <= 1 && type && map == is_map_type &&
                      (bits == 8 || bits == 15 || bits == 16 || bits == 24 || bits == 32) &&
                      little(h + 12) && little(h + 14) && h[17] < 64;
    return sane && (!memcmp(l->foot, mark, sizeof mark) || picture_has_extension(path, ".tga") ||
                    picture_has_extension(path, ".tpic"));
}

bool picture_is_raw_name(const char *path)
{
    static const char *const names[] = {".dng", ".cr2", ".cr3", ".crw", ".nef", ".nrw", ".arw",
                                        ".orf", ".raf", ".rw2", ".pef", ".srw", ".erf", ".3fr"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (picture_has_extension(path, names[i]))
            return true;
    return false;
}

static const struct picture_kind *by_magic(const struct picture_look *l)
{
    if (has(l, 0, 4, "RIFF") && !has(l, 8, 4, "WEBP"))
        return has(l, 8, 4, "AVI ") ? &avi : &sound;
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        const struct magic *m = &list[i];
        if (has(l, m->part[0].at, m->part[0].size, m->part[0].bytes) &&
            has(l, m->part[1].at, m->part[1].size, m->part[1].bytes))
            return &m->kind;
    }
    return NULL;
}

const struct picture_kind *picture_kind_of(const struct picture_look *l, const char *path)
{
    const struct picture_kind *kind = by_magic(l);
    if (kind && !strcmp(kind->reader ? kind->reader : "", "tiff") && picture_is_raw_name(path))
        return &raw;
    if (kind)
        return kind;
    if (l->head[0] == 'P' && l->head[1] >= '1' && l->head[1] <= '6' && is_space(l->head[2]))
        return &pnm;
    if ((has(l, 0, 2, "PF") || has(l, 0, 2, "Pf")) && is_space(l->head[2]))
        return &pfm;
    if (is_bmp(l))
        return &bmp;
    if (is_tga(l, path))
        return &tga;
    return picture_is_raw_name(path) ? &raw : &unknown;
}

bool picture_kind_is_likely(const struct picture_kind *kind, uint64_t file_bytes,
                            uint64_t sample_bytes)
{
    static const uint64_t always = 64 << 20;
    uint64_t most;
    return sample_bytes <= always ||
           __builtin_mul_overflow(file_bytes, (uint64_t)kind->ratio, &most) || sample_bytes <= most;
}
