// pack_source.h - a relume file that several threads read views from, one at a time
#ifndef VIEWER_PACK_SOURCE_H
#define VIEWER_PACK_SOURCE_H

#include "relit/depths.h"
#include "relit/loader.h"
#include "relit/tile_map.h"

// Thread-safety: safe between create and destroy, as long as no one else uses the pack but for
// relume_pack_info.
struct pack_source;

// `pack` must outlive it. Large views are made to go with so many bytes. RELUME_ENOMEM.
relume_status pack_source_create(struct pack_source **out, relume_pack *pack, size_t bytes);
void pack_source_destroy(struct pack_source **source);

// A view's codes stay until every one who asked for them has dropped them. Of a large view with a
// pyramid they are those of a reduced level (tile_map_make).
struct code_source pack_source_codes(struct pack_source *source);
// Where the view is larger than what those show: its tiles, as views by number.
const struct tile_map *pack_source_map(const struct pack_source *source);
struct code_source pack_source_tiles(struct pack_source *source);
struct part_source pack_source_parts(struct pack_source *source);
// Where each view's pixels see the scene, as relume_renderer_places; three channels.
struct depth_source pack_source_places(struct pack_source *source);
struct depth_source pack_source_depth(struct pack_source *source);

#endif
