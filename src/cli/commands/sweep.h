// sweep.h - the table of relume sweep: its rows, what is kept of them, and how they are shown
#ifndef CLI_SWEEP_H
#define CLI_SWEEP_H

#include "cli/book_options.h"
#include "cli/cli.h"

// One coder and one way of storing.
struct sweep_row {
    const struct relume_basis *basis;
    const struct relume_interpolant *interpolant;  // NULL: the basis's own
    bool choose;                                   // the interpolant is chosen by the capture
    bool luminance;
    struct domain_choice domain;  // not auto
    bool several_domains;         // rows are told apart by theirs
    int wanted;                   // coefficients asked for; 0: the basis's own number
    int coefficients;             // of the file
    struct relume_heldout_store store;
    struct relume_books_params books;  // where codes is not 0

    bool known;         // measured, now or in an earlier run
    char skipped[200];  // why not measured; "" when it was
    int planes;
    double bytes, bytes_per_pixel;  // of the file made from all lights; per pixel and view
    double before_db;               // before quantising
    struct relume_heldout_quality quality;
    double seconds;  // that encoding took
    bool on_hull;
};

struct sweep_options;

struct sweep {
    const struct args *args;
    const struct sweep_options *options;
    const char *capture, *test;  // paths; `test` may be NULL
    const char *out;             // stem of the outputs, or NULL
    int leave_out;
    struct relume_books_params books;  // of rows with codebooks
    struct domain_choice domain;       // of the rows that are made next
    bool tone_mapped;                  // display values are those of relume_heldout_params
    double measured;                   // part of the pixels that was looked at
    int views, lights, judged, width, height;
    struct sweep_row *row;
    int rows;
};

// "pca", "pca tps", "sh luminance": what a coder is called without its size.
void sweep_coder_name(const struct sweep_row *row, char *text, size_t size);
const char *sweep_step_name(const struct sweep_row *row);
// Mark the rows on the hull of PSNR over bytes.
relume_status sweep_mark_hull(struct sweep *sweep);

void sweep_print_text(const struct sweep *sweep, FILE *out);
void sweep_print_csv(const struct sweep *sweep, FILE *out);
void sweep_print_json(const struct sweep *sweep, FILE *out);
// OUT.csv, OUT.json, OUT.svg and OUT.png.
relume_status sweep_save(const struct sweep *sweep);
// Whether one of these is a file that is read: RELUME_EINVAL with a sentence.
relume_status sweep_check(const struct sweep *sweep);

// OUT.resume: finished rows, one a line, found again by what was swept over.
typedef struct sweep_resume sweep_resume;
// `captures` (NULL-terminated) are what the figures depend on: their images' names, sizes and
// times. A file that something else wrote is left alone with a warning. RELUME_EIO when it cannot
// be written, RELUME_ENOMEM.
relume_status sweep_resume_open(sweep_resume **out, struct sweep *sweep,
                                const relume_capture *const *captures, uint64_t memory);
// Keep one row that has just been measured. RELUME_EIO.
relume_status sweep_resume_keep(sweep_resume *resume, const struct sweep_row *row);
// For what two sweeps must not do at once; NULL is fine.
void sweep_resume_lock(sweep_resume *resume);
void sweep_resume_unlock(sweep_resume *resume);
void sweep_resume_close(sweep_resume **resume);

#endif
