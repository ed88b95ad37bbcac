// format.h - names in a relume file, shared by writer and reader (docs/format.md)
#ifndef PACK_FORMAT_H
#define PACK_FORMAT_H

#include <relume/format/codebook.h>

#define FORMAT_NAME "relume"

// Several slabs are version 2, cylinders with discs 3, planes coded with loss and reduced levels 4;
// everything else stays what readers of version 1 know.
enum { FORMAT_VERSION = 4, FORMAT_CODED = 4, FORMAT_DISCS = 3, FORMAT_SLABS = 2, FORMAT_PLAIN = 1 };

// The side of the tiles of views that have reduced levels: a small picture is a few of them, and
// what PIZ needs for each is little beside what it saves.
enum { FORMAT_TILE = 128 };

// Attributes of the first part
#define ATTR_FORMAT        "relume.format"
#define ATTR_VERSION       "relume.version"
#define ATTR_CREATOR       "relume.creator"
#define ATTR_DOMAIN        "relume.domain"
#define ATTR_DISPLAY       "relume.display"
#define ATTR_STORAGE       "relume.storage"
#define ATTR_PROJECTION    "relume.projection"
#define ATTR_VIEWS         "relume.views"
#define ATTR_UV            "relume.uv"
#define ATTR_WINDOW        "relume.window"
#define ATTR_CAMERA        "relume.camera"
#define ATTR_SLAB          "relume.slab"
#define ATTR_POSE          "relume.pose"
#define ATTR_PANORAMA      "relume.panorama"
#define ATTR_BASIS         "relume.basis"
#define ATTR_COEFFICIENTS  "relume.coefficients"
#define ATTR_POLE          "relume.pole"
#define ATTR_HEMISPHERICAL "relume.hemispherical"
#define ATTR_RIDGE         "relume.ridge"
#define ATTR_LIGHTS        "relume.lights"
#define ATTR_TRANSFORM     "relume.transform"
#define ATTR_MEAN          "relume.mean"
#define ATTR_COLOUR        "relume.colour"
#define ATTR_INTERPOLANT   "relume.interpolant"
#define ATTR_PARAMETER     "relume.parameter"
#define ATTR_REPORT        "relume.report"
#define ATTR_BOOKS         "relume.books"
#define ATTR_CODING        "relume.coding"
#define ATTR_WIDTH         "relume.width"
#define ATTR_HEIGHT        "relume.height"
#define ATTR_FUNCTIONS     "relume.functions"
#define ATTR_MOST          "relume.functions.most"
#define ATTR_STEPPED       "relume.functions.stepped"
#define ATTR_SUMS          "relume.sums"
#define ATTR_PROVENANCE    "relume.provenance"
#define ATTR_NOTES         "relume.notes"

// A part of the work (docs/format.md, "Parts"): format and attributes of the first part beside
// those of the whole, and of a view's
#define FORMAT_PART    "relume part"
#define ATTR_PART      "relume.part"
#define ATTR_CAPTURE   "relume.part.capture"
#define ATTR_OPTIONS   "relume.part.options"
#define ATTR_PART_STEP "relume.part.step"
#define ATTR_PYRAMID   "relume.part.pyramid"
#define ATTR_EXACT     "relume.part.exact"
#define ATTR_MEASURED  "relume.part.measured"
#define ATTR_BANDS     "relume.part.bands"
#define ATTR_ERRORS    "relume.part.errors"
#define ATTR_LIT       "relume.part.lit"
#define ATTR_STORED    "relume.part.stored"
#define ATTR_TILES     "relume.part.tiles"

// A report, its figures as hexadecimal floats: fit, store, steps, PSNR, typical, the census
#define FORMAT_MEASURED "%a %a %a %a %a %zu %zu %zu %zu %zu %d"
#define SCAN_MEASURED   "%la %la %la %la %la %zu %zu %zu %zu %zu %d"

// Attributes of a view's part
#define ATTR_VIEW   "relume.view"
#define ATTR_SCALE  "relume.scale"
#define ATTR_OFFSET "relume.offset"
#define ATTR_MEMBER "relume.member"

// Attributes of the part of a group of coded views: each as "VIEW WORDS DEPTH-WORDS", the anchor
// first, and the step of its coded depth
#define ATTR_GROUP         "relume.group"
#define ATTR_STEP          "relume.step"
#define FORMAT_MEMBER      "%s%d %zu %zu "
#define FORMAT_MEMBER_SCAN "%9d %zu %zu %n"

// Attributes of a codebook's part, beside scale and offset
#define ATTR_BOOK  "relume.book"
#define ATTR_FIRST "relume.first"
#define ATTR_LAST  "relume.last"

// How planes are coded that are not kept as they are, and the channel of their words.
#define CODING_AV1 "av1"

// How its values are written: by enum relume_book_kind.
extern const char *const format_book_kinds[3];

// Planes are in the order R, G, B; the file sorts channels by name, B, G, R. Which plane a channel
// is, and which channel a plane.
int format_plane(const struct relume_coder_info *info, int channel);

// Depth along the viewing rays becomes that along the axis of a slab, or back: its inverse is
// linear where the surface is a plane. Of other projections it stays.
void format_turn_depth(struct relume_image *depth, const struct relume_geometry *g,
                       const double uv[2], bool to_axis);

#endif
