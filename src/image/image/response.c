// response.c - response curves: evaluated, made of known curves, read and written
#include <relume/image/response.h>

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "image/image/merge_weight.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const int version = 1;

float relume_response_decode(const struct relume_response *response, int channel, float code)
{
    const float *e = response->exposure[channel];
    if (!(code > 0.0f))
        return e[0];
    const float x = code * (RELUME_CODES - 1);
    if (!(x < RELUME_CODES - 1))
        return e[RELUME_CODES - 1];
    const int i = (int)x;
    return e[i] + (x - (float)i) * (e[i + 1] - e[i]);
}

float relume_response_encode(const struct relume_response *response, int channel, float exposure)
{
    const float *e = response->exposure[channel];
    int low = 0, high = RELUME_CODES - 1;
    if (!(exposure > e[low]))
        return 0.0f;
    if (!(exposure < e[high]))
        return 1.0f;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        *(e[middle] <= exposure ? &low : &high) = middle;
    }
    const float t = (exposure - e[low]) / (e[high] - e[low]);
    return ((float)low + t) / (RELUME_CODES - 1);
}

void relume_response_of(struct relume_response *out, struct relume_transfer transfer)
{
    for (int i = 0; i < RELUME_CODES; i++)
        for (int c = 0; c < 3; c++)
            out->exposure[c][i] =
                relume_transfer_decode(transfer, (float)i / (float)(RELUME_CODES - 1));
}

// ---------------------------------------------------------------- files

static bool next_line(FILE *f, char *line, int size)
{
    do
        if (!fgets(line, size, f))
            return false;
    while (line[0] == '#');
    return true;
}

static bool read_entry(const char *line, struct relume_response *out, int i)
{
    int code;
    float v[3];
    if (sscanf(line, "%d %f %f %f", &code, &v[0], &v[1], &v[2]) != 4 || code != i)
        return false;
    for (int c = 0; c < 3; c++) {
        const float before = i > 0 ? out->exposure[c][i - 1] : 0.0f;
        if (!(v[c] >= before) || !isfinite(v[c]))
            return false;
        out->exposure[c][i] = v[c];
    }
    return true;
}

relume_status relume_response_load(struct relume_response *out, const char *path,
                                   const struct relume_log *log)
{
    char line[256];
    int found;
    *out = (struct relume_response){0};
    FILE *f = input_open(path, log);
    if (!f)
        return relume_input_fail(log, path, "a response-curve file cannot be opened", errno);
    int i = -1;
    if (next_line(f, line, sizeof line) && sscanf(line, "relume-response %d", &found) == 1 &&
        found == version)
        for (i = 0; i < RELUME_CODES; i++)
            if (!next_line(f, line, sizeof line) || !read_entry(line, out, i))
                break;
    fclose(f);
    if (i < 0)
        return log_fail(log, RELUME_EFORMAT,
                        "%s: not a response-curve file; expected 'relume-response %d' at its head",
                        path, version);
    if (i < RELUME_CODES)
        return log_fail(log, RELUME_EFORMAT,
                        "%s: entry %d; expected '%d RED GREEN BLUE' that never falls", path, i, i);
    for (int c = 0; c < 3; c++)
        if (!(out->exposure[c][RELUME_CODES - 1] > 0.0f))
            return log_fail(log, RELUME_EFORMAT, "%s: a channel is zero; expected a curve", path);
    return RELUME_OK;
}

relume_status relume_response_save(const struct relume_response *response, const char *path,
                                   const struct relume_log *log)
{
    char *text = mem_array(RELUME_CODES + 4, 64);
    if (!text)
        return RELUME_ENOMEM;
    int n = sprintf(text, "relume-response %d\n# code, relative exposure of red, green, blue\n",
                    version);
    for (int i = 0; i < RELUME_CODES; i++)
        n += sprintf(text + n, "%d %.9g %.9g %.9g\n", i, (double)response->exposure[0][i],
                     (double)response->exposure[1][i], (double)response->exposure[2][i]);
    const relume_status status = outfile_save(path, text, (size_t)n, log);
    mem_free(text);
    return status;
}
