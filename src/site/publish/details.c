// details.c - what visitors of a site read: from options, and from a JSON file
#include "site/publish/details.h"

#include "core/base/log.h"

enum { TEXTS = 5 };
static const char *const names[TEXTS + 2] = {"title",  "maker",       "licence",
                                             "object", "description", "files"};

static relume_status check_texts(const jvalue *object, const char *path, const char *where,
                                 const char *const *known, const struct relume_log *log)
{
    if (!jvalue_is_object(object))
        return log_fail(log, RELUME_EFORMAT, "%s: %s; expected an object of texts", path, where);
    struct log_place place;
    const relume_status status =
        jvalue_check_known(object, known, log_at(&place, log, "%s: %s: ", path, where));
    for (int i = 0; !status && i < TEXTS; i++) {
        const jvalue *value = jvalue_member(object, names[i]);
        if (value && !jvalue_text(value))
            return log_fail(log, RELUME_EFORMAT, "%s: %s, \"%s\"; expected a text", path, where,
                            names[i]);
    }
    return status;
}

relume_status details_load(jvalue **root, const struct relume_publish_params *p,
                           const char *const *stems)
{
    static const char *const of_file[] = {"title",  "maker",       "licence",
                                          "object", "description", NULL};
    *root = NULL;
    if (!p->metadata)
        return RELUME_OK;
    relume_status status = jvalue_load(root, p->metadata, p->log);
    if (!status)
        status = check_texts(*root, p->metadata, "the site", names, p->log);
    const jvalue *files = status ? NULL : jvalue_member(*root, "files");
    if (files && !jvalue_is_object(files))
        status =
            log_fail(p->log, RELUME_EFORMAT,
                     "%s: \"files\"; expected an object with a member for each file", p->metadata);
    for (int i = 0; !status && stems[i]; i++) {
        const jvalue *file = jvalue_member(files, stems[i]);
        if (file)
            status = check_texts(file, p->metadata, stems[i], of_file, p->log);
    }
    const char *unknown = status ? NULL : jvalue_unknown(files, stems);
    if (unknown)
        log_line(p->log, RELUME_WARNING, "%s: \"files\" has \"%s\", which is none of the files",
                 p->metadata, unknown);
    if (status)
        jvalue_free(root);
    return status;
}

static const char *first(const char *a, const char *b, const char *c)
{
    return a ? a : b ? b : c;
}

static struct details of(const jvalue *object)
{
    return (struct details){.title = jvalue_text(jvalue_member(object, "title")),
                            .maker = jvalue_text(jvalue_member(object, "maker")),
                            .licence = jvalue_text(jvalue_member(object, "licence")),
                            .object = jvalue_text(jvalue_member(object, "object")),
                            .description = jvalue_text(jvalue_member(object, "description"))};
}

struct details details_of_site(const jvalue *root, const struct relume_publish_params *p)
{
    const struct details d = of(root);
    return (struct details){.title = first(p->title, d.title, NULL),
                            .maker = first(p->maker, d.maker, NULL),
                            .licence = first(p->licence, d.licence, NULL),
                            .object = first(p->object, d.object, NULL),
                            .description = first(p->description, d.description, NULL)};
}

struct details details_of_file(const jvalue *root, const struct relume_publish_params *p,
                               const char *stem, bool only)
{
    const struct details site = details_of_site(root, p);
    const struct details d = of(jvalue_member(jvalue_member(root, "files"), stem));
    return (struct details){
        .title = first(only ? p->title : NULL, d.title, only && site.title ? site.title : stem),
        .maker = first(only ? p->maker : NULL, d.maker, site.maker),
        .licence = first(only ? p->licence : NULL, d.licence, site.licence),
        .object = first(only ? p->object : NULL, d.object, only ? site.object : NULL),
        .description =
            first(only ? p->description : NULL, d.description, only ? site.description : NULL)};
}
