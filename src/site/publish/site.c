// site.c - a site on its way: where its files go
#include "site/publish/site.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/base64.h"
#include "core/base/outfile.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

// The folders of a path below the site; they may be there.
static relume_status make_folders(const struct site *site, char *path)
{
    for (char *slash = path + strlen(site->path) + 1; (slash = strchr(slash, '/')); slash++) {
        *slash = '\0';
        const bool failed = mkdir(path, 0777) && errno != EEXIST;
        if (failed)
            return log_fail(site->log, RELUME_EIO, "%s: cannot be created; %s", path,
                            strerror(errno));
        *slash = '/';
    }
    return RELUME_OK;
}

relume_status site_save(const struct site *site, const char *name, const void *bytes, size_t size)
{
    char *path = mem_format("%s/%s", site->path, name);
    relume_status status = path ? make_folders(site, path) : RELUME_ENOMEM;
    if (!status)
        status = outfile_save(path, bytes, size, site->log);
    mem_free(path);
    return status;
}

static relume_status save_copy(const struct site *site, const char *name, const void *bytes,
                               size_t size)
{
    struct text t;
    char *copy = mem_format("%s.js", name);
    relume_status status = copy ? text_open(&t) : RELUME_ENOMEM;
    if (!status) {
        fputs("relume.put(", t.file);
        text_put(&(struct jwriter){.file = t.file, .style = JSON_MARKUP}, NULL, name);
        fputs(", \"", t.file);
        base64_print(t.file, bytes, size);
        fputs("\");\n", t.file);
        status = site_save_text(site, copy, false, &t);
    }
    mem_free(copy);
    return status;
}

relume_status site_save_data(const struct site *site, const char *name, const void *bytes,
                             size_t size)
{
    relume_status status = RELUME_OK;
    if (site->params->target != RELUME_PUBLISH_DISK)
        status = site_save(site, name, bytes, size);
    if (!status && site->params->target != RELUME_PUBLISH_WEB)
        status = save_copy(site, name, bytes, size);
    return status;
}

relume_status site_save_text(const struct site *site, const char *name, bool data, struct text *t)
{
    relume_status status = text_close(t);
    if (!status)
        status = data ? site_save_data(site, name, t->bytes, t->size)
                      : site_save(site, name, t->bytes, t->size);
    text_free(t);
    return status;
}

relume_status site_save_json(const struct site *site, const char *folder, const char *name,
                             bool data, struct jwriter *w)
{
    size_t size;
    relume_status status = jend(w);
    char *text = jtake(w, &size), *path = mem_format("%s/%s", folder, name);
    if (!status)
        status = !text || !path ? RELUME_ENOMEM
                 : data         ? site_save_data(site, path, text, size)
                                : site_save(site, path, text, size);
    mem_free(text);
    mem_free(path);
    return status;
}

void site_put_address(FILE *f, const struct site *site, const char *name)
{
    const char *url = site->params->url;
    size_t n = url ? strlen(url) : 0;
    while (n && url[n - 1] == '/')
        n--;
    for (size_t i = 0; i < n; i++)
        text_address(f, (const char[]){url[i], '\0'});
    fprintf(f, "%s%s", n ? "/" : "", name);
}
