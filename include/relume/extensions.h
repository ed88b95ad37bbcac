// extensions.h - the whole public API: the core (relume.h) and every extension
//
// Extensions may change between minor versions.
#ifndef RELUME_EXTENSIONS_H
#define RELUME_EXTENSIONS_H

#include <relume/relume.h>

#include <relume/capture/acquire.h>
#include <relume/capture/align.h>
#include <relume/capture/ball.h>
#include <relume/capture/chart.h>
#include <relume/capture/ingest.h>
#include <relume/capture/objects.h>
#include <relume/capture/photometric.h>
#include <relume/capture/slab_depth.h>
#include <relume/core/vec.h>
#include <relume/encode/heldout.h>
#include <relume/encode/pack_encode.h>
#include <relume/exchange/notes.h>
#include <relume/format/codebook.h>
#include <relume/format/coder.h>
#include <relume/format/pack_write.h>
#include <relume/format/team.h>
#include <relume/image/directions.h>
#include <relume/image/jnd.h>
#include <relume/image/photograph.h>
#include <relume/image/response.h>
#include <relume/material/btf.h>
#include <relume/material/change.h>
#include <relume/material/edit.h>
#include <relume/material/maps.h>
#include <relume/material/surface.h>
#include <relume/material/synthesis.h>
#include <relume/relight/enhance.h>
#include <relume/relight/eye.h>
#include <relume/relight/glare.h>
#include <relume/relight/normals.h>
#include <relume/relight/psf.h>
#include <relume/relight/relief.h>
#include <relume/relight/relight.h>
#include <relume/relight/slab_set.h>
#include <relume/relight/tone.h>
#include <relume/relight/view.h>
#include <relume/relight/viewport.h>
#include <relume/shape/billboards.h>
#include <relume/shape/fusion.h>
#include <relume/shape/mesh.h>
#include <relume/shape/simplify.h>
#include <relume/shape/volume.h>
#include <relume/site/study.h>
#include <relume/world/bake.h>
#include <relume/world/object.h>
#include <relume/world/reflection.h>
#include <relume/world/scene.h>
#include <relume/world/tableau.h>
#include <relume/world/transport.h>

#endif
