// objects_kept.c - what the folder of a finished capture tells about it
//
// capture.json has the lights and the photographs' names, report.html the warnings and the errors
// of directions, as acquire_report.c writes them.
#include "capture/objects/objects.h"

#include "core/base/infile.h"
#include "core/base/json.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "image/image/pages.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>

static const uint64_t REPORT_MOST = (uint64_t)256 << 20;  // bytes

static bool has_file(const char *folder, const char *name)
{
    char *path = mem_format("%s/%s", folder, name);
    struct stat s;
    const bool there = path && !stat(path, &s) && S_ISREG(s.st_mode);
    mem_free(path);
    return there;
}

bool object_is_capture(const char *path)
{
    return has_file(path, "capture.json") && has_file(path, ".relume") &&
           has_file(path, "report.html");
}

// A log without sentences, with which files are read that may be replaced later.
static struct relume_log quiet_log(const struct relume_log *log)
{
    return (struct relume_log){.context = log ? log->context : NULL, .leave_unnoted = true};
}

// ---------------------------------------------------------------- the report

// Undoes markup_text in place.
static void unescape(char *text)
{
    static const struct {
        const char *code, *is;
    } codes[] = {{"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}, {"&quot;", "\""}, {"&#39;", "'"}};
    char *to = text;
    while (*text) {
        size_t i = 0;
        while (i < sizeof codes / sizeof *codes &&
               strncmp(text, codes[i].code, strlen(codes[i].code)) != 0)
            i++;
        const bool coded = i < sizeof codes / sizeof *codes;
        *to++ = coded ? *codes[i].is : *text;
        text += coded ? strlen(codes[i].code) : 1;
    }
    *to = '\0';
}

// Returns what follows `start` in a line that begins so, up to `end`; NULL: it begins otherwise.
static char *between(char *line, const char *start, const char *end)
{
    if (strncmp(line, start, strlen(start)) != 0)
        return NULL;
    line += strlen(start);
    char *stop = strstr(line, end);
    if (stop)
        *stop = '\0';
    return line;
}

static relume_status add_warning(struct relume_acquisition *out, char *text)
{
    unescape(text);
    if (!mem_grow(&out->warning, (size_t)out->warnings, sizeof *out->warning))
        return RELUME_ENOMEM;
    out->warning[out->warnings] = mem_text(text);
    if (!out->warning[out->warnings])
        return RELUME_ENOMEM;
    out->warnings++;
    out->left_out += strstr(text, ": left out: ") != NULL;
    return RELUME_OK;
}

// The fifth cell of a row of lights: the error of the direction.
static double error_of_row(const char *line)
{
    for (int cell = 0; line && cell < 5; cell++) {
        line = strstr(line, "<td>");
        line = line ? line + strlen("<td>") : NULL;
    }
    return line ? strtod(line, NULL) : 0.0;
}

static relume_status read_lines(struct relume_acquisition *out, char *text)
{
    relume_status status = RELUME_OK;
    double squares = 0.0;
    int row = -1;  // of the table of lights
    for (char *next; !status && text; text = next) {
        char *found;
        next = strchr(text, '\n');
        if (next)
            *next++ = '\0';
        if ((found = between(text, "<div class=\"warn\">", "</div>")))
            status = add_warning(out, found);
        else if ((found = between(text, "<tr><td>estimated error of positions</td><td>", " ")))
            out->position_error = 0.01 * strtod(found, NULL);
        else if (!strncmp(text, "<h2>", 4))
            row = strncmp(text, "<h2>Lights</h2>", 15) ? out->lights : 0;
        else if (row >= 0 && row < out->lights && !strncmp(text, "<tr", 3)) {
            const double sigma = error_of_row(text);
            out->photo[row++].sigma_deg = sigma;
            squares += sigma * sigma / out->lights;
        }
    }
    out->direction_error_deg = sqrt(squares);
    return status;
}

static relume_status read_report(struct relume_captured_object *o, const struct relume_log *log)
{
    char *path = mem_format("%s/report.html", o->path), *text = NULL;
    size_t size;
    relume_status status =
        path ? input_load(&text, &size, path, REPORT_MOST, "a report", log) : RELUME_ENOMEM;
    if (!status)
        status = read_lines(&o->capture, text);
    mem_free(text);
    mem_free(path);
    return status;
}

// ---------------------------------------------------------------- the lights

static relume_status alloc_lights(struct relume_acquisition *out, const struct relume_manifest *m)
{
    const size_t n = (size_t)m->lights;
    out->photo = mem_zeroed(n, sizeof *out->photo);
    out->lights = out->photo ? m->lights : 0;
    out->direction = mem_array(n, sizeof *out->direction);
    out->position = m->positions ? mem_copy(m->positions, n, sizeof *m->positions) : NULL;
    out->intensity = m->intensities ? mem_copy(m->intensities, n, sizeof *m->intensities) : NULL;
    return out->photo && out->direction && (out->position || !m->positions) &&
                   (out->intensity || !m->intensities)
               ? RELUME_OK
               : RELUME_ENOMEM;
}

// The photographs of a capture, as capture.json lists them; NULL: it does not.
static const jvalue *photographs_of(const jvalue *provenance)
{
    return jvalue_member(provenance, "photographs");
}

static relume_status name_photographs(struct relume_captured_object *o,
                                      const struct relume_manifest *m, const jvalue *list)
{
    for (int i = 0; i < m->lights; i++) {
        const char *file = jvalue_text(jvalue_member(jvalue_item(list, (size_t)i), "file"));
        o->capture.photo[i].path = file && *o->photographs
                                       ? mem_format("%s/%s", o->photographs, file)
                                       : mem_text(file ? file : path_name(m->view[0].images[i]));
        o->capture.photo[i].sharpness = o->capture.photo[i].similarity = NAN;
        if (!o->capture.photo[i].path)
            return RELUME_ENOMEM;
    }
    return RELUME_OK;
}

static relume_status read_lights(struct relume_captured_object *o, const relume_capture *capture,
                                 const jvalue *list)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    struct relume_acquisition *out = &o->capture;
    const relume_status status = alloc_lights(out, m);
    out->width = relume_capture_width(capture);
    out->height = relume_capture_height(capture);
    out->gap_deg = NAN;
    for (int i = 0; !status && i < m->lights; i++)
        out->direction[i] = m->positions ? vec3_unit(m->positions[i]) : m->directions[i];
    return status ? status : name_photographs(o, m, list);
}

// ---------------------------------------------------------------- the photographs

// Returns whether the folder has a file of that size, as capture.json says about a photograph.
static bool is_there(const char *folder, const jvalue *photograph)
{
    const char *name = jvalue_text(jvalue_member(photograph, "file"));
    char *path = name ? mem_format("%s/%s", folder, name) : NULL, file[PAGE_PATH];
    long long bytes;
    struct stat s;
    if (path)
        (void)page_of(file, path);
    const bool there = path && !stat(file, &s) &&
                       jvalue_integer(jvalue_member(photograph, "bytes"), &bytes) &&
                       s.st_size == bytes;
    mem_free(path);
    return there;
}

static int count_in(const char *folder)
{
    struct relume_photographs list;
    const relume_status status =
        relume_photographs_list(&list, &folder, 1, relume_photographs_params(.quiet = true));
    const int count = status ? 0 : list.count;
    relume_photographs_free(&list);
    return count;
}

// Photographs that were moved away since are no others.
static relume_status compare(const struct relume_captured_object *o, const jvalue *list,
                             const struct relume_log *log)
{
    const int n = (int)jvalue_count(list), there = count_in(o->photographs);
    for (int i = 0; there && i < n; i++) {
        const jvalue *photograph = jvalue_item(list, (size_t)i);
        const char *name = jvalue_text(jvalue_member(photograph, "file"));
        if (!is_there(o->photographs, photograph))
            return log_fail(log, RELUME_EUNFIT,
                            "%s: is there already, made of other photographs: %s is gone or has "
                            "changed; --force makes it again",
                            o->path, name ? name : "one");
    }
    if (n && there > n + o->capture.left_out)
        return log_fail(log, RELUME_EUNFIT,
                        "%s: is there already, made of %d photographs; %s holds %d now; --force "
                        "makes it again",
                        o->path, n + o->capture.left_out, o->photographs, there);
    return RELUME_OK;
}

// ---------------------------------------------------------------- all

static relume_status recall(struct relume_captured_object *o, jvalue **provenance,
                            const struct relume_log *log)
{
    relume_capture *capture;
    relume_status status =
        relume_capture_open(&capture, o->path, relume_capture_params(.log = log));
    const char *text = status ? NULL : relume_capture_manifest(capture)->provenance;
    if (text)
        status = jvalue_parse(provenance, text, log);
    if (!status)
        status = read_lights(o, capture, photographs_of(*provenance));
    if (!status)
        status = read_report(o, log);
    relume_capture_destroy(&capture);
    return status;
}

relume_status object_recall(struct relume_captured_object *object, const struct relume_log *log)
{
    const struct relume_log quiet = quiet_log(log);
    jvalue *provenance = NULL;
    relume_status status = recall(object, &provenance, &quiet);
    if (status)
        relume_acquisition_destroy(&object->capture);
    if (status && status != RELUME_ENOMEM)
        status = log_fail(log, status,
                          "%s: is there already, but cannot be read; --force makes it again",
                          object->path);
    else if (!status && *object->photographs)
        status = compare(object, photographs_of(provenance), log);
    jvalue_free(&provenance);
    return status;
}
