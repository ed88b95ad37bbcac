// acquire_inputs.c - the photographs, masks and lists of lights that are named or lie beside
#include "capture/acquire/acquire.h"

#include "core/base/log.h"
#include "core/base/tree.h"

#include <relume/image/directions.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static int by_number(const void *a, const void *b)
{
    return strverscmp(*(char *const *)a, *(char *const *)b);
}

static relume_status list(struct relume_photographs *out, const char *const *paths, int n,
                          int least, const struct relume_log *log)
{
    const relume_status status = relume_photographs_list(
        out, paths, n,
        relume_photographs_params(.log = log, .companions = true, .least = least,
                                  .command = least ? "try: relume capture" : NULL));
    if (!status && out->count)  // img2 comes before img10, whatever the shell says
        qsort(out->path, (size_t)out->count, sizeof *out->path, by_number);
    return status;
}

static bool is_lp(const char *path)
{
    return strlen(path) > 3 && path_ends(path, ".lp");
}

// A list of lights that names its photographs is a capture already.
static relume_status refuse_list(const struct relume_log *log, const char *const *paths, int count)
{
    if (count != 1 || !is_lp(paths[0]))
        return RELUME_OK;
    const char *path = paths[0];
    const int folder = path_folder(path);
    return log_fail(log, RELUME_EUNFIT,
                    "%s: this lists lights and photographs, which encode and maps take as it is; "
                    "for capture give the photographs: relume capture %.*s --lights %s -o DIR",
                    path, folder ? folder - 1 : 1, folder ? path : ".", path);
}

// A list that nobody named counts where it has a light for every photograph; an .lp file, which
// names them, also where it has more.
static bool fits(const char *path, int photographs)
{
    struct relume_captured_lights lights;
    const bool good = !relume_captured_lights_load(&lights, path, false, NULL);
    const bool fits =
        good && (is_lp(path) ? lights.count >= photographs : lights.count == photographs);
    relume_captured_lights_destroy(&lights);
    return fits;
}

// A list of lights in the folder whose name has `length` bytes.
static bool find_lights_in(struct acquisition *s, const char *folder, int length)
{
    static const char *const names[] = {"light_directions.txt", "lights.txt", "lights.lp",
                                        "dirs.lp"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(s->likely_lights, sizeof s->likely_lights, "%.*s%s", length, folder, names[i]);
        if (fits(s->likely_lights, s->photographs.count))
            return true;
    }
    *s->likely_lights = '\0';
    return false;
}

// Beside photographs that are named one by one; data sets of several objects keep one list above
// their folders.
static void find_likely_lights(struct acquisition *s)
{
    const char *const first = s->photographs.path[0];
    int length = path_folder(first);
    if (find_lights_in(s, first, length) || !length)
        return;
    do
        length--;
    while (length > 0 && first[length - 1] != '/');
    (void)find_lights_in(s, first, length);
}

// Positions look like directions that are not of unit length.
static void mention_near(const struct acquisition *s, const char *lights)
{
    if (!s->p.near && strcasestr(path_name(lights), "position"))
        log_line(s->p.log, RELUME_NOTE,
                 "%s: is read as light directions; add --near where it holds the positions of "
                 "lamps",
                 lights);
}

static bool balls_are_described(const struct relume_acquire_params *p)
{
    return p->ball || p->balls || p->ball_photograph_count || p->ball_mask || p->matte;
}

// The file of lights that lies with the photographs, NULL where none is meant.
static const char *lights_beside(const struct acquisition *s)
{
    const char *beside = s->photographs.lights;
    if (!beside)
        return NULL;
    if (path_ends(beside, ".txt") && !fits(beside, s->photographs.count)) {
        log_line(s->p.log, RELUME_NOTE,
                 "%s: is not read; as light directions it would have a line x y z for each of the "
                 "%d photographs",
                 beside, s->photographs.count);
        return NULL;
    }
    log_line(s->p.log, RELUME_NOTE,
             "%s: light directions are taken from this file; --ball or --ball-photos take them "
             "from a mirror ball instead",
             beside);
    return beside;
}

static void choose_lights(struct acquisition *s)
{
    if (!s->p.lights && !balls_are_described(&s->p))
        s->p.lights = lights_beside(s);
    if (s->p.lights)
        mention_near(s, s->p.lights);
    else
        find_likely_lights(s);
}

relume_status acquire_find_inputs(struct acquisition *s, const char *const *paths, int count)
{
    struct relume_acquire_params *p = &s->p;
    relume_status status = refuse_list(p->log, paths, count);
    if (!status)
        status = list(&s->photographs, paths, count, 3, p->log);
    if (!status && p->ball_photograph_count)
        status = list(&s->balls, p->ball_photographs, p->ball_photograph_count, 0, p->log);
    if (!status && p->flat_count)
        status = list(&s->flats, p->flats, p->flat_count, 0, p->log);
    if (status)
        return status;
    choose_lights(s);
    p->mask = p->mask ? p->mask : s->photographs.mask;
    p->ball_mask = p->ball_mask ? p->ball_mask : s->balls.mask;
    return RELUME_OK;
}
