// base.h - what every other header builds on: status, log, limits, CPU features
#ifndef RELUME_BASE_H
#define RELUME_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

// The version of these headers: major.minor.patch.
#define RELUME_VERSION "0.1.0"

#define RELUME_VERSION_MAJOR 0  // a program must be changed for another one
#define RELUME_VERSION_MINOR 1  // something was added
#define RELUME_VERSION_PATCH 0  // something was mended
// The three as one number that grows: 10200 is version 1.2.0.
#define RELUME_VERSION_NUMBER                                                                      \
    (RELUME_VERSION_MAJOR * 10000 + RELUME_VERSION_MINOR * 100 + RELUME_VERSION_PATCH)

// An exported declaration.
#define RELUME_API __attribute__((visibility("default")))
// An exported function whose status must be looked at.
#define RELUME_RESULT RELUME_API __attribute__((warn_unused_result))

// How a call ended. On failure outputs are NULL or empty and the log has the sentence. Comments
// call those from ENOTFOUND to EUNFIT an input status: which one it is depends on the file.
typedef enum relume_status {
    RELUME_OK = 0,
    RELUME_ENOTFOUND,     // an input is not there, or cannot be opened or read
    RELUME_EFORMAT,       // it is something else than what is expected here, or breaks its grammar
    RELUME_EDAMAGED,      // it is of that format, but cut short, or its values are broken
    RELUME_ELIMIT,        // it is larger than the limits, or than what the format or method holds
    RELUME_EUNSUPPORTED,  // it is sound, but of a kind or version that this library does not do
    RELUME_EUNFIT,        // it is sound, but does not do here: sizes differ, lights are too few
    RELUME_EINVAL,        // usage: an argument or option is unknown or out of range
    RELUME_ENOMEM,        // out of memory
    RELUME_EIO,           // an output cannot be written
    RELUME_ESYSTEM,       // the machine lacks something: threads, a module, a GL context
    RELUME_ECANCEL,       // the progress callback asked to stop
    RELUME_ECODER,        // the process of the AV1 coder crashed or was killed
} relume_status;

// Params structs begin with their size, which the macro of the same name fills: a library that
// knows more fields than its caller takes the default for them. A size of 0 means all fields.
#define RELUME_SIZED(type) .struct_size = sizeof(struct type)

// The RELUME_VERSION_NUMBER of the library that is linked, which may be newer than the headers.
RELUME_API int relume_version(void);

// A fixed English text for `status`, never NULL.
RELUME_API const char *relume_status_text(relume_status status);
// Its name in one word, constant: "not-found", "limit"; never NULL.
RELUME_API const char *relume_status_name(relume_status status);
// How a program that it ended should exit: 0 done, 1 the input, 2 usage, 3 the machine, 130
// stopped.
RELUME_API int relume_status_exit(relume_status status);
// Whether the input was at fault.
static inline bool relume_status_is_input(relume_status status)
{
    return status >= RELUME_ENOTFOUND && status <= RELUME_EUNFIT;
}

// Free what a call has returned as the caller's own array; NULL is fine. It is free() unless the
// application has set an allocator (context.h).
RELUME_API void relume_free(void *memory);

// How much a sentence of the log matters.
enum relume_level { RELUME_ERROR, RELUME_WARNING, RELUME_NOTE };

// The ending of a counted noun: "" for 1, else "s".
RELUME_API const char *relume_plural(int64_t n);
// What a file's name stands between on a command line that somebody may copy: "" or a quotation
// mark. Thread-safety: safe.
RELUME_API const char *relume_name_quotes(const char *name);
// The name in a NULL-terminated list that somebody most likely meant who typed `given`; NULL when
// none is near.
RELUME_API const char *relume_name_nearest(const char *given, const char *const *names);

// Limits, threads and more that calls share (context.h).
typedef struct relume_context relume_context;

// Where sentences for people go. Every params struct takes one; NULL is silent. It is borrowed: a
// call uses it until it returns, and what it opens (a relume_pack, a relume_renderer) as long as
// that lives.
// Thread-safety: all calls come from the thread that called the library.
struct relume_log {
    // One line without a newline: "FILE: what; expected; found". May be NULL.
    void (*message)(void *user, enum relume_level level, const char *text);
    // `done` in [0, 1]; false asks the work to stop with RELUME_ECANCEL. May be NULL.
    bool (*progress)(void *user, const char *what, double done);
    void *user;
    relume_context *context;  // NULL: the defaults
    bool leave_unnoted;       // what is read with this log may be replaced, whatever the context
};

// "PATH: WHAT; why" and the status for an input that cannot be opened or read, `error` being the
// errno: RELUME_ENOTFOUND, but RELUME_EFORMAT for a folder, RELUME_ESYSTEM for too many open files,
// and RELUME_ENOMEM without a sentence. `log` may be NULL.
RELUME_RESULT relume_status relume_input_fail(const struct relume_log *log, const char *path,
                                              const char *what, int error);

// Upper bounds for what is read from files; zero in a field means its default.
struct relume_limits {
    int max_side;         // pixels along one side; default 65536
    uint64_t max_pixels;  // pixels of one image; default 2^30
    int max_lights;       // default 65536
    int max_views;        // default 65536
    uint64_t max_memory;  // bytes of one picture, view or model; default: half of the machine's
    bool any_format;      // pictures: also what is not on the list of formats (docs/reliability.md)
};

// "500M", "4G" or a plain number: k, M, G and T are powers of 1024. RELUME_EINVAL for anything
// else, for nothing, and beyond 2^63.
RELUME_RESULT relume_status relume_size_parse(uint64_t *out, const char *text);

// Features of the processor that kernels are chosen by: bits.
enum relume_cpu {
    RELUME_CPU_AVX2 = 1 << 0,    // AVX2, FMA and F16C together
    RELUME_CPU_AVX512 = 1 << 1,  // AVX-512 F, BW, DQ and VL together
    RELUME_CPU_NEON = 1 << 2,    // of 64-bit ARM
};

// The features this CPU has, as RELUME_CPU_* bits, or as many as the environment allows: with
// RELUME_CPU=plain none, so that every kernel of the process is the portable one; else avx2, avx512
// or neon.
RELUME_API unsigned relume_cpu_features(void);

// Whether RELUME_CPU names a set of instructions that this CPU has, where it is there at all.
// RELUME_EINVAL with a sentence; programs ask, the library takes all it finds.
RELUME_API RELUME_RESULT relume_status relume_cpu_check(const struct relume_log *log);

// The number of cores that this process may use, at least 1.
RELUME_API int relume_cpu_count(void);

// One character of UTF-8: its number, and how many bytes it has; 0 at the end. A byte that begins
// no whole character is one, of the number 0xFFFD.
RELUME_API int relume_text_step(uint32_t *code, const char *text);
// Whether a terminal only shows it: no control, no change of direction, nothing unseen.
RELUME_API bool relume_text_harmless(uint32_t code);
// Makes a text fit for a terminal, in place: each harmful character becomes "?". Returns it.
// Messages of the library are so already.
RELUME_API char *relume_printable(char *text);

// The whole number of a value, cut towards zero, whatever the value: beyond 2^30 either way it
// stays there, so that a neighbour can be added or subtracted, and NaN is the lowest. A cast alone
// is undefined where no int can hold the value: what comes from a file or a fit goes through here,
// and is checked against its bounds afterwards.
static inline int relume_whole(double value)
{
    const double most = 0x1p30;
    const double above = value > -most ? value : -most;
    return (int)(above < most ? above : most);
}

// Remove the unfinished outputs of this process, for programs that are about to end while the
// library is still at work: after it, calls that write do not return. Thread-safety: any thread,
// once.
RELUME_API void relume_files_abandon(void);

// Write a whole file: it appears under its name complete or not at all; devices and pipes are
// written directly. RELUME_EIO with a sentence, RELUME_EINVAL when it would replace an input,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_file_save(const char *path, const void *bytes, size_t size,
                                             const struct relume_log *log);
// The same of a text that `print` writes, which is called once with `context` and a stream in
// memory.
RELUME_RESULT relume_status relume_file_print(const char *path,
                                              void (*print)(const void *context, FILE *to),
                                              const void *context, const struct relume_log *log);

// What relume_file_save would refuse before it writes, for work that takes long: `path` is a file
// that is read here (RELUME_EINVAL with a sentence), or a folder or may not be written, or its own
// folder is not there or may not be written (RELUME_EIO).
RELUME_RESULT relume_status relume_file_check(const char *path, const struct relume_log *log);
// The same of a folder that a `force` may replace: RELUME_EINVAL with a sentence where one with
// something in it is there.
RELUME_RESULT relume_status relume_folder_check(const char *path, bool force,
                                                const struct relume_log *log);

// Something that takes long to make, a folder or a file written by others (a film): made in a place
// of its own beside its name, and given the name when it is whole. What a stopped run leaves there
// is removed by the next one that writes beside it.
typedef struct relume_making relume_making;
// What is made: one file, or a folder of files.
enum relume_made { RELUME_MADE_FILE, RELUME_MADE_FOLDER };
// `path` NULL: a folder for temporary files in $TMPDIR or /tmp, never committed. A folder that is
// there and not empty is RELUME_EINVAL, and with `force` unless relume made it, all that is in it,
// and nothing of it is read here. RELUME_EIO with a sentence, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_making_open(relume_making **out, const char *path,
                                               enum relume_made kind, bool force,
                                               const struct relume_log *log);
// Where to make it: an empty folder, or the name of a file that does not exist.
RELUME_API const char *relume_making_path(const relume_making *making);
// Ends `*making` in every case; on failure what was there before is there still.
RELUME_RESULT relume_status relume_making_commit(relume_making **making);
// Leaves nothing behind; `*making` becomes NULL, and may have been NULL.
RELUME_API void relume_making_abort(relume_making **making);

// World axes: right-handed, x right, y up, z towards the viewer.
// A light direction points from the scene TOWARDS the light.
struct relume_vec3 {
    double x, y, z;
};

#ifdef __cplusplus
}
#endif
#endif
