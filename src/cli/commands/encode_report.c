// encode_report.c - sentences about a capture that has been encoded
#include "encode_report.h"

// From which on a newcomer should know of coding with loss: bytes a pixel, and times the size of
// the photographs.
static const double LARGE = 4.0, LARGER = 1.5;

static const char *storage_words(enum relume_storage storage)
{
    static const char *const words[] = {
        [RELUME_STORE_DEFAULT] = "8 bits", [RELUME_STORE_8] = "8 bits",
        [RELUME_STORE_10] = "10 bits",     [RELUME_STORE_12] = "12 bits",
        [RELUME_STORE_16] = "16 bits",     [RELUME_STORE_HALF] = "half floats",
        [RELUME_STORE_FLOAT] = "floats",   [RELUME_STORE_LOG] = "half floats, rounded",
    };
    return words[storage];
}

// ---------------------------------------------------------------- shadows and highlights

static void say_shadows(const struct args *args, const struct encoded_file *f)
{
    const struct relume_moving_report *s = &f->result->shadows;
    if (s->outcome == RELUME_MOVING_SLOW)
        announce(args, RELUME_NOTE,
                 "%s: between the lamps shadows fade; --shadows yes traces them through the depth, "
                 "which takes some minutes",
                 f->input);
    else if (s->outcome == RELUME_MOVING_LARGE)
        announce(args, RELUME_NOTE,
                 "%s: between the lamps shadows fade; tracing them takes more than --max-memory "
                 "allows",
                 f->input);
    else if (s->outcome == RELUME_MOVING_MOVES && s->lights)
        announce(args, RELUME_NOTE,
                 "%s: shadows are traced through the depth: %d lights left out are shown at "
                 "%.1f dB PSNR, faded ones at %.1f; --shadows no leaves that out",
                 f->input, s->lights, s->moved_db, s->faded_db);
}

// Where nobody asked, what leaves the file as it was is not spoken of.
static void say_highlights(const struct args *args, const struct encoded_file *f)
{
    const struct relume_moving_report *h = &f->result->highlights;
    const bool asked = f->params->highlights == RELUME_MOVING_AUTO;
    if (h->outcome == RELUME_MOVING_MOVES && h->lights)
        announce(args, RELUME_NOTE,
                 "%s: highlights move with the light: %d lights left out are shown at %.1f dB "
                 "PSNR, faded ones at %.1f; --highlights no leaves that out",
                 f->input, h->lights, h->moved_db, h->faded_db);
    else if (h->outcome == RELUME_MOVING_SLOW)
        announce(args, RELUME_NOTE,
                 "%s: highlights fade; --highlights yes moves them, which takes some minutes and "
                 "shows %d lights left out at %.1f dB PSNR in place of %.1f",
                 f->input, h->lights, h->moved_db, h->faded_db);
    else if (h->outcome == RELUME_MOVING_LARGE)
        announce(args, RELUME_NOTE,
                 "%s: highlights fade; moving them takes more than --max-memory allows", f->input);
    else if (h->outcome == RELUME_MOVING_FAILED && asked)
        announce(args, RELUME_NOTE, "%s: highlights fade; no surface could be fitted (%s)",
                 f->input, relume_status_text(h->status));
    else if (h->outcome == RELUME_MOVING_FADES && asked)
        announce(args, RELUME_NOTE,
                 "%s: highlights fade: %d lights left out are shown at %.1f dB PSNR, moving ones "
                 "at %.1f",
                 f->input, h->lights, h->faded_db, h->moved_db);
    else if (h->outcome == RELUME_MOVING_UNSUITED && asked)
        announce(args, RELUME_NOTE, "%s: highlights fade; expected %s, for them to move", f->input,
                 h->expected);
}

// ---------------------------------------------------------------- quality and size

// Pixels that say little: black and overexposed ones, black images.
static void say_census(const struct args *args, const struct encoded_file *f)
{
    const struct relume_census *c = &f->result->measured.census;
    if (c->black)
        announce(args, c->black == c->pixels ? RELUME_WARNING : RELUME_NOTE,
                 "%s: %zu of %zu pixels are black under every light", f->input, c->black,
                 c->pixels);
    if (c->clipped)
        announce(args, c->always_clipped == c->pixels ? RELUME_WARNING : RELUME_NOTE,
                 "%s: %zu of %zu pixels are overexposed in at least one photograph, %zu in all",
                 f->input, c->clipped, c->pixels, c->always_clipped);
    if (c->black_images && relume_capture_hemispherical(f->capture))
        announce(args, RELUME_WARNING, "%s: %d image%s black", f->input, c->black_images,
                 c->black_images > 1 ? "s are" : " is");
}

// A hint for people who did not ask for a size.
static void hint_at_size(char text[128], const struct relume_encode_result *r)
{
    const double before = r->photograph_bytes, now = r->file_bytes;
    if (before > 0.0 && now > LARGER * before)
        snprintf(text, 128,
                 "; %.1f times the size of your photographs: --psnr %g makes it much smaller",
                 now / before, RELUME_USUAL_DB);
    else if (r->bytes_per_pixel > LARGE)
        snprintf(text, 128, "; with --psnr %g it is several times smaller", RELUME_USUAL_DB);
}

static void describe_reach(char text[128], const struct encoded_file *f)
{
    const struct relume_encode_result *r = f->result;
    const double bytes = f->params->bytes_per_pixel;
    switch (r->reach) {
    case RELUME_REACH_COEFFICIENTS:
        snprintf(text, 128, "; %g dB is more than %d coefficients reach", r->quality_db,
                 r->coefficients);
        break;
    case RELUME_REACH_PSNR_ABOVE:
        snprintf(text, 128, "; %.4g dB is more than it reaches%s", r->quality_db,
                 r->lights == 1 ? "; without --psnr nothing visible is lost" : "");
        break;
    case RELUME_REACH_PSNR_BELOW:
        snprintf(text, 128, "; its coarsest coding is better than %g dB", r->quality_db);
        break;
    case RELUME_REACH_BYTES_BELOW:
        snprintf(text, 128, "; it needs more than %g byte%s a pixel", bytes,
                 bytes == 1.0 ? "" : "s");
        break;
    case RELUME_REACH_BYTES_ABOVE:
        snprintf(text, 128, "; its finest coding needs less than %g byte%s a pixel", bytes,
                 bytes == 1.0 ? "" : "s");
        break;
    default:
        if (r->quality_db > 0.0 && !r->lossy && !r->coder_crashed && !f->params->lossless)
            hint_at_size(text, r);
    }
}

static void say_file(const struct args *args, const struct encoded_file *f)
{
    const struct relume_encode_result *r = f->result;
    char bytes[48] = "", unseen[64] = "", more[128] = "";
    if (r->bytes_per_pixel > 0.0)
        snprintf(bytes, sizeof bytes, ", %.1f bytes a pixel", r->bytes_per_pixel);
    if (r->unseen_db > 0.0)
        snprintf(unseen, sizeof unseen, "; unseen light directions: about %.0f dB", r->unseen_db);
    describe_reach(more, f);
    announce(args, RELUME_NOTE,
             "%s: reproduces your photograph%s at %.1f dB PSNR (differences %s) with %d "
             "coefficient%s%s, "
             "%s%s%s%s%s",
             f->output, r->lights == 1 && r->views == 1 ? "" : "s", r->measured.psnr_db,
             judgement(r->measured.psnr_db), r->coefficients, relume_plural(r->coefficients),
             r->joint ? "" : " a colour", r->lossy ? "coded with loss" : storage_words(r->storage),
             r->lossy ? "" : ", lossless", bytes, unseen, more);
}

static void say_part(const struct args *args, const struct encoded_file *f)
{
    const struct relume_encode_capture_params *p = f->params;
    const double psnr_db = f->result->measured.psnr_db;
    if (psnr_db == 0.0)
        announce(args, RELUME_NOTE,
                 "%s: part %d of %d, rows that wait for the others; 'relume join' makes one file "
                 "of all parts",
                 f->output, p->part, p->parts);
    else
        announce(args, RELUME_NOTE,
                 "%s: part %d of %d: reproduces your photographs at %.1f dB PSNR (differences %s); "
                 "'relume join' makes one file of all parts",
                 f->output, p->part, p->parts, psnr_db, judgement(psnr_db));
}

static void say_jnd(const struct args *args, const struct encoded_file *f)
{
    const struct relume_encode_result *r = f->result;
    const bool found = r->reach != RELUME_REACH_JND;
    announce(args, found ? RELUME_NOTE : RELUME_WARNING,
             "%s: 99 %% of the pixels of every photograph differ by less than %.2g JND%s, at "
             "%.1f dB PSNR",
             f->output, r->jnd, found ? "" : ", which is the least that it reaches",
             r->measured.psnr_db);
}

// ---------------------------------------------------------------- shares of parts

static void print_learnt(const char *path, const char *text)
{
    struct shown name;
    printf("%s: %s\n", shown(&name, path), text);
}

static void print_share(const struct encoded_file *f)
{
    const struct relume_encode_capture_params *p = f->params;
    char text[256];
    if (f->result->made == RELUME_LEARNT_ALL)
        snprintf(text, sizeof text,
                 "all is learnt; encode part %d of %d by the same line without --learn-only",
                 p->part, p->parts);
    else
        snprintf(text, sizeof text, "part %d of %d has learnt its share; %s", p->part, p->parts,
                 f->result->made == RELUME_LEARNT_STEP
                     ? "run this line again when the other parts have learnt theirs"
                     : "other parts have not learnt theirs yet");
    print_learnt(p->learnt, text);
}

void say_encoded(const struct args *args, const struct encoded_file *f)
{
    const struct relume_encode_result *r = f->result;
    const bool by_jnd = f->params->jnd > 0.0 && !r->coder_crashed;
    if (r->made == RELUME_LEARNT_NOTHING) {
        print_learnt(f->input, "nothing is learnt before encoding with these options; run the same "
                               "line without --learn-only");
        return;
    }
    say_shadows(args, f);
    say_highlights(args, f);
    if (f->params->learn_only)
        print_share(f);
    else if (by_jnd)
        say_jnd(args, f);
    if (f->params->learn_only || by_jnd || r->made == RELUME_ENCODED_ELSEWHERE)
        return;
    say_census(args, f);
    if (r->made == RELUME_ENCODED_PART)
        say_part(args, f);
    else
        say_file(args, f);
    if (r->is_coarse)
        announce(args, RELUME_WARNING,
                 "%s: very bright highlights: %s will ruin the picture; use --bits half", f->output,
                 storage_words(r->storage));
}

void say_coded_again(const struct args *args, const struct encoded_file *f, double bytes)
{
    const struct relume_encode_result *r = f->result;
    char size[64] = "", more[128] = "";
    if (r->file_bytes > 0.0)
        snprintf(size, sizeof size, ", %.2f times the bytes", r->file_bytes / bytes);
    describe_reach(more, f);
    announce(args, RELUME_NOTE,
             "%s: shows what %s shows at %.1f dB PSNR (differences %s), lossy%s%s", f->output,
             f->input, r->measured.psnr_db, judgement(r->measured.psnr_db), size, more);
}
