// coding_file.c - the file of a part of the work: its tiles, and what belongs to them
#include "encode/encode/coding.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/pack/pack_write.h"

// The tiles of a part, with all that belongs to the view beside them where the first is among them.
static relume_status keep_tiles(struct coding *c, int view, struct group_share tiles)
{
    struct relume_pack_view *v = &c->f->view[view];
    struct lossy_words *own = &c->f->words[view];
    const struct lossy_words all = *own;
    relume_status status = RELUME_OK;
    if (c->f->p->parts) {
        *own = (struct lossy_words){0};
        status = lossy_keep_tiles(own, &all, tiles.first, tiles.end);
        mem_free(all.word);
    }
    v->coded = own->word;
    v->coded_words = own->count;
    if (tiles.first > 0) {
        v->depth = v->mask = NULL;
        v->levels = NULL;
    }
    return status;
}

static relume_status keep_own(struct coding *c)
{
    relume_status status = RELUME_OK;
    for (int g = 0; !status && g < c->groups.count; g++) {
        const struct group_share tiles = groups_tiles(&c->groups, g, c->own);
        for (int i = c->groups.begin[g]; !status && tiles.end && i < c->groups.begin[g + 1]; i++)
            status = keep_tiles(c, c->groups.view[i], tiles);
    }
    return status;
}

// Where people count the parts themselves.
static void say_empty(const struct coding *c)
{
    const struct relume_pack_encode_params *p = c->f->p;
    const int tiles = c->groups.tile[c->groups.count];
    if (c->own.first == c->own.end && !(c->team && c->team->close))
        log_line(p->log, RELUME_NOTE,
                 "part %d of %d holds nothing: planes with loss are coded in %d tile%s here; "
                 "expected no more than %d part%s",
                 p->part, p->parts, tiles, relume_plural(tiles), tiles, relume_plural(tiles));
}

relume_status coding_write(struct coding *c, const char *path, const struct relume_fidelity *report)
{
    const struct relume_pack_encode_params *p = c->f->p;
    const int middle = c->f->views / 2;
    struct relume_pack_contents contents;
    struct relume_pack_share share;
    char digest[RELUME_DIGEST];
    say_empty(c);
    relume_status status = keep_own(c);
    contents_describe(&contents, c->f);
    contents.report = *report;
    if (!coding_has_first(c, groups_with(&c->groups, middle), c->own))
        contents.preview = NULL;
    else if (!status)
        status = coded_rows_load_view(&c->rows, middle);
    if (!status && p->parts) {
        status = contents_share(&share, digest, c->f);
        share.coded = true;
        share.group = groups_of_tile(&c->groups, c->own.first);
        share.measured = report;
        contents.share = &share;
    }
    return status ? status : contents_write(&contents, path, p);
}
