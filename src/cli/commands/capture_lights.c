// capture_lights.c - relume capture PHOTO ... -o DIR: a light sequence becomes a capture
#include "commands/capture_lights.h"

#include "frame_options.h"
#include "photo_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct job {
    struct photo_list photos, balls, flats;
    char *mask, *ball_mask;  // found among them, or NULL
    double (*outline)[3];
    struct relume_shoot_params p;
    struct relume_shoot shoot;
};

static void free_job(struct job *job)
{
    photo_list_free(&job->photos);
    photo_list_free(&job->balls);
    photo_list_free(&job->flats);
    free(job->mask);
    free(job->ball_mask);
    free(job->outline);
    relume_shoot_destroy(&job->shoot);
}

// ---------------------------------------------------------------- photographs

// A picture whose name says so is no photograph but the mask of the others; the last one counts.
static void split_masks(struct photo_list *list, char **mask)
{
    int n = 0;
    for (int i = 0; i < list->count; i++) {
        if (!strstr(base_name(list->path[i]), "mask")) {
            list->path[n++] = list->path[i];
            continue;
        }
        free(*mask);
        *mask = list->path[i];
    }
    list->count = n;
}

static int by_number(const void *a, const void *b)
{
    return strverscmp(*(char *const *)a, *(char *const *)b);
}

// img2 comes before img10, whatever the shell says.
static void put_in_order(struct photo_list *list)
{
    if (list->count)
        qsort(list->path, (size_t)list->count, sizeof *list->path, by_number);
}

static relume_status gather(const struct args *args, struct job *job)
{
    relume_status status = photo_list_make(&job->photos, args);
    for (int i = 0; !status && i < args_count(args, "--ball-photos"); i++)
        status = photo_list_add(&job->balls, args_nth(args, "--ball-photos", i), args_log(args));
    for (int i = 0; !status && i < args_count(args, "--flat"); i++)
        status = photo_list_add(&job->flats, args_nth(args, "--flat", i), args_log(args));
    split_masks(&job->photos, &job->mask);
    split_masks(&job->balls, &job->ball_mask);
    put_in_order(&job->photos);
    put_in_order(&job->balls);
    put_in_order(&job->flats);
    return status;
}

// ---------------------------------------------------------------- options

static relume_status read_outlines(const struct args *args, struct job *job)
{
    const int n = args_count(args, "--ball");
    if (!n)
        return RELUME_OK;
    job->outline = malloc((size_t)n * sizeof *job->outline);
    if (!job->outline)
        return RELUME_ENOMEM;
    for (int i = 0; i < n; i++)
        if (!parse_numbers(args_nth(args, "--ball", i), job->outline[i], 3))
            return usage_error("--ball: expected x,y,r in pixels; found '%s'",
                               args_nth(args, "--ball", i));
    job->p.ball = (const double(*)[3])job->outline;
    job->p.balls = n;
    return RELUME_OK;
}

static relume_status read_white(const struct args *args, struct job *job)
{
    const char *text = args_text(args, "--white", NULL);
    double region[4];
    if (!text)
        return RELUME_OK;
    if (!parse_numbers(text, region, 4) || !(region[2] >= 1.0 && region[3] >= 1.0))
        return usage_error("--white: expected x,y,width,height; found '%s'", text);
    for (int i = 0; i < 4; i++)
        job->p.white[i] = region[i] > -1e6 && region[i] < 1e6 ? (int)region[i] : -1;
    return RELUME_OK;
}

static relume_status read_align(const struct args *args, struct job *job)
{
    static const char *const names[] = {"none", "homography", NULL};
    const char *align = args_text(args, "--align", "none");
    job->p.align = !strcmp(align, "homography");
    return job->p.align || !strcmp(align, "none") ? RELUME_OK
                                                  : unknown_name("--align", align, names);
}

static double field_of_view(const struct args *args)
{
    if (args_has(args, "--focal"))
        return 2.0 * atan(18.0 / args_number(args, "--focal", 50.0)) * 180.0 / M_PI;
    return args_number(args, "--fov", 0.0);
}

static relume_status check_options(const struct args *args)
{
    static const char *const of_brackets[] = {"--times",   "--response", "--save-response",
                                              "--weights", "--ghosts",   NULL};
    for (int i = 0; of_brackets[i]; i++)
        if (args_has(args, of_brackets[i]))
            return usage_error("capture: %s works only with --hdr", of_brackets[i]);
    if (!args_has(args, "-o"))
        return usage_error("capture: expected -o DIR");
    if (args_has(args, "--fov") && args_has(args, "--focal"))
        return usage_error("capture: expected one of --fov and --focal");
    if (args_has(args, "--refine-brightness") && args_has(args, "--refine-lights"))
        return usage_error("capture: expected one of --refine-lights, which refines brightness as "
                           "well, and --refine-brightness");
    if (args_has(args, "--ball-transfer") && !args_has(args, "--ball-photos"))
        return usage_error("capture: --ball-transfer needs --ball-photos; for the photographs "
                           "themselves use --transfer");
    if (args_has(args, "--integrable") && !args_has(args, "--refine-lights"))
        return usage_error("capture: --integrable needs --refine-lights");
    if (args_has(args, "--radial") && !args_has(args, "--flat"))
        return usage_error("capture: --radial needs --flat FILE");
    if (args_has(args, "--relight") && !args_has(args, "--encode"))
        return usage_error("capture: --relight needs --encode FILE.exr");
    return RELUME_OK;
}

static relume_status read_options(const struct args *args, struct job *job)
{
    const char *transfer = args_text(args, "--transfer", NULL);
    const char *of_balls = args_text(args, "--ball-transfer", NULL);
    job->p = (struct relume_shoot_params){
        .log = args_log(args),
        .mask = args_text(args, "--mask", job->mask),
        .ball_mask = args_text(args, "--ball-mask", job->ball_mask),
        .photographs = (const char *const *)job->photos.path,
        .photograph_count = job->photos.count,
        .ball_photographs = (const char *const *)job->balls.path,
        .ball_photograph_count = job->balls.count,
        .balls = args_int(args, "--balls", 1),
        .matte = args_has(args, "--matte"),
        .fov_deg = field_of_view(args),
        .ball_z = args_number(args, "--ball-z", 0.0),
        .lights = args_text(args, "--lights", NULL),
        .flats = (const char *const *)job->flats.path,
        .flat_count = job->flats.count,
        .radial = args_has(args, "--radial"),
        .near = args_has(args, "--near"),
        .refine = args_has(args, "--refine-lights") || args_has(args, "--refine-brightness"),
        .brightness = args_has(args, "--refine-brightness"),
        .integrable = args_has(args, "--integrable"),
        .skip_bad = args_has(args, "--skip-bad"),
        .force = args_has(args, "--force"),
        .threads = args_threads(args),
    };
    if (transfer && relume_transfer_parse(&job->p.transfer, transfer))
        return usage_error("--transfer: expected linear, srgb or gamma:G; found '%s'", transfer);
    if (of_balls && relume_transfer_parse(&job->p.ball_transfer, of_balls))
        return usage_error("--ball-transfer: expected linear, srgb or gamma:G; found '%s'",
                           of_balls);
    relume_status status = read_outlines(args, job);
    if (!status)
        status = read_white(args, job);
    return status ? status : read_align(args, job);
}

// ---------------------------------------------------------------- by-products

static relume_status save(const struct args *args, const char *option,
                          const struct relume_image *image)
{
    const char *path = args_text(args, option, NULL);
    if (!path)
        return RELUME_OK;
    if (!image->data)
        return data_error("%s: normals cannot be computed; expected three lights or more that do "
                          "not lie in one plane",
                          path);
    return relume_image_save(image, path, relume_image_params(.log = args_log(args)));
}

static relume_status save_height(const struct args *args, const struct relume_shoot *shoot)
{
    struct relume_image height = {0};
    relume_status status = RELUME_OK;
    if (args_has(args, "--height") && shoot->photometric.normal.data)
        status = relume_height_integrate(&height, &shoot->photometric.normal,
                                         relume_height_params(.pixel = 2.0 / shoot->width));
    if (!status)
        status = save(args, "--height", &height);
    relume_image_destroy(&height);
    return status;
}

// ---------------------------------------------------------------- the file

static relume_status encode(const struct args *args, const struct job *job, const char *path)
{
    relume_capture *capture;
    relume_coder *coder = NULL;
    struct relume_notes notes;
    relume_status status = relume_capture_open(&capture, args_text(args, "-o", NULL),
                                               relume_capture_params(.log = args_log(args)));
    if (!status)
        status = relume_notes_read(&notes, job->shoot.photo[0].path, args_log(args));
    if (status)
        goto done;
    const enum relume_domain domain = notes.floats ? RELUME_DOMAIN_LINEAR : RELUME_DOMAIN_DISPLAY;
    status = relume_coder_learn(&coder, &relume_basis_pca, capture,
                                relume_coder_params(.log = args_log(args), .choose = true),
                                relume_encode_params(.log = args_log(args), .domain = domain,
                                                     .threads = args_threads(args)));
    if (!status)
        status =
            relume_pack_encode(capture, coder, path, NULL,
                               relume_pack_encode_params(.log = args_log(args), .domain = domain,
                                                         .compression = RELUME_COMPRESS_PIZ,
                                                         .threads = args_threads(args)));
done:
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
    return status;
}

// What lies outside the file's mask is not known.
static relume_status blacken(struct relume_image *frame, relume_pack *pack)
{
    struct relume_image mask;
    const relume_status status = relume_pack_mask(&mask, pack, 0);
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    for (size_t i = 0; !status && mask.data && i < 3 * pixels; i++)
        frame->data[i] *= mask.data[i / 3] > 0.5f ? 1.0f : 0.0f;
    relume_image_destroy(&mask);
    return status;
}

static relume_status relight(const struct args *args, const char *file)
{
    relume_pack *pack;
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    struct relume_image frame = {0};
    int n;
    struct relume_frame_params params = parse_frame(args);
    params.log = args_log(args);
    relume_status status = relume_pack_open(
        &pack, file, relume_pack_params(.log = args_log(args), .threads = args_threads(args)));
    if (status)
        return status;
    status = parse_lights(args, &rig, &lights, &n);
    if (!status)
        status = relume_frame(&frame, pack, &(struct relume_camera){0}, lights, n, &params);
    if (!status)
        status = blacken(&frame, pack);
    if (!status)
        status = relume_image_save(&frame, args_text(args, "--relight", NULL),
                                   relume_image_params(.log = args_log(args)));
    relume_image_destroy(&frame);
    relume_rig_destroy(&rig);
    relume_pack_destroy(&pack);
    return status;
}

// ---------------------------------------------------------------- what to say

static void put_vector(const char *key, struct relume_vec3 v)
{
    printf(",\"%s\":[%.9g,%.9g,%.9g]", key, v.x, v.y, v.z);
}

static void print_json(const struct relume_shoot *s)
{
    printf("{\"lights\":%d,\"width\":%d,\"height\":%d,\"balls\":[", s->lights, s->width, s->height);
    for (int b = 0; b < s->balls; b++)
        printf("%s{\"x\":%.9g,\"y\":%.9g,\"radius\":%.9g,\"coverage\":%.4g}", b ? "," : "",
               s->ball[b].x, s->ball[b].y, s->ball[b].radius, s->ball[b].coverage);
    printf("],\"gap_deg\":%.6g,\"residual\":", s->gap_deg);
    json_number(stdout, s->photometric.normal.data ? s->photometric.residual : (double)NAN);
    printf(",\"position_error\":%.6g,\"photographs\":[", s->position_error);
    for (int i = 0; i < s->lights; i++) {
        printf("%s{\"file\":", i ? "," : "");
        json_text(stdout, s->photo[i].path);
        put_vector("direction", s->direction[i]);
        if (s->position)
            put_vector("position", s->position[i]);
        if (s->intensity)
            printf(",\"intensity\":[%.9g,%.9g,%.9g]", (double)s->intensity[i][0],
                   (double)s->intensity[i][1], (double)s->intensity[i][2]);
        printf(",\"error_deg\":%.6g,\"saturated\":%.6g}", s->photo[i].sigma_deg,
               (double)s->photo[i].saturated);
    }
    printf("],\"warnings\":[");
    for (int i = 0; i < s->warnings; i++) {
        fputs(i ? "," : "", stdout);
        json_text(stdout, s->warning[i]);
    }
    puts("]}");
}

static void say(const struct args *args, const struct relume_shoot *s)
{
    const struct relume_log *log = args_log(args);
    double sigma = 0.0;
    char text[512];
    for (int i = 0; i < s->lights; i++)
        sigma += s->photo[i].sigma_deg / s->lights;
    size_t at = (size_t)snprintf(text, sizeof text, "%s: %d lights", args_text(args, "-o", NULL),
                                 s->lights);
    if (sigma > 0.0)
        at += (size_t)snprintf(text + at, sizeof text - at, ", directions to about %.2f degrees",
                               sigma);
    if (s->position_error > 0.0)
        at += (size_t)snprintf(text + at, sizeof text - at, ", positions to about %.1f %%",
                               100.0 * s->position_error);
    snprintf(text + at, sizeof text - at, "; see report.html there");
    log->message(log->user, RELUME_NOTE, text);
}

static relume_status make(const struct args *args, struct job *job)
{
    const char *file = args_text(args, "--encode", NULL);
    relume_status status = relume_shoot_make(&job->shoot, args_text(args, "-o", NULL), &job->p);
    if (status)
        return status;
    status = save(args, "--normals", &job->shoot.photometric.normal);
    if (!status)
        status = save(args, "--albedo", &job->shoot.photometric.albedo);
    if (!status)
        status = save_height(args, &job->shoot);
    if (!status && file)
        status = encode(args, job, file);
    if (!status && args_has(args, "--relight"))
        status = relight(args, file);
    if (!status && args_has(args, "--json"))
        print_json(&job->shoot);
    else if (!status)
        say(args, &job->shoot);
    return status;
}

relume_status capture_lights(const struct args *args)
{
    struct job job = {0};
    relume_status status = check_options(args);
    if (!status)
        status = gather(args, &job);
    if (!status)
        status = read_options(args, &job);
    if (!status)
        status = make(args, &job);
    free_job(&job);
    return status;
}
