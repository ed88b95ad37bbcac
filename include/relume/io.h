// io.h - memory and callbacks in place of files
//
// Functions that read or write one file take a relume_reader or relume_writer in their params
// (pack.h, image.h, exchange.h). The path is then only a name: messages begin with it, and the
// format follows from its ending. Inputs of many files (captures, web folders) are asked for by
// name: struct relume_files (context.h). Files are read and written by the same code.
//
//     struct relume_buffer file = {0};                      // a relume file, in memory
//     struct relume_writer writer = relume_buffer_writer(&file);
//     relume_pack_encode(capture, coder, NULL, NULL, relume_pack_encode_params(.writer = &writer));
//     struct relume_reader reader = relume_memory_reader(file.data, file.size);
//     relume_pack_open(&pack, NULL, relume_pack_params(.reader = &reader));
#ifndef RELUME_IO_H
#define RELUME_IO_H

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

#ifdef __cplusplus
}
#endif
#endif
