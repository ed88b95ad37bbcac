// model.h - a baked object as other programs show it: a mesh with a plain texture
#ifndef PUBLISH_MODEL_H
#define PUBLISH_MODEL_H

#include "site/publish/page.h"

#include <relume/world/bake.h>

// NAME/model.glb, glTF 2.0 with a texture of what the surface shows under light from everywhere
// (of a fixed one: what it shows), seen along its normal; and NAME/iiif/texture.jpg, which is in
// it. RELUME_ENOMEM, RELUME_EIO.
relume_status model_write(const struct site *site, const struct page *page, const relume_baked *b);

#endif
