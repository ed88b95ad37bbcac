// together.c - one file made by several processes that run at the same time
#include "encode/encode/together.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/memory.h"
#include "format/coder/coding.h"

#include <relume/format/team.h>
#include <stdio.h>
#include <string.h>

// The parts of a team are removed; those of --part are the user's.
static const char OWN_PART[] = "relume-mpi";

// "statue.exr" becomes "statue.3of8.relume-mpi"; NULL when memory is short.
static char *name_part(const char *output, int part, int parts)
{
    const char *slash = strrchr(output, '/');
    const char *name = slash ? slash + 1 : output, *dot = strrchr(name, '.');
    const size_t stem = dot && dot > name ? (size_t)(dot - output) : strlen(output);
    return mem_format("%.*s.%dof%d.%s", (int)stem, output, part, parts, OWN_PART);
}

static relume_status give_byte(struct relume_buffer *out, unsigned char byte)
{
    const struct relume_writer writer = relume_buffer_writer(out);
    return writer.write(writer.user, &byte, 1, 0) ? RELUME_OK : RELUME_ENOMEM;
}

// Fills byte[members] with the byte of every process.
static relume_status share_bytes(const struct encode_request *r, const char *what,
                                 relume_team_make *make, void *context, unsigned char *byte)
{
    const struct relume_team *team = r->pack.team;
    struct relume_buffer *piece = mem_zeroed((size_t)team->members, sizeof *piece);
    relume_status status =
        piece ? team->share(team->user, what, make, context, piece) : RELUME_ENOMEM;
    for (int i = 0; !status && i < team->members; i++)
        if (piece[i].size == 1)
            byte[i] = piece[i].data[0];
        else
            status = log_fail(r->log, RELUME_EDAMAGED,
                              "process %d has shared %zu bytes (%s); expected 1", i + 1,
                              piece[i].size, what);
    for (int i = 0; piece && i < team->members; i++)
        relume_buffer_destroy(&piece[i]);
    mem_free(piece);
    return status;
}

// ---------------------------------------------------------------- the own part

// A part that may be there already, of the same work, since an earlier run was stopped.
struct kept_part {
    const struct encode_request *request;
    const char *path, *capture;
};

static relume_status say_kept(void *context, int member, struct relume_buffer *out)
{
    const struct kept_part *k = context;
    const struct relume_pack_encode_params *p = &k->request->pack;
    struct relume_pack_part part;
    return give_byte(out, member == p->part - 1 && !relume_pack_part_read(&part, k->path, NULL) &&
                              part.part == p->part && part.parts == p->parts &&
                              !strcmp(part.creator, "relume " RELUME_VERSION) &&
                              !strcmp(part.options, p->options) &&
                              !strcmp(part.capture, k->capture));
}

// Parts that need each other to be made are kept together.
static bool need_each_other(const struct encode_request *r)
{
    return request_is_lossy(r) || (r->pack.books && r->pack.share) ||
           r->pack.parts > relume_capture_manifest(r->capture)->views;
}

static relume_status write_part(struct encode_request *r, const relume_coder *coder,
                                const char *path, unsigned char *byte)
{
    char digest[RELUME_DIGEST];
    struct kept_part kept = {r, path, digest};
    struct relume_fidelity own;
    const struct relume_team *team = r->pack.team;
    bool all = true;
    relume_status status = relume_capture_digest(digest, r->capture, r->log);
    if (!status)
        status = share_bytes(r, "kept", say_kept, &kept, byte);
    for (int i = 0; !status && i < team->members; i++)
        all &= byte[i] != 0;
    const bool is_kept = !status && byte[team->member] && (all || !need_each_other(r));
    return status || is_kept ? status : relume_pack_encode(r->capture, coder, path, &own, &r->pack);
}

static relume_status say_written(void *context, int member, struct relume_buffer *out)
{
    (void)context;
    return give_byte(out, (unsigned char)(member & 1));
}

// ---------------------------------------------------------------- the file

// The first process joins; its piece says whether the steps are too coarse.
static relume_status join_parts(void *context, int member, struct relume_buffer *out)
{
    struct encode_request *r = context;
    const int parts = r->pack.parts;
    if (member)
        return give_byte(out, 0);
    struct relume_log log = r->log ? *r->log : (struct relume_log){0};
    log.leave_unnoted = true;  // parts are written again where 8 bits are too few
    char **path = mem_zeroed((size_t)parts, sizeof *path);
    relume_status status = path ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < parts; i++)
        if (!(path[i] = name_part(r->path, i + 1, parts)))
            status = RELUME_ENOMEM;
    if (!status)
        status = relume_pack_join((const char *const *)path, parts, r->path, &r->result.measured,
                                  relume_pack_params(.log = &log, .threads = r->pack.threads));
    for (int i = 0; path && i < parts; i++)
        mem_free(path[i]);
    mem_free(path);
    return status ? status : give_byte(out, relume_fidelity_is_coarse(&r->result.measured));
}

relume_status together_write(struct encode_request *r, const relume_coder *coder)
{
    const char *asked = r->pack.options;
    char *name = name_part(r->path, r->pack.part, r->pack.parts);
    char *as_halves = mem_format("%s (halves)", asked);
    unsigned char *byte = mem_zeroed((size_t)r->pack.team->members, 1);
    relume_status status = byte && name && as_halves ? RELUME_OK : RELUME_ENOMEM;
    bool again = true;
    r->pack.free_storage = false;
    while (!status && again) {
        status = write_part(r, coder, name, byte);
        if (!status)
            status = share_bytes(r, "written", say_written, NULL, byte);
        if (!status)
            status = share_bytes(r, "joined", join_parts, r, byte);
        again = !status && byte[0] && !r->asked->storage && r->pack.storage != RELUME_STORE_HALF;
        r->pack.storage = again ? RELUME_STORE_HALF : r->pack.storage;
        r->pack.options = again ? as_halves : r->pack.options;
    }
    if (!status)
        remove(name);
    r->pack.options = asked;
    mem_free(byte);
    mem_free(as_halves);
    mem_free(name);
    return status;
}
