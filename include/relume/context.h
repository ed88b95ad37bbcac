// context.h - what calls share: limits, threads, files that are none, and which files are read
//
//     relume_context *context;
//     const struct relume_limits limits = {.max_memory = 1 << 30};
//     relume_context_create(&context, relume_context_params(.threads = 4, .limits = &limits));
//     const struct relume_log log = {.message = say, .context = context};
//     relume_open(&pack, "coin.ptm", relume_open_params(.log = &log));
//
// It goes with the log, which every params struct takes. A log without one, and no log, have the
// defaults. Memory is not a context's but the process's (relume_set_allocator): buffers pass from
// one object to another, and one that was opened with this context may be freed after another.
// Memory and callbacks stand for files as well: functions that read or write one file take a
// relume_reader or relume_writer in their params (pack.h, image.h, exchange.h). The path is then
// only a name: messages begin with it, and its ending gives the format. Files are read and written
// by the same code.
//
//     struct relume_buffer file = {0};                      // a relume file, in memory
//     struct relume_writer writer = relume_buffer_writer(&file);
//     relume_encode_capture(NULL, capture, NULL, relume_encode_capture_params(.writer = &writer));
//     struct relume_reader reader = relume_memory_reader(file.data, file.size);
//     relume_pack_open(&pack, NULL, relume_pack_params(.reader = &reader));
#ifndef RELUME_CONTEXT_H
#define RELUME_CONTEXT_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// Bytes to read. The struct is copied; what `user` points to must live, and the bytes stay as they
// are, until the call returns, or as long as the object that it opens (a relume_pack).
// Thread-safety: `read` is called from threads of the library, for one reader never from two at
// once.
struct relume_reader {
    // Copy `size` bytes from `offset` on into `bytes`; the range always lies within `size`.
    // False with errno set: the input cannot be read, an input status.
    bool (*read)(void *user, void *bytes, size_t size, uint64_t offset);
    void *user;
    uint64_t size;  // of all of it, bytes
};

// Where bytes go. The struct is copied; what `user` points to must live until the call returns.
// Thread-safety: as relume_reader.
struct relume_writer {
    // Put `size` bytes at `offset`. Offsets may lie beyond what has been written so far, and what
    // has been written may be written again (the table at the head of an EXR file is). False with
    // errno set: the output cannot be written, RELUME_EIO (ENOMEM: RELUME_ENOMEM).
    bool (*write)(void *user, const void *bytes, size_t size, uint64_t offset);
    // Called once, last, from the calling thread, where writing has begun. `whole`: everything is
    // there, and false with errno set is a failure as that of `write`; else what was written is to
    // be thrown away, and the answer does not count. May be NULL.
    bool (*finish)(void *user, bool whole);
    void *user;
};

// A reader of `size` bytes, which are borrowed.
RELUME_API struct relume_reader relume_memory_reader(const void *bytes, size_t size);

// Bytes that a writer has received; begin with all zero. Thread-safety: plain data.
struct relume_buffer {
    unsigned char *data;  // [size], from malloc, or NULL
    size_t size, room;    // bytes that are written; bytes that there is memory for
    bool whole;           // an output is all there; the next one replaces it
};
// A writer into `buffer`, one output at a time; where writing fails the buffer is empty.
RELUME_API struct relume_writer relume_buffer_writer(struct relume_buffer *buffer);
// Frees the data; the buffer is empty afterwards.
RELUME_API void relume_buffer_destroy(struct relume_buffer *buffer);

// Inputs that have names but are no files: the entries of an archive, of a database, memory. What
// names a file by a path is asked for here first: relume files, pictures, .ptm, .rti, web folders
// (info.json and its planes), captures (capture.json, .lp and their pictures), lights, IES files.
// Folders of photographs, BTFs and 3D models, which are listed, are those of the file system.
struct relume_files {
    // The input called `path`, as the caller or the file that names it wrote it: "a/capture.json"
    // names "a/view00/light0.exr". False with errno set when there is none (ENOENT) or it cannot be
    // read; false with errno 0: look for the path in the file system.
    bool (*open)(void *user, const char *path, struct relume_reader *out);
    // What `open` has given is read no more. May be NULL.
    void (*close)(void *user, struct relume_reader *reader);
    // Of both. Thread-safety: both are called from threads of the library, one call at a time, and
    // must not call the library; readers as relume_reader says.
    void *user;
};

// What a context holds; see each field for what is copied and what is borrowed.
struct relume_context_params {
    size_t struct_size;  // filled by the macro (base.h)
    // Of everything opened with it, where params name none. Borrowed as long as the context lives,
    // and read whenever something is opened. NULL: the defaults.
    const struct relume_limits *limits;
    int threads;                // where params name none; default: all cores
    bool keep_inputs;           // files that are read are noted, and no output replaces one
    struct relume_files files;  // where `open` is not NULL
};
#define relume_context_params(...)                                                                 \
    (&(const struct relume_context_params){RELUME_SIZED(relume_context_params), __VA_ARGS__})

// All else is copied; what `files.user` means must live as long as the context. It must outlive
// every object that was opened with it: a relume_pack, a relume_capture. RELUME_ENOMEM.
// Thread-safety: it does not change, but for the list of inputs, which has a lock: any number of
// threads.
RELUME_RESULT relume_status relume_context_create(relume_context **out,
                                                  const struct relume_context_params *params);
// `*context` becomes NULL, and may have been NULL.
RELUME_API void relume_context_destroy(relume_context **context);

// Where all memory of the library comes from, in place of malloc, realloc and free, whose contracts
// these have: aligned for every type; NULL when memory is short, which ends the call with
// RELUME_ENOMEM. `bytes` is never 0, `memory` never NULL.
// All three, or none for the C library's. Not through them goes what other libraries allocate for
// themselves: the C library's files and threads, JSON, JPEG, AV1, meshes, models in the helper.
// Thread-safety: all are called from any number of threads at once, and must not call the library.
struct relume_allocator_params {
    size_t struct_size;                                       // filled by the macro (base.h)
    void *(*allocate)(void *user, size_t bytes);              // as malloc
    void *(*resize)(void *user, void *memory, size_t bytes);  // as realloc
    void (*release)(void *user, void *memory);                // as free
    void *user;  // of all three; it must live as long as the process uses the library
};
#define relume_allocator_params(...)                                                               \
    (&(const struct relume_allocator_params){RELUME_SIZED(relume_allocator_params), __VA_ARGS__})

// Of the whole process, before anything else of the library is used: RELUME_EINVAL once it has
// allocated anything, and for two of three functions. The struct is copied.
// Thread-safety: not while another thread is in the library.
RELUME_RESULT relume_status relume_set_allocator(const struct relume_allocator_params *params);

// With `keep_inputs`: note a file or a folder before it is opened; by device and number, so that
// links and other spellings do not matter. What does not exist is passed over.
RELUME_API void relume_context_note(relume_context *context, const char *path);

#ifdef __cplusplus
}
#endif
#endif
