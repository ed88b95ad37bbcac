"""What the binding knows of the C library: the one place where structs and functions are declared.

The text below is C, copied from the public headers (include/relume): `python relume/_abi.py` prints
a C program that fails to compile where a function or a constant has become another, and that
prints the layout of every struct; `python relume/_abi.py layout` prints the layout that ctypes
uses. tests/cli/test_python.sh compares the two.
"""

from __future__ import annotations

import ctypes
import re
import sys

CONSTANTS = {
    "RELUME_OK": 0, "RELUME_ENOTFOUND": 1, "RELUME_EFORMAT": 2, "RELUME_EDAMAGED": 3,
    "RELUME_ELIMIT": 4, "RELUME_EUNSUPPORTED": 5, "RELUME_EUNFIT": 6, "RELUME_EINVAL": 7,
    "RELUME_ENOMEM": 8, "RELUME_EIO": 9, "RELUME_ESYSTEM": 10, "RELUME_ECANCEL": 11,
    "RELUME_ERROR": 0, "RELUME_WARNING": 1, "RELUME_NOTE": 2,
    "RELUME_SAMPLE_FLOAT": 0, "RELUME_SAMPLE_8": 1, "RELUME_SAMPLE_16": 2,
    "RELUME_CURVE_AUTO": 0,
    "RELUME_PLANAR": 0, "RELUME_SLAB": 1, "RELUME_CYLINDRICAL": 2, "RELUME_SPHERICAL": 3,
    "RELUME_CUBE": 4,
    "RELUME_DOMAIN_AUTO": 0, "RELUME_DOMAIN_LINEAR": 1, "RELUME_DOMAIN_DISPLAY": 2,
    "RELUME_MOVING_DEFAULT": 0, "RELUME_MOVING_AUTO": 1, "RELUME_MOVING_YES": 2, "RELUME_MOVING_NO": 3,
    "RELUME_EFFORT_DEFAULT": 0, "RELUME_EFFORT_FAST": 1, "RELUME_EFFORT_USUAL": 2, "RELUME_EFFORT_SMALLEST": 3,
    "RELUME_PYRAMID_DEFAULT": 0, "RELUME_PYRAMID_YES": 1, "RELUME_PYRAMID_NO": 2,
    "RELUME_MOVING_MOVES": 1, "RELUME_REACHED": 0,
    "RELUME_FRAME_DEFAULT": 0, "RELUME_FRAME_VIEW": 1, "RELUME_FRAME_EYE": 2,
    "RELUME_FRAME_LOOK": 3, "RELUME_TARGET_RGB": 0, "RELUME_TARGET_RGBA8": 2,
}

STRUCTS = """
struct relume_vec3 { double x, y, z; };
struct relume_limits { int max_side; uint64_t max_pixels; int max_lights; int max_views;
    uint64_t max_memory; bool any_format; };
struct relume_log { void *message; void *progress; void *user; void *context; bool leave_unnoted; };
struct relume_files { void *open; void *close; void *user; };
struct relume_context_params { size_t struct_size; void *limits; int threads; bool keep_inputs;
    struct relume_files files; };
struct relume_reader { void *read; void *user; uint64_t size; };
struct relume_writer { void *write; void *finish; void *user; };
struct relume_buffer { void *data; size_t size, room; bool whole; };
struct relume_image { int width, height; int channels; void *data; size_t mapped; };
struct relume_transfer { int curve; float gamma; void *response; };
struct relume_image_params { size_t struct_size; void *log; struct relume_transfer transfer; void *limits;
    int channels; bool half; int threads; void *reader; void *writer; bool profile; int bits; bool codes; };
struct relume_pose { struct relume_vec3 origin; struct relume_vec3 axis[3]; };
struct relume_geometry { int projection; double window_min[2], window_max[2]; bool perspective;
    double camera_z; double uv_z, st_z; double st_min[2], st_max[2]; struct relume_pose pose;
    double v_min, v_max; int disc; struct relume_vec3 center; };
struct relume_manifest_view { double uv[2]; int slab; void *images; void *depth; void *mask; };
struct relume_manifest { struct relume_transfer transfer; struct relume_geometry geometry;
    int slabs; void *slab; int lights; void *directions; void *positions; bool no_falloff;
    bool display_coded; void *intensities; bool intensities_at_origin; int views; void *view; char *provenance; };
struct relume_pictures { int sample; int width, height; int channels; void *data; void *depth;
    void *mask; };
struct relume_capture_params { size_t struct_size; void *log; void *limits; struct relume_transfer transfer;
    bool skip_missing; bool allow_outside; bool repair; double assume_depth; size_t keep_bytes;
    void *scratch; };
struct relume_acquire_params { size_t struct_size; void *log; void *limits;
    struct relume_transfer transfer; char *mask; bool skip_bad; bool force; int threads; char *lights;
    bool near; void *ball; int balls; bool distant; bool matte; char *ball_mask;
    void *ball_photographs; int ball_photograph_count; struct relume_transfer ball_transfer;
    double ball_z; double fov_deg; double focal_mm; bool refine_lights; bool refine_brightness;
    bool integrable; int white[4]; char *target; void *target_corner; char *target_values; void *flats;
    int flat_count; bool radial; bool align; bool no_registration; int crop[4]; bool crop_auto;
    char *normals; char *albedo; char *height; double width_mm; bool surface; };
struct relume_directions_params { size_t struct_size; void *log; uint64_t seed; bool hemisphere; bool pole_y; };
struct relume_coder_params { size_t struct_size; void *log; int coefficients; bool hemispherical; bool pole_y;
    double ridge; bool no_ridge; bool luminance; bool robust; bool force; void *interpolant;
    bool choose; double parameter[4]; void *samples; int threads; bool decode; void *transform;
    void *mean; };
struct relume_coder_info { void *basis; int coefficients; bool joint; bool luminance; int planes;
    int functions; bool hemispherical, pole_y; double ridge; int lights; void *directions;
    void *transform; void *mean; void *interpolant; double parameter[4]; double predicted_rms; };
struct relume_pack_params { size_t struct_size; void *log; void *limits; int compression; int threads; void *reader;
    void *writer; bool keep_going; };
struct relume_census { size_t pixels; size_t black; size_t clipped; size_t always_clipped;
    size_t repaired; int black_images; };
struct relume_fidelity { double fit_rms; double store_rms; double steps_rms; double psnr_db; double typical;
    struct relume_census census; };
struct relume_encode_capture_params { size_t struct_size; void *log; int threads; char *name; void *basis;
    int coefficients; double quality_db; void *interpolant; bool choose_interpolant; bool luminance, robust, force;
    double ridge; bool no_ridge; int domain; struct relume_transfer display; int shadows; int highlights;
    int storage; int step; int compression; int pyramid; bool no_depth; void *books; bool share;
    double psnr_db, bytes_per_pixel, jnd; void *writer; int part, parts; char *options; char *learnt; bool learn_only;
    void *team; int effort; bool lossless; };
struct relume_moving_report { int outcome; int lights; double faded_db, moved_db; char *expected;
    relume_status status; };
struct relume_encode_result { int made; void *basis; int coefficients; bool joint; int lights, views; int domain;
    struct relume_transfer display; int storage; bool lossy; struct relume_fidelity measured; double unseen_db; double quality_db; int reach;
    double jnd; double file_bytes; double bytes_per_pixel; double photograph_bytes; bool is_coarse;
    struct relume_moving_report shadows, highlights; };
struct relume_pack_info { int version; void *coder; int domain; struct relume_transfer display;
    int storage; char *compression; struct relume_geometry geometry; int slabs; void *slab;
    int width, height; int levels; int tile; int views; void *uv; void *slab_of; bool has_depth, has_mask;
    int coefficients, planes; int books; int codes; bool shared;
    struct relume_fidelity report; uint64_t file_bytes; bool has_shadow; bool has_gloss; bool has_sums;
    char *provenance; char *notes; };
struct relume_codes { void *coder; int domain; struct relume_transfer display;
    int width, height, planes; int storage; void *plane; void *scale, *offset; int books;
    void *index; void *vectors; void *book_codes; };
struct relume_look_at { bool aimed; struct relume_vec3 at; struct relume_vec3 up;
    double field_of_view_deg; };
struct relume_pan_tilt { double pan_deg, tilt_deg, zoom; bool stereographic; };
struct relume_camera { int framing; int view; struct relume_vec3 eye; struct relume_look_at look_at;
    int through; struct relume_pan_tilt look; int width, height; };
struct relume_open_params { size_t struct_size; void *log; void *limits; bool allow_outside; bool sphere;
    int threads; void *reader; bool keep_going; };
struct relume_export_params { size_t struct_size; void *log; int view; int type; bool ycc;
    int coefficients; int resolution; double bytes_per_pixel; double psnr_db; int quality; bool force;
    int threads; void *writer; int level; };
struct relume_evaluate_params { size_t struct_size; void *log; char *file; char *capture; int threads;
    bool no_ssim, no_delta_e; bool jnd; int every; };
struct relume_evaluation_light { double rms; double psnr_db; };
struct relume_evaluation { int views, lights; int width, height; size_t images; double rms;
    double psnr_db; double psnr_pooled_db; double ssim, delta_e; double jnd, jnd_worst;
    double file_bytes, raw_bytes, ratio; double bits_per_pixel; void *light; };
struct relume_heldout_params { size_t struct_size; void *log; void *test; int leave_out; int domain; uint64_t memory;
    int threads; struct relume_transfer display; bool tone_mapped; };
struct relume_heldout_store { int storage; int step; void *books; bool share; };
struct relume_heldout_quality { double psnr_db; double psnr_pooled_db; double ssim; };
struct relume_frame_params { size_t struct_size; void *log; unsigned cpu_off; int threads; double assume_depth;
    int pass; void *capture; int interpolation; double aperture, focus; int filter;
    uint64_t memory; void *strength; bool once; bool masked; };
struct relume_rect { int left, top, width, height; };
struct relume_target { void *data; int format; int width, height; ptrdiff_t stride;
    float exposure_ev; };
"""

FUNCTIONS = """
const char *relume_status_text(relume_status status);
relume_status relume_context_create(relume_context **out, const struct relume_context_params *params);
void relume_context_destroy(relume_context **context);
struct relume_reader relume_memory_reader(const void *bytes, size_t size);
struct relume_writer relume_buffer_writer(struct relume_buffer *buffer);
void relume_buffer_destroy(struct relume_buffer *buffer);
relume_status relume_transfer_parse(struct relume_transfer *out, const char *text);
relume_status relume_image_load(struct relume_image *out, const char *path, const struct relume_image_params *params);
relume_status relume_image_save(const struct relume_image *image, const char *path, const struct relume_image_params *params);
void relume_image_destroy(struct relume_image *image);
const struct relume_pattern *relume_pattern_find(const char *name);
relume_status relume_directions_make(struct relume_vec3 *out, int n, const struct relume_pattern *pattern, const struct relume_directions_params *params);
relume_status relume_capture_open_photographs(relume_capture **out, const char *path, const struct relume_capture_params *params, const struct relume_acquire_params *acquire, struct relume_acquisition *report);
relume_status relume_capture_create(relume_capture **out, const struct relume_manifest *manifest, const struct relume_pictures *pictures, const struct relume_capture_params *params);
void relume_capture_destroy(relume_capture **capture);
const struct relume_manifest *relume_capture_manifest(const relume_capture *capture);
int relume_capture_width(const relume_capture *capture);
int relume_capture_height(const relume_capture *capture);
relume_status relume_capture_image(struct relume_image *out, const relume_capture *capture, int view, int light, const struct relume_log *log);
relume_status relume_capture_depth(struct relume_image *out, const relume_capture *capture, int view, const struct relume_log *log);
relume_status relume_capture_mask(struct relume_image *out, const relume_capture *capture, int view, const struct relume_log *log);
const struct relume_basis *relume_basis_find(const char *name);
relume_status relume_storage_parse(enum relume_storage *out, const char *name);
const char *relume_storage_name(enum relume_storage storage);
relume_status relume_domain_parse(enum relume_domain *out, struct relume_transfer *display, const char *text);
const char *relume_domain_name(enum relume_domain domain, struct relume_transfer display);
relume_status relume_compression_parse(enum relume_compression *out, const char *name);
const char *relume_projection_name(enum relume_projection projection);
const struct relume_interpolant *relume_interpolant_find(const char *name);
const struct relume_coder_info *relume_coder_info(const relume_coder *coder);
void relume_coder_weights(const relume_coder *coder, struct relume_vec3 light, float *weights, float constant[3]);
relume_status relume_encode_capture(const char *path, const relume_capture *capture, struct relume_encode_result *result, const struct relume_encode_capture_params *params);
relume_status relume_pack_open(relume_pack **out, const char *path, const struct relume_pack_params *params);
relume_status relume_exchange_parse(enum relume_exchange *out, const char *name);
relume_status relume_export(relume_pack *pack, const char *path, enum relume_exchange format, struct relume_export_report *report, const struct relume_export_params *params);
relume_status relume_open(relume_pack **out, const char *path, const struct relume_open_params *params);
void relume_pack_destroy(relume_pack **pack);
const struct relume_pack_info *relume_pack_info(const relume_pack *pack);
relume_status relume_pack_codes(const struct relume_codes **out, relume_pack *pack, int view);
void relume_pack_drop(relume_pack *pack, int view);
relume_status relume_pack_depth(struct relume_image *out, relume_pack *pack, int view);
relume_status relume_pack_mask(struct relume_image *out, relume_pack *pack, int view);
void relume_codes_plane(const struct relume_codes *codes, int plane, size_t first, size_t n, float *out);
struct relume_rect relume_camera_rect(int frame[2], const struct relume_pack_info *info, const struct relume_camera *camera);
relume_status relume_renderer_create(relume_renderer **out, relume_pack *pack, const struct relume_frame_params *params);
void relume_renderer_destroy(relume_renderer **renderer);
relume_status relume_renderer_set_rig(relume_renderer *renderer, relume_rig *rig);
relume_status relume_renderer_draw(relume_renderer *renderer, const struct relume_camera *camera, const struct relume_target *target);
relume_status relume_rig_create(relume_rig **out);
void relume_rig_destroy(relume_rig **rig);
relume_status relume_rig_add(relume_rig *rig, const char *spec, const char *folder, const struct relume_log *log);
relume_status relume_evaluate(struct relume_evaluation *out, relume_pack *pack, const relume_capture *capture, const struct relume_evaluate_params *params);
void relume_evaluation_destroy(struct relume_evaluation *evaluation);
relume_status relume_heldout_open(relume_heldout **out, const relume_capture *capture, const struct relume_heldout_params *params);
void relume_heldout_destroy(relume_heldout **heldout);
relume_status relume_heldout_measure(relume_heldout *heldout, const struct relume_basis *basis, const struct relume_coder_params *coder, const struct relume_heldout_store *store, int n, struct relume_heldout_quality *before, struct relume_heldout_quality *after);
"""

_NUMBERS = {
    "int": ctypes.c_int, "unsigned": ctypes.c_uint, "bool": ctypes.c_bool, "size_t": ctypes.c_size_t,
    "uint64_t": ctypes.c_uint64, "ptrdiff_t": ctypes.c_ssize_t, "float": ctypes.c_float, "double": ctypes.c_double,
    "relume_status": ctypes.c_int, "void": None,
}


def _type(text: str):
    """The ctypes type of a C type: pointers are addresses but for text, enums are ints."""
    text = text.replace("const ", "").strip()
    if text.endswith("*"):
        return ctypes.c_char_p if text.replace(" ", "") == "char*" else ctypes.c_void_p
    if text.startswith("struct "):
        return structs[text[7:]]
    return ctypes.c_int if text.startswith("enum ") else _NUMBERS[text]


def _field(kind: str, name: str):
    stars = len(name) - len(name.lstrip("* "))
    name, _, count = name.lstrip("* ").partition("[")
    of = _type(kind + (" *" if stars else ""))
    return name, of * int(count.rstrip("]")) if count else of


class _Params(ctypes.Structure):
    """Parameters, by name; like the macros of the headers it fills the size that they begin with."""

    def __init__(self, **fields):
        super().__init__(struct_size=ctypes.sizeof(self), **fields)


def _struct(name: str, body: str):
    fields = []
    for line in filter(None, (part.strip() for part in body.split(";"))):
        kind, first = re.match(r"((?:struct )?\w+)\s*(.*)", line, re.S).groups()
        fields += [_field(kind, part.strip()) for part in first.split(",")]
    return type(name, (_Params if fields[0][0] == "struct_size" else ctypes.Structure,), {"_fields_": fields})


structs: dict[str, type[ctypes.Structure]] = {}
for _name, _body in re.findall(r"struct (\w+) \{(.*?)\};", STRUCTS, re.S):
    structs[_name] = _struct(_name, _body)


def bind(library: ctypes.CDLL) -> None:
    """Give every function of the library its types."""
    for result, name, arguments in re.findall(r"^(.*?)(\w+)\((.*)\);$", FUNCTIONS, re.M):
        function = getattr(library, name)
        function.restype = _type(result)
        function.argtypes = [
            ctypes.c_void_p if "[" in a else _type(re.match(r"(.*?)\w+$", a.strip())[1])
            for a in arguments.split(",")
        ]


def _kind_in_c(place: str, of) -> str:
    """A constant of C that is true when the field is of the kind that it has here."""
    while issubclass(of, ctypes.Array):
        place, of = place + "[0]", of._type_
    if issubclass(of, ctypes.Structure):
        return f"sizeof {place} == {ctypes.sizeof(of)}"
    if of in (ctypes.c_void_p, ctypes.c_char_p):
        return f"__builtin_classify_type({place}) == __builtin_classify_type((void *)0)"
    if of is ctypes.c_int:  # or an enum
        return f"_Generic({place}, int: 1, unsigned: 1, default: 0)"
    names = [name for name, number in _NUMBERS.items() if number is of and name != "relume_status"]
    return f"_Generic({place}, {names[0]}: 1, default: 0)"


def _layout_in_c() -> str:
    lines = ["#include <relume/extensions.h>", "#include <stdio.h>"]
    lines += [f'_Static_assert({k} == {v}, "{k}");' for k, v in CONSTANTS.items()]
    lines += [FUNCTIONS, "int main(void)", "{"]
    for name, of in structs.items():
        lines.append(f'    printf("{name} %zu\\n", sizeof(struct {name}));')
        for field, kind in of._fields_:
            place = f"((struct {name} *)0)->{field}"
            lines.append(f'    _Static_assert({_kind_in_c(place, kind)}, "{name}.{field}");')
            lines.append(f'    printf("{name}.{field} %zu %zu\\n", offsetof(struct {name}, {field}), '
                         f"sizeof {place});")
    return "\n".join(lines + ["    return 0;", "}"])


def _layout_here() -> str:
    lines = []
    for name, of in structs.items():
        lines.append(f"{name} {ctypes.sizeof(of)}")
        for field, *_ in of._fields_:
            at = getattr(of, field)
            lines.append(f"{name}.{field} {at.offset} {at.size}")
    return "\n".join(lines)


if __name__ == "__main__":
    print(_layout_here() if sys.argv[1:] == ["layout"] else _layout_in_c())
