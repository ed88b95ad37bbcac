// relume.h - the core of the public API: capture, encode, open, relight, show, export, publish
//
// Extensions have headers of their own, in folders: relume/material/btf.h, relume/shape/mesh.h.
#ifndef RELUME_H
#define RELUME_H

#include <relume/base.h>
#include <relume/camera.h>
#include <relume/capture.h>
#include <relume/context.h>
#include <relume/encode.h>
#include <relume/evaluate.h>
#include <relume/exchange.h>
#include <relume/frame.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/pack.h>
#include <relume/publish.h>
#include <relume/renderer.h>
#include <relume/rig.h>

#endif
