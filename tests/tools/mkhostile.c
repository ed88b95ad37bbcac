// mkhostile.c - files that are made to do harm: mkhostile KIND OUT
//
// Each is what its format's description allows, or nearly, and a few hundred bytes that crash a
// reader, keep it busy or claim memory. None is anybody else's file.
#include "image/image/exr.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct buffer {
    uint8_t bytes[1 << 18];
    size_t size;
};

static void put(struct buffer *b, const void *bytes, size_t n)
{
    if (n > sizeof b->bytes - b->size)
        exit(3);
    memcpy(b->bytes + b->size, bytes, n);
    b->size += n;
}

static void fill(struct buffer *b, int byte, size_t n)
{
    while (n--)
        put(b, &(uint8_t){(uint8_t)byte}, 1);
}

static void big(struct buffer *b, uint32_t v, int bytes)
{
    for (int i = bytes - 1; i >= 0; i--)
        fill(b, v >> (8 * i) & 255, 1);
}

static void little(struct buffer *b, uint32_t v, int bytes)
{
    for (int i = 0; i < bytes; i++)
        fill(b, v >> (8 * i) & 255, 1);
}

static void text(struct buffer *b, const char *t)
{
    put(b, t, strlen(t));
}

// IFF with a picture of more rows than it can hold: writes behind the end in OpenImageIO 2.4.
static void iff(struct buffer *b)
{
    text(b, "FOR4");
    big(b, 900, 4);
    text(b, "CIMGTBHD");
    big(b, 32, 4);
    big(b, 64, 4);
    big(b, 64, 4);
    big(b, 0x00010001, 4);
    big(b, 3, 4);
    fill(b, 0, 16);
    text(b, "FOR4");
    big(b, 800, 4);
    text(b, "TBMPRGBA");
    big(b, 700, 4);
    big(b, 0, 4);
    big(b, 0xffffffff, 4);
    fill(b, 255, 700);
}

static void card(struct buffer *b, const char *t)
{
    text(b, t);
    fill(b, ' ', 80 - strlen(t));
}

// A valid colour picture of 16 x 8 pixels, whose channels have no names.
static void fits(struct buffer *b)
{
    card(b, "SIMPLE  =                    T");
    card(b, "BITPIX  =                    8");
    card(b, "NAXIS   =                    3");
    card(b, "NAXIS1  =                   16");
    card(b, "NAXIS2  =                    8");
    card(b, "NAXIS3  =                    3");
    card(b, "END");
    fill(b, ' ', 2880 - b->size);
    fill(b, 100, 2880);
}

// Softimage: a packet without an end before the file's.
static void softimage(struct buffer *b)
{
    big(b, 0x5380f634, 4);
    big(b, 0x40600000, 4);
    fill(b, 'x', 80);
    text(b, "PICT");
    big(b, 0x00400040, 4);
    big(b, 0x3f800000, 4);
    big(b, 0x00030000, 4);
    big(b, 0x000802e0, 4);
}

static void video(struct buffer *b)
{
    big(b, 24, 4);
    text(b, "ftypisom");
    fill(b, 0, 1000);
}

static void psd(struct buffer *b)
{
    text(b, "8BPS");
    big(b, 1, 2);
    fill(b, 0, 6);
    big(b, 3, 2);
    big(b, 30000, 4);
    big(b, 30000, 4);
    big(b, 8, 2);
    big(b, 3, 2);
    fill(b, 0, 600);
}

static void dpx(struct buffer *b)
{
    static const uint8_t end[] = {0};
    text(b, "SDPX");
    big(b, 2048, 4);
    text(b, "V1.0");
    fill(b, 0, 2048 - b->size);
    struct buffer *head = calloc(1, sizeof *head);
    if (!head)
        exit(3);
    big(head, 0x00000001, 4);  // one element
    big(head, 30000, 4);
    big(head, 30000, 4);
    fill(head, 0, 20);
    big(head, 0x3202020a, 4);  // RGB, 10 bits
    big(head, 0x00010000, 4);
    big(head, 2048, 4);
    memcpy(b->bytes + 768, head->bytes, head->size);
    free(head);
    fill(b, 0, 5120);
    put(b, end, 1);
}

// A progressive JPEG of 60000 x 60000 pixels without any scan.
static void jpeg(struct buffer *b)
{
    put(b, "\xff\xd8\xff\xdb\0\x43\0", 7);
    fill(b, 1, 64);
    put(b, "\xff\xc2\0\x11\x08\x7f\xff\x7f\xff\x03\x01\x11\0\x02\x11\0\x03\x11\0", 19);
    put(b, "\xff\xda\0\x0c\x03\x01\0\x02\0\x03\0\0\0\0", 14);
    fill(b, 0, 100);
}

// One tile for all places: 4096 x 4096 pixels in 200 kB, as any reader has to see it.
static void tiles(struct buffer *b)
{
    enum {
        SIDE = 4096,
        TILE = 256,
        TILES = (SIDE / TILE) * (SIDE / TILE),
        BYTES = TILE * TILE * 3
    };
    const uint32_t lists = 8 + BYTES, bits = lists + 8 * TILES, head = bits + 6;
    text(b, "II*");
    fill(b, 0, 1);
    little(b, head, 4);
    for (int i = 0; i < BYTES; i++)
        fill(b, i * 7 / 3, 1);
    for (int i = 0; i < TILES; i++)
        little(b, 8, 4);
    for (int i = 0; i < TILES; i++)
        little(b, BYTES, 4);
    for (int i = 0; i < 3; i++)
        little(b, 8, 2);
    const uint32_t entries[][4] = {{256, 4, 1, SIDE},      {257, 4, 1, SIDE},
                                   {258, 3, 3, bits},      {259, 3, 1, 1},
                                   {262, 3, 1, 2},         {277, 3, 1, 3},
                                   {322, 4, 1, TILE},      {323, 4, 1, TILE},
                                   {324, 4, TILES, lists}, {325, 4, TILES, lists + 4 * TILES}};
    little(b, 10, 2);
    for (int i = 0; i < 10; i++) {
        little(b, entries[i][0], 2);
        little(b, entries[i][1], 2);
        little(b, entries[i][2], 4);
        little(b, entries[i][3], 4);
    }
    little(b, 0, 4);
}

// Two nodes that are instances of each other: Assimp 5.2 goes round until its stack is used up.
static void collada(struct buffer *b)
{
    text(b,
         "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\">\n<library_nodes><node id=\"a\"><instance_node url=\"#b\"/></node>"
         "<node id=\"b\"><instance_node url=\"#a\"/></node></library_nodes>"
         "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><instance_node url=\"#a\"/>"
         "</node></visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>\n");
}

// 5000 vertices, and a scene that shows them 4000 times.
static void gltf(struct buffer *b)
{
    text(b, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[");
    for (int i = 0; i < 4000; i++)
        text(b, i ? ",0" : "0");
    text(b, "]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":["
            "{\"attributes\":{\"POSITION\":0}}]}],"
            "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":5000,"
            "\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":60000}],"
            "\"buffers\":[{\"byteLength\":60000,\"uri\":\"data:application/octet-stream;base64,");
    fill(b, 'A', 80000);
    text(b, "\"}]}\n");
}

static void far_away(struct buffer *b)
{
    text(b, "v 9.2e18 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

// ---------------------------------------------------------------- EXR of odd channels

static relume_status zeros(void *context, int row, int rows, void *samples)
{
    (void)row;
    memset(samples, 0, (size_t)rows * *(const size_t *)context);
    return RELUME_OK;
}

static int exr(const char *path, int channels, const char *const *names)
{
    size_t row = (size_t)channels * 8 * sizeof(float);
    const struct exr_part part = {.name = "odd",
                                  .width = 8,
                                  .height = 8,
                                  .sample = EXR_SAMPLE_FLOAT,
                                  .codec = EXR_CODEC_ZIP,
                                  .channels = channels,
                                  .channel = names,
                                  .rows = zeros,
                                  .context = &row};
    return exr_write(path, NULL, &part, 1, false, 1, NULL) ? 3 : 0;
}

static int exr_hundred(const char *path)
{
    static char names[100][8];
    const char *list[100];
    for (int i = 0; i < 100; i++) {
        snprintf(names[i], sizeof names[i], "c%02d", i);
        list[i] = names[i];
    }
    return exr(path, 100, list);
}

static const struct {
    const char *name;
    void (*make)(struct buffer *b);
} kinds[] = {{"iff", iff},         {"fits", fits}, {"softimage", softimage}, {"video", video},
             {"psd", psd},         {"dpx", dpx},   {"jpeg", jpeg},           {"tiles", tiles},
             {"collada", collada}, {"gltf", gltf}, {"far", far_away}};

int main(int argc, char **argv)
{
    static struct buffer b;
    const char *what = argc == 3 ? argv[1] : "";
    if (!strcmp(what, "exr-z"))
        return exr(argv[2], 1, (const char *const[]){"Z"});
    if (!strcmp(what, "exr-rg"))
        return exr(argv[2], 2, (const char *const[]){"G", "R"});
    if (!strcmp(what, "exr-xyz"))
        return exr(argv[2], 3, (const char *const[]){"X", "Y", "Z"});
    if (!strcmp(what, "exr-100"))
        return exr_hundred(argv[2]);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (!strcmp(what, kinds[i].name)) {
            kinds[i].make(&b);
            FILE *f = fopen(argv[2], "wb");
            return !f || fwrite(b.bytes, 1, b.size, f) != b.size || fclose(f) ? 3 : 0;
        }
    fprintf(stderr, "usage: mkhostile KIND OUT\n");
    return 2;
}
