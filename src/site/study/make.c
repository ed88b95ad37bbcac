// make.c - stimuli gathered into the folder of a study
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/base/params.h"
#include "site/study/stimuli.h"

#include <dirent.h>
#include <errno.h>
#include <relume/image.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

struct make {
    const struct relume_study_params *p;
    const struct relume_study_condition *condition;
    int conditions, scenes, width, height;
    char *scene[STUDY_SCENES];
    int frames[STUDY_SCENES][RELUME_STUDY_CONDITIONS];
    const char *to;
};

static int is_shown(const struct dirent *entry)
{
    return entry->d_name[0] != '.' && strcmp(entry->d_name, "inventory") != 0;
}

static bool is_folder(const char *path)
{
    struct stat s;
    return !stat(path, &s) && S_ISDIR(s.st_mode);
}

static void free_list(struct dirent **list, int n)
{
    for (int i = 0; i < n; i++)
        mem_free_libc(list[i]);
    mem_free_libc(list);
}

static relume_status list_folder(struct dirent ***list, int *n, const char *path,
                                 const struct relume_log *log)
{
    *n = scandir(path, list, is_shown, alphasort);
    return *n >= 0 ? RELUME_OK : relume_input_fail(log, path, "cannot be read", errno);
}

static bool has_scene(const struct make *m, const char *name)
{
    for (int i = 0; i < m->scenes; i++)
        if (!strcmp(m->scene[i], name))
            return true;
    return false;
}

// Pictures without their endings, and folders, of the first condition.
static relume_status find_scenes(struct make *m)
{
    const char *folder = m->condition[0].folder;
    struct dirent **list;
    int n;
    relume_status status = list_folder(&list, &n, folder, m->p->log);
    if (status)
        return status;
    for (int i = 0; !status && i < n; i++) {
        char *path = mem_format("%s/%s", folder, list[i]->d_name);
        const bool film = path && is_folder(path);
        const char *dot = film ? NULL : strrchr(list[i]->d_name, '.');
        if (path && (film || relume_image_can_save(path))) {
            char *name = mem_format(
                "%.*s", (int)(dot ? (size_t)(dot - list[i]->d_name) : strlen(list[i]->d_name)),
                list[i]->d_name);
            if (!name)
                status = RELUME_ENOMEM;
            else if (m->scenes == STUDY_SCENES || !study_is_name(name) || has_scene(m, name))
                status = log_fail(m->p->log, RELUME_EUNFIT,
                                  "%s: expected at most %d scenes whose names are of letters, "
                                  "digits, '-', '_' and '.', each once",
                                  path, STUDY_SCENES);
            else
                m->scene[m->scenes++] = name;
            if (status)
                mem_free(name);
        }
        if (!path)
            status = RELUME_ENOMEM;
        mem_free(path);
    }
    free_list(list, n);
    if (!status && !m->scenes)
        status = log_fail(m->p->log, RELUME_EUNFIT, "%s: no pictures", folder);
    return status;
}

static relume_status copy_picture(struct make *m, const char *from, const char *to)
{
    struct relume_image image;
    relume_status status = relume_image_load(
        &image, from, relume_image_params(.log = m->p->log, .limits = m->p->limits));
    if (status)
        return status;
    if (!m->width) {
        m->width = image.width;
        m->height = image.height;
    }
    if (image.width != m->width || image.height != m->height)
        status =
            log_fail(m->p->log, RELUME_EUNFIT, "%s: %d x %d pixels; expected %d x %d as the others",
                     from, image.width, image.height, m->width, m->height);
    if (!status)
        status = relume_image_save(&image, to, relume_image_params(.log = m->p->log));
    relume_image_destroy(&image);
    return status;
}

static relume_status copy_film(struct make *m, const char *from, const char *to, int *frames)
{
    struct dirent **list;
    int n;
    relume_status status = list_folder(&list, &n, from, m->p->log);
    if (status)
        return status;
    if (mkdir(to, 0777))
        status = log_fail(m->p->log, RELUME_EIO, "%s: cannot be made; %s", to, strerror(errno));
    for (int i = 0; !status && i < n; i++) {
        char *picture = mem_format("%s/%s", from, list[i]->d_name);
        char *frame = mem_format("%s/%04d.png", to, *frames);
        if (!picture || !frame)
            status = RELUME_ENOMEM;
        else if (relume_image_can_save(picture)) {
            status = *frames < STUDY_FRAMES
                         ? copy_picture(m, picture, frame)
                         : log_fail(m->p->log, RELUME_ELIMIT, "%s: more than %d frames", from,
                                    STUDY_FRAMES);
            ++*frames;
        }
        mem_free(picture);
        mem_free(frame);
    }
    if (!status && !*frames)
        status = log_fail(m->p->log, RELUME_EUNFIT, "%s: no pictures", from);
    free_list(list, n);
    return status;
}

// The first picture of a scene in a folder, by the alphabet, whatever its ending; NULL where there
// is none.
static relume_status picture_of(char **out, const char *folder, const char *scene,
                                const struct relume_log *log)
{
    const size_t length = strlen(scene);
    struct dirent **list;
    int n;
    relume_status status = list_folder(&list, &n, folder, log);
    *out = NULL;
    if (status)
        return status;
    for (int i = 0; i < n && !*out && !status; i++) {
        const char *name = list[i]->d_name, *dot = strrchr(name, '.');
        if (!dot || (size_t)(dot - name) != length || strncmp(name, scene, length))
            continue;
        char *path = mem_format("%s/%s", folder, name);
        if (!path)
            status = RELUME_ENOMEM;
        else if (relume_image_can_save(path) && !is_folder(path))
            *out = path;
        else
            mem_free(path);
    }
    free_list(list, n);
    return status;
}

static relume_status copy_scene(struct make *m, int scene, int c)
{
    const char *folder = m->condition[c].folder, *name = m->scene[scene];
    char *film = mem_format("%s/%s", folder, name);
    char *base = mem_format("%s/%s/%s", m->to, m->condition[c].name, name);
    char *picture = NULL, *png = base ? mem_format("%s.png", base) : NULL;
    relume_status status = film && base && png ? RELUME_OK : RELUME_ENOMEM;
    const bool is_film = !status && is_folder(film);
    if (is_film)
        status = copy_film(m, film, base, &m->frames[scene][c]);
    else if (!status)
        status = picture_of(&picture, folder, name, m->p->log);
    if (!status && !is_film && picture)
        status = copy_picture(m, picture, png);
    else if (!status && !is_film)
        status = log_fail(m->p->log, RELUME_EUNFIT,
                          "%s: no picture of '%s'; expected one of every scene of %s", folder, name,
                          m->condition[0].folder);
    mem_free(film);
    mem_free(base);
    mem_free(picture);
    mem_free(png);
    return status;
}

static relume_status copy_all(struct make *m)
{
    relume_status status = RELUME_OK;
    for (int c = 0; !status && c < m->conditions; c++) {
        char *folder = mem_format("%s/%s", m->to, m->condition[c].name);
        if (!folder)
            return RELUME_ENOMEM;
        if (mkdir(folder, 0777))
            status =
                log_fail(m->p->log, RELUME_EIO, "%s: cannot be made; %s", folder, strerror(errno));
        mem_free(folder);
        for (int s = 0; !status && s < m->scenes; s++)
            status = copy_scene(m, s, c);
    }
    return status;
}

// ---------------------------------------------------------------- study.json

static void put_frames(struct jwriter *w, const struct make *m)
{
    jopen_array(w, "frames");
    for (int s = 0; s < m->scenes; s++) {
        jopen_array(w, NULL);
        for (int c = 0; c < m->conditions; c++)
            jput_integer(w, NULL, m->frames[s][c]);
        jclose(w);
    }
    jclose(w);
}

static relume_status write_json(const struct make *m, const char *const *question, int questions)
{
    const double rate = m->p->frames_per_second;
    const char *names[RELUME_STUDY_CONDITIONS];
    struct jwriter w = {0};
    for (int c = 0; c < m->conditions; c++)
        names[c] = m->condition[c].name;
    jopen_object(&w, NULL);
    jgap(&w, " ");
    jput_text(&w, "format", "relume-study");
    jput_integer(&w, "version", 1);
    jgap(&w, "\n  ");
    jput_texts(&w, "conditions", names, (size_t)m->conditions);
    jgap(&w, "\n  ");
    jput_texts(&w, "scenes", (const char *const *)m->scene, (size_t)m->scenes);
    jgap(&w, "\n  ");
    jput_texts(&w, "questions", question, (size_t)questions);
    jgap(&w, "\n  ");
    put_frames(&w, m);
    jgap(&w, "\n  ");
    jput_number(&w, "frames_per_second", rate > 0.0 ? rate : 24.0, 9);
    jput_integer(&w, "seed", (long long)m->p->seed);
    jgap(&w, " ");
    return jsave_in(&w, m->to, "study.json", m->p->log);
}

static bool are_sound(const struct relume_study_condition *condition, int conditions,
                      const struct relume_study_params *p)
{
    if (conditions < 2 || conditions > RELUME_STUDY_CONDITIONS || p->questions < 0 ||
        p->questions > RELUME_STUDY_QUESTIONS || p->seed > INT64_MAX ||
        !(p->frames_per_second >= 0.0 && p->frames_per_second <= 120.0))
        return false;
    for (int c = 0; c < conditions; c++) {
        if (!study_is_name(condition[c].name) || !condition[c].folder)
            return false;
        for (int d = 0; d < c; d++)
            if (!strcmp(condition[c].name, condition[d].name))
                return false;
    }
    return true;
}

relume_status relume_study_make(const char *folder, const struct relume_study_condition *condition,
                                int conditions, const struct relume_study_params *params)
{
    static const char *const usual[] = {"Which picture do you prefer?"};
    const struct relume_study_params p = PARAMS(relume_study_params, params);
    outdir *dir = NULL;
    if (!are_sound(condition, conditions, &p))
        return log_fail(p.log, RELUME_EINVAL,
                        "a study needs 2 to %d conditions, each with a name of its own of letters, "
                        "digits, '-', '_' and '.'",
                        RELUME_STUDY_CONDITIONS);
    struct make *m = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    m->p = &p;
    m->condition = condition;
    m->conditions = conditions;
    relume_status status = find_scenes(m);
    if (!status)
        status = outdir_open(&dir, folder, p.force, p.log);
    if (!status) {
        m->to = outdir_path(dir);
        status = copy_all(m);
    }
    if (!status)
        status = write_json(m, p.question ? p.question : usual, p.question ? p.questions : 1);
    status = outdir_end(&dir, status);
    for (int i = 0; i < m->scenes; i++)
        mem_free(m->scene[i]);
    mem_free(m);
    return status;
}
