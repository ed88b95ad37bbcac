// table.c - all images of a view read side by side, so that memory does not grow with their height
#include "base/log.h"
#include "base/memory.h"
#include "base/thread.h"
#include "capture/capture.h"

struct relume_table {
    const relume_capture *capture;
    int view, row;
    int threads;
    const struct relume_log *log;
    int open;                     // streams opened so far
    struct image_stream *stream;  // [lights]
    relume_status *status;        // [lights], of the last read
    int rows;                     // of the read in progress
    float *out;
};

void relume_table_destroy(relume_table **table)
{
    relume_table *t = *table;
    *table = NULL;
    if (!t)
        return;
    for (int i = 0; i < t->open; i++)
        image_stream_close(&t->stream[i]);
    free(t->stream);
    free(t->status);
    free(t);
}

relume_status relume_table_open(relume_table **out, const relume_capture *capture, int view,
                                const struct relume_table_params *params)
{
    const struct relume_table_params p = params ? *params : (struct relume_table_params){0};
    const int lights = capture->draft.m.lights;
    struct relume_transfer to = p.display;
    if (to.curve == RELUME_CURVE_AUTO)
        to.curve = RELUME_CURVE_LINEAR;
    *out = NULL;
    if (view < 0 || view >= capture->draft.m.views)
        return RELUME_EINVAL;

    relume_table *t = mem_zeroed(1, sizeof *t);
    if (!t)
        return RELUME_ENOMEM;
    t->capture = capture;
    t->view = view;
    t->threads = p.threads;
    t->log = p.log;
    t->stream = mem_zeroed((size_t)lights, sizeof *t->stream);
    t->status = mem_zeroed((size_t)lights, sizeof *t->status);
    relume_status status = t->stream && t->status ? RELUME_OK : RELUME_ENOMEM;
    while (!status && t->open < lights) {
        status = capture_stream(&t->stream[t->open], capture, view, t->open, to, p.log);
        t->open += !status;
    }
    if (status)
        relume_table_destroy(&t);
    *out = t;
    return status;
}

static void read_light(void *context, size_t item, int worker)
{
    (void)worker;
    relume_table *t = context;
    const size_t band = (size_t)t->rows * (size_t)t->capture->width * 3;
    t->status[item] = image_stream_read(&t->stream[item], t->row, t->rows, t->out + item * band);
}

relume_status relume_table_read(relume_table *table, int rows, float *out)
{
    const int lights = table->capture->draft.m.lights;
    if (rows < 1 || rows > table->capture->height - table->row)
        return RELUME_EINVAL;
    table->rows = rows;
    table->out = out;
    thread_for(table->threads, (size_t)lights, read_light, table);
    table->row += rows;
    for (int i = 0; i < lights; i++) {
        if (table->status[i] == RELUME_EDATA)
            return log_fail(table->log, RELUME_EDATA, "%s: %s",
                            table->capture->draft.m.view[table->view].images[i],
                            image_stream_error(&table->stream[i]));
        if (table->status[i])
            return table->status[i];
    }
    return RELUME_OK;
}
