// relume.h - the whole public API
#ifndef RELUME_H
#define RELUME_H

#include <relume/align.h>
#include <relume/btf_environment.h>
#include <relume/base.h>
#include <relume/ball.h>
#include <relume/btf.h>
#include <relume/capture.h>
#include <relume/codebook.h>
#include <relume/coder.h>
#include <relume/context.h>
#include <relume/enhance.h>
#include <relume/evaluate.h>
#include <relume/exchange.h>
#include <relume/eye.h>
#include <relume/frame.h>
#include <relume/glare.h>
#include <relume/heldout.h>
#include <relume/image.h>
#include <relume/io.h>
#include <relume/light.h>
#include <relume/slab_depth.h>
#include <relume/directions.h>
#include <relume/normals.h>
#include <relume/object.h>
#include <relume/pack.h>
#include <relume/photograph.h>
#include <relume/photometric.h>
#include <relume/psf.h>
#include <relume/relight.h>
#include <relume/relighter.h>
#include <relume/renderer.h>
#include <relume/response.h>
#include <relume/rig.h>
#include <relume/scene.h>
#include <relume/acquire.h>
#include <relume/viewport.h>
#include <relume/slab_set.h>
#include <relume/surface.h>
#include <relume/team.h>
#include <relume/tone.h>
#include <relume/vec.h>
#include <relume/view.h>
#include <relume/ingest.h>

#endif
