// edit_options.h - what `btf edit` and `maps edit` share: operations on the command line
#ifndef CLI_EDIT_OPTIONS_H
#define CLI_EDIT_OPTIONS_H

#include "cli.h"

struct edit_options {
    const char *text;  // of all operations and parameters, whose order counts: line->given has it
    bool undo, redo, clear, list, json;
};
// Table rows for a command's options; `edit` in its struct. The first parameter of an operation is
// the value of its option.
// clang-format off
#define EDIT_OPTIONS                                                                   \
    GROUP("operations"),                                                                           \
    TEXT("--emboss", edit.text, "PICTURE", "raise a drawing: white by --height"),                  \
    TEXT("--engrave", edit.text, "PICTURE", "sink a drawing: white by --height"),                  \
    TEXT("--roughness", edit.text, "F", "multiply the roughness"),                                 \
    TEXT("--tint", edit.text, "R,G,B", "multiply the colours"),                                    \
    TEXT("--channels", edit.text, "GBR",                                                           \
         "exchange red, green and blue: which take their places"),                                 \
    TEXT("--add-material", edit.text, "ROUGHNESS",                                                 \
         "lay a synthetic material on: GGX of that roughness, 0.1 to 1"),                          \
    GROUP("of the operation before"),                                                              \
    TEXT("--height", edit.text, "H", "emboss, engrave: in widths of the sample; default: 0.02"),   \
    TEXT("--at", edit.text, "X,Y",                                                                 \
         "emboss, engrave: middle of the drawing, 0,0: upper left; default: 0.5,0.5"),             \
    TEXT("--size", edit.text, "W",                                                                 \
         "emboss, engrave: width of the drawing, in widths of the sample; default: 1"),            \
    TEXT("--r0", edit.text, "R",                                                                   \
         "add-material: reflectance at normal incidence; default: 0.04"),                          \
    TEXT("--colour", edit.text, "R,G,B",                                                           \
         "add-material: diffuse colour, linear; default: that of the place"),                      \
    TEXT("--highlight", edit.text, "R,G,B",                                                        \
         "add-material: colour of what shines; default: 1,1,1"),                                   \
    TEXT("--mask", edit.text, "PICTURE", "only where this is white; default: everywhere")
#define EDIT_LIST_OPTIONS                                                                          \
    GROUP("list"),                                                                                 \
    FLAG("--undo", edit.undo, "undo the last edit; repeats"),                                      \
    FLAG("--redo", edit.redo, "redo the last undone edit; repeats"),                               \
    FLAG("--clear", edit.clear, "begin with an empty list, whatever is kept there"),               \
    FLAG("--list", edit.list, "print the list; done when nothing else is asked for"),              \
    FLAG("--json", edit.json, "print the list as one JSON object")
// clang-format on

// Whether an operation, --undo, --redo or --clear is asked for.
bool edit_is_asked(const struct args *args, const struct edit_options *o);
// The list kept with the first input, or an empty one with --clear, with what the line says done
// to it, in its order.
relume_status edit_list_of_line(relume_edits **out, uint64_t fingerprint, const struct args *args,
                                const struct edit_options *o);
// Keep it where it was, when it was changed, and print it, when that is asked for.
relume_status edit_list_end(const relume_edits *edits, const struct args *args,
                            const struct edit_options *o);

#endif
